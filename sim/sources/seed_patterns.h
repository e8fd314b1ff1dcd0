#pragma once

#include "sim/core/random.h"
#include "sim/particles/point_bins.h"
#include "sim/sources/seed.h"

namespace sim {

/// What a pattern found, for seed.cpp only.
struct PatternPlaces {
    std::vector<Vec3> free;  ///< places without a particle
    std::size_t count = 0;   ///< number of all places of the pattern in the region, those with a particle included
    double tiled = 0.0;      ///< volume of the cubes around a lattice's places; 0 if one sticks out of the region [cm³]
};

PatternPlaces latticePlaces(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing);
/// Places of a moving lattice in the region, on average over the time in which it moves by a pitch.
double meanLatticePlaces(const SeedPlan& plan, const Shape& region);
PatternPlaces referencePlaces(const SeedPlan& plan, const std::vector<Vec3>& existing);
PatternPlaces poissonPlaces(const SeedPlan& plan, const Shape& region, const std::vector<Vec3>& existing);

/// Places nearer to the surface than this count as outside, so that rounding does not decide [pitches].
inline constexpr double kOnSurface = 1.0e-9;

/// Least distance of the poisson pattern in pitches. Darts thrown until hardly any finds room lie about 1 / pitch³
/// dense then.
inline constexpr double kPoissonDistance = 0.83;

/// Places of a lattice that a box may hold: place (i, j, k) + low is at first + pitch (i, j, k), axis by axis.
struct PlaceLattice {
    Vec3 first, pitch = Vec3::Zero();  ///< pitches along the axes [cm]
    Vec3i low = Vec3i::Zero(), size = Vec3i::Zero();

    /// Places from the one that lies `margin` pitches below the box on, up to `margin` above. `origin` is
    /// place (0, 0, 0). Throws InputError when there are more than 4e8, or when the box is unbounded.
    static PlaceLattice inBox(const Eigen::AlignedBox3d& box, const Vec3& origin, const Vec3& pitch, double margin);

    Vec3 position(int i, int j, int k) const { return first + pitch.cwiseProduct(Vec3(i, j, k)); }
    std::uint64_t randomIndex(int i, int j, int k) const { return CounterRandom::placeIndex(i + low[0], j + low[1], k + low[2]); }

    /// All that `body(i, j, k, list)` appends to its list of T, in the order of the places, x fastest.
    template <class T, class Body>
    std::vector<T> collect(Body&& body) const
    {
        const std::size_t rows = static_cast<std::size_t>(size[1]) * size[2];
        std::vector<std::vector<T>> lists(rows);
        parallelFor(rows, [&](std::size_t row) {
            const int j = static_cast<int>(row % size[1]), k = static_cast<int>(row / size[1]);
            for (int i = 0; i < size[0]; ++i) body(i, j, k, lists[row]);
        });
        std::vector<T> all;
        std::size_t count = 0;
        for (const auto& list : lists) count += list.size();
        all.reserve(count);
        for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
        return all;
    }
};

}  // namespace sim
