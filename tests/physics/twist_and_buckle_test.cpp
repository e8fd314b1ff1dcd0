#include "sim/scene/load_scene.h"
#include "tests/physics/watched_run.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace sim::test {
namespace {

/// The shipped scene's rods coil up and come to rest in their coils. With a Newton that knows nothing of their torque they tremble: 2e3 erg.
/// With friction that has a moment about the pairs it holds, what turns in the coils gains energy, until it is jammed at 3.2 s.
TEST(TwistAndBuckle, ComesToRest)
{
    WatchedRun run(loadScene(std::filesystem::path(SCENES_DIR) / "twist_and_buckle.yaml"));
    const WatchedRun::Seen& seen = run.run(5.0, 0.1);
    EXPECT_TRUE(seen.isFinite);
    EXPECT_EQ(seen.flipped + seen.undecided + seen.pierced, 0);
    EXPECT_GE(seen.spare, 0.0) << "no pair nearer than half its thickness";
    EXPECT_LT(run.simulation().energies().fabric.kinetic, 10.0);  // erg
}

}  // namespace
}  // namespace sim::test
