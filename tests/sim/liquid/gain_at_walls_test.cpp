// The pressure takes energy from liquid between solids that rest, on faces that weigh the room that these leave.
#include "sim/liquid/gain_at_walls.h"
#include "tests/sim/grid/random_solids.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

double kineticEnergy(GridScene& scene)
{
    double energy = 0.0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        energy += 0.5 * scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] * std::pow(scene.velocity(a, c), 2);
    });
    return energy;
}

/// A drop that strikes a solid, whose faces weigh what there is room for.
GridScene dropOn(const Kind& kind, Chance& chance)
{
    GridScene scene({-8, -8, -8}, {8, 8, 8}, 0.3, chance.inCube(0.3));
    scene.add(kind.make(chance).moved(chance.turn(0.5)));
    const Vec3 velocity = 20.0 * chance.direction(), middle = -0.05 * chance.between(0.0, 1.0) * velocity;
    scene.fill([&](const Vec3& x) { return (x - middle).norm() - 0.9; });
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] *= scene.field.room(ref.block, a)[ref.cell];
    });
    scene.setVelocities([&](const Vec3&) { return velocity; });
    return scene;
}

TEST(GainAtWalls, IsNone)
{
    Chance chance(23);
    double largest = 0.0;
    for (unsigned n = 0; n < 80; ++n) {
        const Kind& kind = kSolidKinds[n % kSolidKinds.size()];
        if (kind.isMesh) continue;
        GridScene scene = dropOn(kind, chance);
        const double before = kineticEnergy(scene);
        GainAtWalls gain;
        gain.begin(scene.field, scene.liquid.faces.velocity);
        scene.project(1.0e-3);
        const double without = kineticEnergy(scene) - before;
        gain.bound(scene.field, scene.liquid.faces.velocity);
        const double with = kineticEnergy(scene) - before;
        largest = std::max(largest, without / before);
        EXPECT_LE(with, 1.0e-12 * before) << kind.name << ", state " << n;
    }
    EXPECT_GT(largest, 0.01) << "without the bound";
}

}  // namespace
}  // namespace sim::test
