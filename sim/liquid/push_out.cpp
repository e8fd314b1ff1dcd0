#include "sim/liquid/push_out.h"

#include "sim/core/parallel.h"

#include <cmath>

namespace sim {

namespace {

constexpr int kRepeats = 2;  ///< the second for edges, and for distances that are only bounds

void pushOut(const Obstacles& obstacles, double inFront, std::size_t p, LiquidParticles& particles)
{
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        const Vec3 x = particles.position(p);
        const double distance = obstacles.distance(x);
        if (distance >= 0.0) return;
        const Vec3 moved = x + (inFront - distance) * obstacles.normal(x);
        for (int a = 0; a < kAxes; ++a) particles.x[a][p] = moved[a];
    }
}

}  // namespace

void pushOutOfObstacles(const ParticleOrder& order, const BlockGrid& grid, const ObstacleField& field, const Obstacles& obstacles,
                        double farthest, LiquidParticles& particles)
{
    const double safe = 0.5 * std::sqrt(3.0) * grid.dx + farthest;
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int b = order.occupied[n];
        if (!field.nearSolid(b) && farthest < ObstacleField::kExactDistance * grid.dx) return;
        for (int c = 0; c < kBlockCells; ++c) {
            const int i = c & 7, j = c >> 3 & 7, k = c >> 6;
            const int* start = order.cells(b) + cellRank(i, j, k);
            if (start[0] == start[1] || (field.nearSolid(b) && field.centerDistance(b)[c] > safe)) continue;
            for (int s = start[0]; s < start[1]; ++s) pushOut(obstacles, kPushedInFront * grid.dx, s, particles);
        }
    });
}

}  // namespace sim
