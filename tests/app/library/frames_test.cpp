#include "drench/frames.h"

#include "app/backends.h"
#include "app/frames/snapshot_from_state.h"
#include "render/image.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace drench::test {
namespace {

using app::test::TemporaryFolder;

constexpr const char* kScene = DRENCH_SOURCE_DIR "/scenes/drop.yaml";
constexpr const char* kShaders = DRENCH_SOURCE_DIR "/shaders";

/// What the program draws of the start of a scene.
render::Image byProgram()
{
    const TemporaryFolder folder;
    const app::Backends backends = app::drenchBackends();
    const app::LoadedScene setup = backends.loadScene({.file = kScene, .variant = "", .sets = {}});
    const auto simulation = backends.startSimulation(setup);
    app::FrameSnapshot snapshot;
    app::fillSnapshot(simulation->state(), simulation->fabric(), simulation->contacts(), setup.scene.settings.liquid.density,
                      app::extrasOf(setup.pictures.render), snapshot);
    backends.meshObstacles(setup)(0.0, snapshot.obstacles);
    backends.startRenderer(setup, false)(snapshot)(folder / "program.png");
    return render::readPng(folder / "program.png");
}

TEST(LibraryFrames, PicturesAreThoseOfTheProgram)
{
    const Scene scene = Scene::load(kScene);
    const Picture picture = Frames(scene, kShaders).draw(Simulation(scene));
    const render::Image expected = byProgram();
    EXPECT_EQ(picture.width, expected.width);
    EXPECT_EQ(picture.height, expected.height);
    EXPECT_EQ(picture.rgb, expected.pixels);
}

TEST(LibraryFrames, FilesHoldWhatIsDrawn)
{
    const TemporaryFolder folder;
    const Scene scene = Scene::load(kScene);
    const Simulation simulation(scene);
    Frames frames(scene, kShaders);
    const std::string file = frameFile((folder / "pictures").string(), 12);
    EXPECT_TRUE(file.ends_with("/pictures/frame_00012.png"));
    frames.write(simulation, file);
    EXPECT_EQ(render::readPng(file).pixels, frames.draw(simulation).rgb);
    EXPECT_THROW(frames.write(simulation, "/proc/no/such/folder.png"), Error);
}

TEST(LibraryFrames, MistakesAreTold)
{
    Scene scene = Scene::load(kScene);
    EXPECT_THROW(Frames(scene, "/no/such/folder"), Error);
    scene.set("render.size", "[1, 1]");
    EXPECT_THROW(Frames(scene, kShaders), InputError);
}

}  // namespace
}  // namespace drench::test
