#include "app/scene/loaded_scene.h"

#include <gtest/gtest.h>

namespace app {
namespace {

LoadedScene setupNamed(const std::string& name, const std::string& dir, const std::string& comparison = "")
{
    LoadedScene setup;
    setup.scene.name = name;
    setup.variant = "apic";
    setup.pictures.output.dir = dir;
    setup.pictures.compare.name = comparison;
    return setup;
}

TEST(LoadedScene, FolderOfARunHasItsSceneAndVariant)
{
    EXPECT_EQ(defaultFolder(setupNamed("drop", "")), "out/drop/apic");
    EXPECT_EQ(defaultFolder(setupNamed("drop", "results/{variant}/of_{name}")), "results/apic/of_drop");
}

TEST(LoadedScene, FolderOfAComparisonIsThatOfItsRunsWithoutTheVariant)
{
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "")), "out/drop");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "", "study")), "out/study");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "results/{name}/{variant}")), "results/drop");
    EXPECT_EQ(defaultComparisonFolder(setupNamed("drop", "results")), "results");
}

}  // namespace
}  // namespace app
