#pragma once

#include "sim/coupling/capture.h"
#include "sim/coupling/drip.h"
#include "sim/coupling/mixture.h"
#include "sim/coupling/twist_momentum.h"
#include "sim/coupling/wicking.h"

namespace sim {

/// Everything that liquid and fabric do to each other (coupling/README.md, What is kept), in the order in which a step does it.
struct Coupling {
    const Fabric& fabric;
    VertexSorter sorter;
    LiquidAround around;
    PorousElements elements;
    Capture capture;
    Mixture mixture;
    Drip drip;
    Wicking wicking;
    TwistMomentum twist;
    std::vector<Vec3> velocityBefore;  ///< velocity of each vertex as the fabric's part of the step began [cm/s]

    /// @param nominalMass  of a particle of liquid [g]
    Coupling(const Fabric& theFabric, const Settings& settings, double nominalMass)
        : fabric(theFabric),
          around(fabric.vertexCount()),
          elements(fabric),
          capture(fabric, settings, nominalMass),
          mixture(fabric, settings),
          drip(fabric, elements, settings, nominalMass),
          wicking(fabric, elements, settings)
    {
    }
    Coupling(const Coupling&) = delete;  // its parts refer to each other
    Coupling& operator=(const Coupling&) = delete;
};

}  // namespace sim
