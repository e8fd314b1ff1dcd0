#include "sim/scene/fabric_presets.h"
#include "sim/core/units.h"
#include "sim/fabric/fabric.h"
#include "tests/sim/scene/fabric_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

// Presets of common fabrics, and cloth whose warp and weft differ.

namespace {

using sim::Scene;
using sim::Vec3;
using sim::test::load;

const std::string kSheet = "fabrics: [{cloth_grid: {material: cloth, nodes: [3, 3], size: 1}}]\n";

Scene withMaterial(const std::string& material, const std::string& rest = kSheet)
{
    return load("grid: {cell: 0.1}\nmaterials: {cloth: " + material + "}\n" + rest);
}

TEST(FabricPresets, WeighAndBendAsMeasuredFabricsDo)
{
    ASSERT_GE(sim::fabricPresets().size(), 8u);
    for (const sim::FabricPreset& preset : sim::fabricPresets()) {
        // From the tenth to the ninetieth percent of 618 fabrics (Feng et al. 2022).
        EXPECT_GE(preset.mass, 0.00585) << preset.name;
        EXPECT_LE(preset.mass, 0.0424) << preset.name;
        for (const double bending : preset.bending) {
            const double length = std::cbrt(bending / (981.0 * preset.mass));
            EXPECT_GE(length, 1.23) << preset.name;
            EXPECT_LE(length, 3.07) << preset.name;
        }
        EXPECT_GT(preset.volumeFraction(), 0.05) << preset.name;
        EXPECT_LT(preset.volumeFraction(), 0.5) << preset.name;
    }
}

TEST(FabricPresets, ClothOfOneHasItsMassAndThickness)
{
    const Scene scene = withMaterial("{preset: denim}", "fabrics: [{cloth_grid: {material: cloth, nodes: [5, 4], size: [2, 3]}}]\n");
    const sim::FabricPiece& piece = scene.fabrics.at(0);
    const sim::Fabric fabric = sim::assembleFabric({&piece, 1});
    EXPECT_NEAR(6.0 * 0.0324, std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0), 1.0e-12);
    EXPECT_EQ((std::array{0.035, 0.035}), piece.radius);
    EXPECT_EQ((std::array{642.0, 198.2}), piece.material.bendingStiffness);
    EXPECT_EQ(0.0013, scene.settings.porous.fibreDiameter);
    EXPECT_NEAR(0.6, std::tan(piece.material.frictionAngle), 1.0e-12);
}

TEST(FabricPresets, WhatStandsBesideThemHolds)
{
    const sim::FabricMaterial m =
        withMaterial("{preset: wool, bending_stiffness: 90, friction_angle: 45, volume_fraction: 0.2}").materials.at(0).material;
    EXPECT_EQ((std::array{90.0, 90.0}), m.bendingStiffness);
    EXPECT_EQ((std::array{1.0e6, 6.0e5}), m.stretchStiffness);
    EXPECT_DOUBLE_EQ(sim::kPi / 4.0, m.frictionAngle);
    EXPECT_EQ(0.2, m.volumeFraction);
    const sim::FabricMaterial young = withMaterial("{preset: wool, young: 1.0e+6}").materials.at(0).material;
    EXPECT_EQ(1.0e6, young.young);
    EXPECT_FALSE(young.hasWarp());
    EXPECT_EQ(0.0568, young.thickness);
}

TEST(FabricPresets, PrintedScenesReadBackToTheSame)
{
    const Scene before = withMaterial("{preset: silk}", "fabrics: [{cloth_grid: {material: cloth, nodes: [3, 3], size: 1, warp: [1, 0, 1]}}]\n");
    const Scene after = load(sim::printScene(before));
    const sim::FabricMaterial &a = before.materials.at(0).material, &b = after.materials.at(0).material;
    EXPECT_EQ(a.young, b.young);
    EXPECT_EQ(a.thickness, b.thickness);
    EXPECT_EQ(a.stretchStiffness, b.stretchStiffness);
    EXPECT_EQ(a.shearStiffness, b.shearStiffness);
    EXPECT_EQ(a.bendingStiffness, b.bendingStiffness);
    EXPECT_EQ(a.frictionAngle, b.frictionAngle);
    EXPECT_EQ(before.settings.porous.fibreDiameter, after.settings.porous.fibreDiameter);
    EXPECT_EQ(before.fabrics.at(0).radius, after.fabrics.at(0).radius);
    EXPECT_LT((before.fabrics.at(0).warp - after.fabrics.at(0).warp).norm(), 1.0e-15);
}

TEST(FabricPresets, TwoKindsOfFibresInLiquidNeedOneDiameter)
{
    const std::string two =
        "grid: {cell: 0.5}\nmaterials: {a: {preset: silk}, b: {preset: wool}}\n"
        "fabrics: [{cloth_grid: {material: a, nodes: [3, 3], size: 1}}]\n";
    const std::string drop = "liquid: {sources: [{shape: {ball: {center: [0, 2, 0], radius: 1}}}]}\n";
    EXPECT_EQ(0.0012, load(two).settings.porous.fibreDiameter);
    EXPECT_ANY_THROW(load(two + drop));
    EXPECT_EQ(0.002, load(two + drop + "porous: {fibre_diameter: 0.002, volume_fraction: 0.3}\n").settings.porous.fibreDiameter);
}

TEST(Warp, RunsAlongTheFirstAxisOrAsTheSceneSays)
{
    const auto warp = [](const std::string& piece) { return withMaterial("{preset: denim}", "fabrics: [{" + piece + "}]\n").fabrics.at(0).warp; };
    const std::string grid = "cloth_grid: {material: cloth, nodes: [3, 3], size: 1, u: [0, 0, 1], v: [1, 0, 0]";
    EXPECT_EQ(Vec3(0, 0, 1), warp(grid + "}"));
    EXPECT_EQ(Vec3(0.6, 0, 0.8), warp(grid + ", warp: [3, 0, 4]}"));
    EXPECT_LT((warp(grid + "}, transform: {rotate: {axis: [1, 0, 0], angle: 90}}") - Vec3(0, -1, 0)).norm(), 1.0e-12);
}

}  // namespace
