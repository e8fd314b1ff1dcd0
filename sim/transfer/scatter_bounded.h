#pragma once

#include "sim/transfer/scatter.h"
#include "sim/transfer/scatter_affine.h"

namespace sim {

/// Scratch memory of particlesToFacesBounded.
struct BoundedScratch {
    ScatterScratch scatter;
    BlockArray<double, 3> translated;  ///< momentum of the faces where polynomials are only translated [g cm/s]
};

/// P2G along an affine map as far as it gives the faces no more energy than the particles have. The map alone makes gradients steeper where
/// the flow converges, and so adds energy at second order of dt |C|, without a bound over many steps. Plain translation adds none. The
/// momenta of the faces are those of the translation plus the largest share of the difference, the same for all faces, that keeps
/// Σ p² / 2M within the particles' energy: what both maps conserve is conserved.
/// @param energy  of the particles, kinetic and modal [erg]
/// @return the share of the affine map, 0 … 1
double particlesToFacesBounded(const SortedParticles& sorted, XiMap map, double dt, double energy, BoundedScratch& scratch, FaceFields& faces);

}  // namespace sim
