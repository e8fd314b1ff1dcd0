#include "sim/transfer/scatter_bounded.h"

#include "sim/core/parallel.h"

#include <cmath>
#include <functional>

namespace sim {

namespace {

/// ½ Σ p q / M for the momenta of both maps [erg]: E(θ) = (1 − θ)² translated + 2 θ (1 − θ) mixed + θ² affine.
struct FaceEnergies {
    double translated = 0.0, mixed = 0.0, affine = 0.0;
    FaceEnergies operator+(const FaceEnergies& o) const { return {translated + o.translated, mixed + o.mixed, affine + o.affine}; }
};

FaceEnergies faceEnergies(const BlockGrid& grid, const BlockArray<double, 3>& translated, const FaceFields& faces)
{
    const auto ofBlock = [&](std::size_t n) {
        const int b = static_cast<int>(n);
        FaceEnergies sum;
        for (int a = 0; a < kAxes; ++a) {
            const double *m = faces.sums.block(b, FaceFields::kMass + a), *affine = faces.sums.block(b, FaceFields::kMomentum + a),
                         *p = translated.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) {
                if (!(m[c] > 0.0)) continue;
                const double half = 0.5 / m[c];
                sum = sum + FaceEnergies{half * p[c] * p[c], half * p[c] * affine[c], half * affine[c] * affine[c]};
            }
        }
        return sum;
    };
    return parallelReduce(grid.count(), FaceEnergies{}, ofBlock, std::plus<>());
}

/// The largest θ up to 1 with E(θ) ≤ energy; 0 where translation alone has that much, to round-off.
double largestShare(const FaceEnergies& e, double energy)
{
    if (e.affine <= energy) return 1.0;
    const double square = e.translated - 2.0 * e.mixed + e.affine, linear = e.mixed - e.translated, rest = e.translated - energy;
    if (rest >= 0.0 || !(square > 0.0)) return 0.0;
    return std::min(1.0, (std::sqrt(linear * linear - square * rest) - linear) / square);
}

}  // namespace

double particlesToFacesBounded(const SortedParticles& sorted, XiMap map, double dt, double energy, BoundedScratch& scratch, FaceFields& faces)
{
    const BlockGrid& grid = sorted.grid;
    particlesToFaces(sorted, scratch.scatter, faces);
    scratch.translated.resize(grid.count());
    parallelFor(grid.count(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        std::copy_n(faces.sums.block(b, FaceFields::kMomentum), kAxes * kBlockCells, scratch.translated.block(b));
    });
    particlesToFacesAffine(sorted, map, dt, faces);
    const double share = largestShare(faceEnergies(grid, scratch.translated, faces), energy);
    if (share == 1.0) return share;
    parallelFor(grid.count(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            double* p = faces.sums.block(b, FaceFields::kMomentum + a);
            const double* translated = scratch.translated.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) p[c] = translated[c] + share * (p[c] - translated[c]);
        }
    });
    return share;
}

}  // namespace sim
