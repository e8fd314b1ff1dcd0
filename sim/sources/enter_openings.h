#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"

#include <vector>

namespace sim {

/// A layer of particles as thick as their pitch that fills an opening, just inside of the face of the domain.
struct OpeningLayer {
    std::vector<Vec3> places;
    std::vector<double> volumes;    ///< [cm^3]
    double pitch = 0.0;             ///< thickness [cm]
    double atFace = 0.0;            ///< coordinate of the face along its axis [cm]
    Vec3 corner = Vec3::Zero();     ///< lowest corner of the columns of liquid behind the face, about one for each place [cm]
    Vec3 width = Vec3::Zero();      ///< their width; along the axis how far behind the face is looked [cm]
    Vec3i columns = Vec3i::Ones();  ///< their number along each axis
    /// What is nearest to the face in a column.
    struct Nearest {
        double distance;  ///< from the face [cm]
        int particle;
    };
    std::vector<Nearest> nearest;  ///< by columns
};

struct PassageWorkspace {
    std::vector<OpeningLayer> layers;  ///< layers of the openings, while no obstacle moves
    std::vector<Vec3> positions;
};

/// Lays the particles that have come in through the openings when a step of dt [s] begins. Those of an inlet come in layers, which move with the
/// inlet's velocity from the face on, so that the volume that has come in is area times velocity times time, to within one of them. At an outlet
/// particles are laid behind those that move inwards, up to its level, as they leave room at the face. All are entered in the ledger.
/// @param packing  mass of a full cell relative to the density of the liquid times its volume [-]
void enterOpenings(const Scene& scene, double packing, double dt, State& state, PassageWorkspace& work);

/// The layer of an opening with its face: liquid below its level, outside of the obstacles where they are at a time [s]. Without places if there is
/// none.
OpeningLayer layerOf(const Scene& scene, const OpeningSettings& opening, double time);

}  // namespace sim
