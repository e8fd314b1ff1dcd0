#include "sim/liquid/relax_at_walls.h"

#include "sim/core/parallel.h"

#include <cmath>
#include <functional>

namespace sim {

namespace {

using Displacements = std::array<AlignedArray<double>, kAxes>;

Vec3 at(const Displacements& all, std::size_t s) { return {all[0][s], all[1][s], all[2][s]}; }

void set(Displacements& all, std::size_t s, const Vec3& value)
{
    for (int a = 0; a < kAxes; ++a) all[a][s] = value[a];
}

/// Leave out of a displacement what goes into the nearest solid.
void stopAtSurface(const Obstacles& obstacles, const Vec3& x, std::size_t s, Displacements& displacement)
{
    const Vec3 d = at(displacement, s);
    const double distance = obstacles.distance(x);
    if (distance >= d.norm()) return;
    const Vec3 normal = obstacles.normal(x);
    const double beyond = -d.dot(normal) - std::max(0.0, distance);
    if (beyond > 0.0) set(displacement, s, d + beyond * normal);
}

/// Weight times displacement along gravity, and against it, both positive.
struct Weighed {
    double down = 0.0, up = 0.0;  ///< [erg]

    Weighed operator+(const Weighed& other) const { return {down + other.down, up + other.up}; }
};

}  // namespace

void keepRelaxationFromLifting(const ParticleOrder& order, const CutGrid& cut, const Vec3& gravity, double farthest, const LiquidParticles& particles,
                               Displacements& displacement)
{
    const double safe = 0.5 * std::sqrt(3.0) * cut.grid.dx + farthest;
    const auto ofBlock = [&](std::size_t n) {
        const int b = order.occupied[n];
        Weighed weighed;
        const bool isNear = !cut.obstacles.empty() && (cut.field.nearSolid(b) || farthest >= ObstacleField::kExactDistance * cut.grid.dx);
        for (int c = 0; isNear && c < kBlockCells; ++c) {
            const int* start = order.cells(b) + cellRank(c & 7, c >> 3 & 7, c >> 6);
            if (start[0] == start[1] || (cut.field.nearSolid(b) && cut.field.centerDistance(b)[c] > safe)) continue;
            for (int s = start[0]; s < start[1]; ++s) stopAtSurface(cut.obstacles, particles.position(s), s, displacement);
        }
        for (int s = order.begin(b); s < order.end(b); ++s) {
            const double work = particles.mass[s] * gravity.dot(at(displacement, s));
            (work > 0.0 ? weighed.down : weighed.up) += std::abs(work);
        }
        return weighed;
    };
    const Weighed all = parallelReduce(order.occupied.size(), Weighed{}, ofBlock, std::plus<>());
    if (all.up <= all.down) return;
    const double kept = all.down / all.up;
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int b = order.occupied[n];
        for (int s = order.begin(b); s < order.end(b); ++s) {
            const Vec3 d = at(displacement, s);
            if (gravity.dot(d) < 0.0) set(displacement, s, kept * d);
        }
    });
}

}  // namespace sim
