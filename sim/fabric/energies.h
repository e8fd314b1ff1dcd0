#pragma once

#include "sim/fabric/fabric_energies.h"
#include "sim/fabric/rods/rods.h"
#include "sim/fabric/shells/shells.h"
#include "sim/fabric/vertex_unknowns.h"

#include <vector>

namespace sim {

/// Elastic energies (fabric/rods/README.md, Energies; fabric/shells/README.md, Membrane); the others are 0.
FabricEnergies elasticEnergies(const FabricState& state, const Rods& rods, const Shells& shells);

/// Elastic energies of the last state that was asked for, kept: a step asks for where the one before has ended.
class ElasticEnergies {
 public:
    const FabricEnergies& at(const FabricState& state, const Rods& rods, const Shells& shells);

 private:
    std::vector<Vec3> x_, reference_;
    std::vector<double> theta_, referenceTwist_;
    FabricEnergies energies_;
};

/// Energies of the fabric: elastic, kinetic, potential and of contact; what pins hold is not among them.
FabricEnergies fabricEnergies(const Fabric& fabric, const FabricState& state, const FabricEnergies& elastic, const Vec3& gravity);

/// Gradient of the elastic and viscous energy by positions [dyn] and twist angles [dyn cm].
struct InternalGradient {
    std::vector<Vec3> byPosition;
    std::vector<double> byAngle;
};

/// Rods and shells in a step whose start they know.
struct ElasticStep {
    Rods::Step rods;
    Shells::Step shells;
};

/// Gradient of the energy at a state in a step of length h [s]; with an infinite h the elastic part alone.
InternalGradient internalGradient(const Fabric& fabric, const FabricState& state, double h, const VertexUnknowns& unknowns, const ElasticStep& step);

}  // namespace sim
