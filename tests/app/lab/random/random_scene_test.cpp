#include "app/lab/random/random_scene.h"

#include "app/scene/read_picture_settings.h"
#include "sim/core/check.h"
#include "sim/scene/load_scene.h"

#include <gtest/gtest.h>

#include <set>

namespace app {
namespace {

constexpr int kScenes = 500;

sim::SceneFile fileOf(int number) { return sim::sceneFileFromText(randomScene(1, number).text, randomSceneName(1, number) + ".yaml"); }

TEST(RandomScene, IsOneThatCanBeRead)
{
    for (int n = 0; n < kScenes; ++n) {
        try {
            const sim::SceneFile file = fileOf(n);
            EXPECT_EQ(sim::readScene(file).name, randomSceneName(1, n));
            readPictureSettings(file);
        } catch (const sim::InputError& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

TEST(RandomScene, IsTheSameForTheSameSeedAndNumberOnly)
{
    const auto nameless = [](std::uint64_t seed, int number) {
        std::string text = randomScene(seed, number).text;
        const std::string name = randomSceneName(seed, number);
        return text.erase(text.find(name), name.size());
    };
    std::set<std::string> all;
    for (int n = 0; n < 100; ++n) all.insert(nameless(1, n));
    EXPECT_EQ(all.size(), 100u);
    EXPECT_TRUE(all.contains(nameless(1, 17)));
    EXPECT_FALSE(all.contains(nameless(2, 17)));
}

TEST(RandomScene, HasEverythingAtTimes)
{
    std::set<int> modes;
    std::set<sim::FabricSolver> solvers;
    std::set<sim::TransferMethod> methods;
    std::set<sim::XiMap> maps;
    int liquids = 0, fabrics = 0, both = 0, moving = 0, pins = 0;
    for (int n = 0; n < kScenes; ++n) {
        const sim::Scene scene = sim::readScene(fileOf(n));
        modes.insert(scene.settings.transfer.modes);
        methods.insert(scene.settings.transfer.method);
        maps.insert(scene.settings.transfer.xi);
        if (!scene.fabrics.empty()) solvers.insert(scene.settings.fabric.solver);
        liquids += !scene.sources.empty();
        fabrics += !scene.fabrics.empty();
        both += !scene.sources.empty() && !scene.fabrics.empty();
        for (const sim::ObstacleSettings& obstacle : scene.obstacles) moving += !obstacle.motionText.empty();
        for (const sim::FabricPiece& piece : scene.fabrics) pins += !piece.pins.empty();
    }
    EXPECT_EQ(modes.size(), 27u);
    EXPECT_EQ(solvers.size(), 3u);
    EXPECT_EQ(methods.size(), 4u);
    EXPECT_EQ(maps.size(), 3u);
    for (const int count : {liquids - both, fabrics - both, both, moving, pins}) EXPECT_GT(count, kScenes / 10);
}

}  // namespace
}  // namespace app
