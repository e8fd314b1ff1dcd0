#pragma once

#include "sim/core/units.h"
#include "sim/grid/obstacles.h"

#include <array>
#include <random>

// Solids of many kinds, sizes, places and motions, for laws that hold for all of them.

namespace sim::test {

struct Chance {
    std::mt19937 random;

    explicit Chance(unsigned seed) : random(seed) {}

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
    Vec3 inCube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    Vec3 direction()
    {
        Vec3 v = inCube(1.0);
        while (v.squaredNorm() < 1.0e-2 || v.squaredNorm() > 1.0) v = inCube(1.0);
        return v.normalized();
    }
    Eigen::Isometry3d turn(double far)
    {
        return Eigen::Translation3d(inCube(far)) * Eigen::Isometry3d(Eigen::AngleAxisd(between(-kPi, kPi), direction()));
    }
};

/// Of corners that are counted along x, then y, then z.
inline const std::vector<Vec3i> kFacesOfBox = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                               {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

inline Shape meshOfBox(const Vec3& half, double cell)
{
    std::vector<Vec3> corners;
    for (int n = 0; n < 8; ++n) corners.push_back(half.cwiseProduct(Vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1)));
    return Shape::mesh(corners, kFacesOfBox, cell);
}

struct Kind {
    const char* name;
    Shape (*make)(Chance&);
    bool isMesh = false;
};

/// Of sizes about 1 cm, around the origin.
inline const std::array kSolidKinds = {
    Kind{"box", [](Chance& c) { return Shape::box(Vec3::Zero(), Vec3(0.6, 0.6, 0.6) + c.inCube(0.4)); }},
    Kind{"plate",
         [](Chance& c) {
             return Shape::box(Vec3::Zero(), {0.5 * c.between(0.01, 0.1), 1.2, 1.0});
         }},
    Kind{"rounded box", [](Chance& c) { return Shape::roundedBox(Vec3::Zero(), Vec3(0.6, 0.6, 0.6) + c.inCube(0.4), 0.2); }},
    Kind{"ball", [](Chance& c) { return Shape::ball(Vec3::Zero(), c.between(0.2, 1.2)); }},
    Kind{"wire", [](Chance& c) { return Shape::capsule(c.inCube(1.0), c.inCube(1.0), c.between(0.03, 0.3)); }},
    Kind{"disc", [](Chance& c) { return Shape::cylinder(Vec3::Zero(), c.direction(), 1.0, c.between(0.02, 0.5), 0.01); }},
    Kind{"cross",
         [](Chance& c) {
             return Shape::unite(
                 {Shape::box(Vec3::Zero(), {1.2, c.between(0.05, 0.4), 0.7}), Shape::box(Vec3::Zero(), {c.between(0.05, 0.4), 1.2, 0.9})});
         }},
    Kind{"cup",
         [](Chance& c) {
             const double wall = c.between(0.02, 0.3);
             return Shape::subtract({Shape::box(Vec3::Zero(), {1.0, 0.8, 1.0}), Shape::box({0.0, wall, 0.0}, {1.0 - wall, 0.8, 1.0 - wall})});
         }},
    Kind{"bowl",
         [](Chance& c) {
             const double radius = c.between(0.7, 1.2);
             return Shape::subtract({Shape::ball(Vec3::Zero(), radius), Shape::ball(Vec3::Zero(), radius - c.between(0.03, 0.3)),
                                     Shape::box({0.0, 1.5, 0.0}, {2.0, 1.5, 2.0})});
         }},
    Kind{"vessel", [](Chance& c) { return Shape::box(Vec3::Zero(), Vec3(1.2, 1.2, 1.2) + c.inCube(0.5)).inverted(); }},
    Kind{"mesh", [](Chance& c) { return meshOfBox(Vec3(0.6, 0.6, 0.6) + c.inCube(0.4), 0.1); }, true},
    Kind{"mesh of a plate",
         [](Chance& c) {
             return meshOfBox({c.between(0.03, 0.1), 1.0, 0.8}, 0.05);
         },
         true}};

/// A motion over the first second that goes and turns by any amount up to these [cm], [rad].
inline Motion randomMotion(Chance& chance, double far, double angle)
{
    Motion motion;
    motion.addTranslation(0.0, 1.0, chance.inCube(far), 0.0, 0.0);
    motion.addRotation(0.0, 1.0, {chance.direction(), chance.inCube(1.0)}, chance.between(-angle, angle), 0.0, 0.0);
    return motion;
}

}  // namespace sim::test
