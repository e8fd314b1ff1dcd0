#include "app/scene/scene_setup.h"

#include <gtest/gtest.h>

namespace app {
namespace {

SceneSetup setupNamed(const std::string& name, const std::string& dir, const std::string& comparison = "")
{
    SceneSetup setup;
    setup.scene.name = name;
    setup.variant = "apic";
    setup.pictures.output.dir = dir;
    setup.pictures.compare.name = comparison;
    return setup;
}

TEST(SceneSetup, FolderOfARunHasItsSceneAndVariant)
{
    EXPECT_EQ(defaultFolder(setupNamed("drop", "")), "out/drop/apic");
    EXPECT_EQ(defaultFolder(setupNamed("drop", "results/{variant}/of_{name}")), "results/apic/of_drop");
}

TEST(SceneSetup, FolderOfAComparisonIsThatOfItsRunsWithoutTheVariant)
{
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "")), "out/drop");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "", "study")), "out/study");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "results/{name}/{variant}")), "results/drop");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "results")), "results");
}

}  // namespace
}  // namespace app
