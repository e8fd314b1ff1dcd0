#include "sim/scene/load_scene.h"
#include "tests/physics/watched_run.h"

#include <gtest/gtest.h>

#include <filesystem>

// Shipped scenes of fabric at full size and length: nothing crosses, nothing bursts.

namespace sim::test {
namespace {

const std::filesystem::path kScenes = SCENES_DIR;

void expectUntangled(const WatchedRun::Seen& seen)
{
    EXPECT_TRUE(seen.isFinite);
    EXPECT_EQ(seen.flipped, 0);
    EXPECT_EQ(seen.undecided, 0);
    EXPECT_EQ(seen.pierced, 0);
}

/// No pair nearer than half its thickness either (fabric/contact/README.md, Pairs).
void expectThick(const WatchedRun::Seen& seen)
{
    expectUntangled(seen);
    EXPECT_GE(seen.spare, 0.0);
}

/// The published weave, struck by a ball at 300 cm/s: every frame of 2 s (fabric/contact/README.md, Limiter).
TEST(YarnSheet, NoYarnPassesAnother)
{
    WatchedRun run(loadScene(kScenes / "bench/yarn_sheet.yaml"));
    EXPECT_EQ(run.simulation().fabric().rest.size(), 19604u);
    const WatchedRun::Seen& seen = run.run(2.0, 4.0e-3);
    expectThick(seen);
    EXPECT_GE(seen.nearest, 0.5);  // of r_A + r_B
}

/// The published cloth without its pins falls over the ball: every frame of 2 s.
TEST(ClothOverSphere, NoFaceIsPierced)
{
    WatchedRun run(loadScene(kScenes / "bench/cloth_over_sphere.yaml"));
    expectThick(run.run(2.0, 1.0e-2));
    EXPECT_EQ(run.simulation().fabric().rest.size(), 9801u);
}

class ShippedScenes : public testing::TestWithParam<std::tuple<std::string, double>> {};

/// In long steps and with yarns and cloth softer and stiffer than they are. The stiffness of contact is what a step can resolve: yarns
/// come nearer to each other than in short steps, but not past each other. The whole table: tests/bench/stability.
TEST_P(ShippedScenes, StayWholeInLongSteps)
{
    const auto& [name, factor] = GetParam();
    LoadOptions options;
    options.set = {"time.dt=4e-3"};
    Scene scene = loadScene(kScenes / (name + ".yaml"), options);
    for (FabricPiece& piece : scene.fabrics) piece.material.young *= factor;
    WatchedRun run(scene);
    expectUntangled(run.run(4.0, 2.0e-2));  // looks after whole steps: none is cut shorter
}

INSTANTIATE_TEST_SUITE_P(Softness, ShippedScenes,
                         testing::Combine(testing::Values("drape_on_sphere", "yarn_sheet", "twist_and_buckle", "wring_towel"),
                                          testing::Values(0.1, 1.0, 10.0)));

}  // namespace
}  // namespace sim::test
