// What variants and --set change of a scene.
#include "sim/scene/load_scene.h"
#include "tests/sim/scene/liquid_scene.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using sim::Scene;
using sim::Vec3;

using sim::test::kGrid, sim::test::kSmallest, sim::test::load;

TEST(Overrides, OverridesComeAfterVariantAfterFile)
{
    const std::string text = kSmallest + R"(
time: {dt: 1.0e-3, duration: 3}
transfer: {method: pic, modes: 5}
compare:
  variants:
    - {label: Big Step, time.dt: 2.0e-3, transfer: apic, time: {start: 1}}
)";
    EXPECT_EQ(1.0e-3, load(text).settings.time.dt);
    const Scene variant = load(text, "big_step");
    EXPECT_EQ(2.0e-3, variant.settings.time.dt);
    EXPECT_EQ(3.0, variant.settings.time.duration) << "a map merges with what is there";
    EXPECT_EQ(1.0, variant.settings.time.start);
    EXPECT_EQ(sim::TransferMethod::Apic, variant.settings.transfer.method);
    EXPECT_EQ(5, variant.settings.transfer.modes) << "the short form speaks of the method only";
    EXPECT_EQ(4.0e-3, load(text, "big_step", {"time.dt=3.0e-3", "time.dt=4 ms"}).settings.time.dt);
}

TEST(Overrides, OverridesReachElementsOfLists)
{
    const std::string text = kGrid + R"(
liquid:
  sources:
    - {name: drop, shape: {ball: {center: [0, 0, 0], radius: 1}}, fill: {pattern: reference, seed: 7}}
    - {name: pool, shape: {ball: {center: [5, 0, 0], radius: 1}}, fill: reference}
)";
    const Scene scene = load(text, "",
                             {"liquid.sources.pool.fill=lattice", "liquid.sources.0.fill=jittered", "liquid.sources.1.velocity=[1, 2, 3]",
                              "liquid.sources.pool.shape.ball.radius=2"});
    EXPECT_EQ(sim::FillSettings::Pattern::Jittered, scene.sources[0].fill.pattern);
    EXPECT_EQ(7u, scene.sources[0].fill.seed);
    EXPECT_EQ(sim::FillSettings::Pattern::Lattice, scene.sources[1].fill.pattern);
    EXPECT_EQ(Vec3(1, 2, 3), scene.sources[1].emissions[0].velocity);
    EXPECT_DOUBLE_EQ(-2.0, scene.sources[1].shape.distance(Vec3(5, 0, 0)));
}

TEST(Overrides, OverridesMakeSectionsThatAreNotThere)
{
    EXPECT_EQ(7, load(kSmallest, "", {"solver.max_iterations=7"}).settings.solver.maxIterations);
    EXPECT_EQ(0.5, load(kSmallest, "", {"transfer={damping: {liquid_affine: 0.5}}"}).settings.transfer.affineDamping);
}

TEST(Overrides, OverridesAreInTheUnitsOfTheFile) { EXPECT_DOUBLE_EQ(20.0, load("units: si\n" + kSmallest, "", {"grid.cell=0.2"}).settings.cell); }

TEST(Overrides, VariantsOfAMapAreAProduct)
{
    const sim::SceneFile file =
        sim::sceneFileFromText(kSmallest + "compare: {variants: {transfer.method: [pic, PolyPIC 8], time.dt: [1.0e-3, 2.0e-3]}}\n", "good.yaml");
    ASSERT_EQ(4u, file.variants.size());
    EXPECT_EQ("pic_1_0e_3", file.variants[0].name);
    EXPECT_EQ("pic, 2.0e-3", file.variants[1].label);
    EXPECT_EQ("polypic_8_1_0e_3", file.variants[2].name);
    EXPECT_EQ("time.dt=2.0e-3", file.variants[3].overrides[1].text());
}

}  // namespace
