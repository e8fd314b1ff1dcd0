// What .vtp files hold, as VTK reads it.

#include "app/export/exporter.h"
#include "tests/app/export/geometry_in_test.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace app {
namespace {

using nlohmann::json;
using sim::Vec3;
using test::WetScene;

constexpr double kSingle = std::numeric_limits<float>::epsilon();

void expectClose(const json& read, const Vec3& written)
{
    ASSERT_EQ(read.size(), 3u);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(read[a].get<double>(), written[a], kSingle * std::abs(written[a]));
}

/// An array of one number per point.
double number(const json& part, const char* array, std::size_t point)
{
    return part.at("arrays").at(array).at("values").at(point).at(0).get<double>();
}

/// The parts of one frame of a scene, through a folder and VTK.
json written(const WetScene& scene, std::initializer_list<const char*> parts)
{
    const test::TemporaryFolder folder;
    Exporter(folder.path(), {}, [](std::int64_t) { return 0.0; }).write(scene.frame());
    std::vector<std::filesystem::path> files;
    for (const std::string part : parts) files.push_back(folder / (part + "_00000.vtp"));
    return test::readGeometry(files);
}

TEST(Vtp, LiquidIsReadBackInTheOrderOfItsIds)
{
    WetScene scene;
    scene.state.time = 0.1;
    const json part = written(scene, {"liquid"})[0];
    const sim::LiquidParticles& liquid = scene.state.liquid;
    ASSERT_EQ(part.at("points").size(), liquid.count);
    ASSERT_EQ(part.at("verts").size(), liquid.count);
    EXPECT_EQ(part.at("time"), 0.1);
    EXPECT_EQ(part.at("arrays").at("id").at("type"), "unsigned int");
    EXPECT_EQ(part.at("arrays").size(), 4u);
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const std::size_t i = liquid.id[p] - 100;
        EXPECT_EQ(number(part, "id", i), liquid.id[p]);
        EXPECT_EQ(part.at("verts")[i], json({i}));
        expectClose(part.at("points")[i], liquid.position(p));
        expectClose(part.at("arrays").at("velocity").at("values")[i], liquid.velocity(p));
        EXPECT_NEAR(number(part, "speed", i), liquid.velocity(p).norm(), kSingle * 200.0);
        EXPECT_NEAR(number(part, "volume", i), liquid.mass[p] / test::kDensity, kSingle * 3e-3);
    }
}

}  // namespace
}  // namespace app
