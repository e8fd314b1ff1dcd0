#include "sim/liquid/push_out.h"

#include "sim/core/parallel.h"

#include <cmath>
#include <functional>

namespace sim {

namespace {

constexpr int kRepeats = 2;         ///< the second for edges, and for distances that are only bounds
constexpr int kSlides = 3;           ///< along as many surfaces a particle goes in one step: a corner has three
constexpr double kResolution = 5.0e-3;  ///< of paths: thinner walls may be missed [cells]

/// The nearest place outside of all solids, a little in front.
Vec3 outside(const Obstacles& obstacles, double inFront, Vec3 x)
{
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        const double distance = obstacles.distance(x);
        if (distance >= 0.0) return x;
        x += (inFront - distance) * obstacles.normal(x);
    }
    return x;
}

/// Where a particle gets that wants to go from one place to another, along the surfaces that it meets.
/// @param normal  out: of the last of them
Vec3 slide(const Obstacles& obstacles, double dx, const Vec3& from, const Vec3& to, Vec3& normal)
{
    const double inFront = kPushedInFront * dx, resolution = kResolution * dx;
    auto contact = obstacles.firstContact(from, to, resolution);
    if (!contact) return to;
    Vec3 end = to;
    for (int n = 0; n < kSlides; ++n) {
        normal = contact->normal;
        Vec3 at = contact->x + inFront * normal;
        if (obstacles.distance(at) <= 0.0) at = contact->x;
        const Vec3 rest = end - at;
        end = outside(obstacles, inFront, at + rest - std::min(0.0, rest.dot(normal)) * normal);
        contact = obstacles.firstContactAtEnd(at, end, resolution);
        if (!contact) return end;
        if (n + 1 == kSlides) return at;
    }
    return end;
}

/// Take away the velocity towards the solid at a particle.
PushedOut stop(const Vec3& wall, const Vec3& normal, std::size_t p, LiquidParticles& particles)
{
    const Vec3 velocity = particles.velocity(p);
    const double towards = std::min(0.0, (velocity - wall).dot(normal)), mass = particles.mass[p];
    for (int a = 0; a < kAxes; ++a) particles.mode(a, 0)[p] -= towards * normal[a];
    return {0.5 * mass * towards * (2.0 * velocity.dot(normal) - towards), -mass * towards * wall.dot(normal), Vec3::Zero()};
}

PushedOut keepOut(const Obstacles& obstacles, double dx, const std::array<AlignedArray<double>, kAxes>* before, std::size_t p, LiquidParticles& particles)
{
    const Vec3 x = particles.position(p);
    Vec3 moved = x, normal = Vec3::Zero();
    if (before != nullptr) moved = slide(obstacles, dx, {(*before)[0][p], (*before)[1][p], (*before)[2][p]}, x, normal);
    if (normal.isZero() && obstacles.distance(moved) < 0.0) {
        normal = obstacles.normal(moved);
        moved = outside(obstacles, kPushedInFront * dx, moved);
    }
    if (normal.isZero()) return {};
    for (int a = 0; a < kAxes; ++a) particles.x[a][p] = moved[a];
    const Vec3 wall = obstacles.anyMoving() ? obstacles.velocity(moved) : Vec3(Vec3::Zero());
    PushedOut pushed = stop(wall, normal, p, particles);
    if (!wall.isZero()) pushed.carried = particles.mass[p] * (moved - x);
    return pushed;
}

}  // namespace

PushedOut pushOutOfObstacles(const ParticleOrder& order, const BlockGrid& grid, const ObstacleField& field, const Obstacles& obstacles,
                          double farthest, const std::array<AlignedArray<double>, kAxes>* before, LiquidParticles& particles)
{
    const double safe = 0.5 * std::sqrt(3.0) * grid.dx + farthest;
    const auto ofBlock = [&](std::size_t n) {
        const int b = order.occupied[n];
        PushedOut pushed;
        if (!field.nearSolid(b) && farthest < ObstacleField::kExactDistance * grid.dx) return pushed;
        for (int c = 0; c < kBlockCells; ++c) {
            const int i = c & 7, j = c >> 3 & 7, k = c >> 6;
            const int* start = order.cells(b) + cellRank(i, j, k);
            if (start[0] == start[1] || (field.nearSolid(b) && field.centerDistance(b)[c] > safe)) continue;
            for (int s = start[0]; s < start[1]; ++s) pushed = pushed + keepOut(obstacles, grid.dx, before, s, particles);
        }
        return pushed;
    };
    return parallelReduce(order.occupied.size(), PushedOut{}, ofBlock, std::plus<>());
}

}  // namespace sim
