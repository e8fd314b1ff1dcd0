#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

#include <vector>

namespace sim {

/// Scratch memory of particlesToFaces, one piece per worker.
struct ScatterScratch {
    std::vector<AlignedArray<double>> perWorker;
};

/// P2G: mass and momentum of every face (translation map: transfer/README.md, Particles to grid), from sorted particles whose modes stand in the rows
/// order.source tells. Same as particlesToFacesReference to round-off. Block by block into a local tile, lanes = the 4×4 plane of
/// nodes around a cell (transfer/README.md, Kernels); tiles are added to the grid in 8 colours, so the order of additions is fixed.
void particlesToFaces(const SortedParticles& sorted, ScatterScratch& scratch, FaceFields& faces);

}  // namespace sim
