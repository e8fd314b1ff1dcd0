#include "app/frames/snapshot_lines.h"

#include "app/frames/snapshot_from_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace app::test {
namespace {

using sim::Vec3;
using sim::Vec3i;

double lengthOf(const FrameSnapshot::Lines& lines, std::size_t segment) { return (lines.points[2 * segment + 1] - lines.points[2 * segment]).norm(); }

TEST(BlockEdges, EachOfTwoNeighboursOnce)
{
    sim::BlockGrid grid;
    grid.dx = 0.25;
    grid.origin = {1.0, -1.0, 0.5};
    const std::array blocks = {Vec3i(0, 0, 0), Vec3i(1, 0, 0)};
    grid.setBlocks(blocks);
    const FrameSnapshot::Lines lines = blockEdges(grid);
    ASSERT_EQ(lines.points.size(), 2u * 20u) << "12 + 12, less the 4 they share";
    Eigen::AlignedBox3f box;
    for (std::size_t s = 0; s < 20; ++s) {
        EXPECT_NEAR(lengthOf(lines, s), 2.0, 1.0e-6);
        box.extend(lines.points[2 * s]).extend(lines.points[2 * s + 1]);
    }
    EXPECT_EQ(box.min(), Eigen::Vector3f(1.0f, -1.0f, 0.5f));
    EXPECT_EQ(box.max(), Eigen::Vector3f(5.0f, 1.0f, 2.5f));
}

TEST(VelocityArrows, LeadToWhereParticlesCome)
{
    sim::LiquidParticles liquid;
    liquid.add({1.0, 2.0, 3.0}, 1.0, 7, {10.0, 0.0, -20.0});
    const auto [shafts, heads] = velocityArrows(liquid, 0.1, 0.0f);
    ASSERT_EQ(shafts.points.size(), 2u);
    ASSERT_EQ(heads.points.size(), 2u);
    EXPECT_TRUE(shafts.points[0].isApprox(Eigen::Vector3f(1.0f, 2.0f, 3.0f)));
    EXPECT_TRUE(heads.points[1].isApprox(Eigen::Vector3f(2.0f, 2.0f, 1.0f)));
    EXPECT_EQ(shafts.points[1], heads.points[0]) << "the head sits on the shaft";
    EXPECT_TRUE(heads.isTapered);
    EXPECT_LT(lengthOf(heads, 0), lengthOf(shafts, 0));
}

/// Of many particles some have arrows, the same whatever order they are in.
TEST(VelocityArrows, AreOfAFewParticlesEvenlyById)
{
    constexpr std::size_t kParticles = 10 * kMostArrows + 5;
    sim::LiquidParticles liquid, reversed;
    for (std::size_t p = 0; p < kParticles; ++p) {
        liquid.add({static_cast<double>(p), 0.0, 0.0}, 1.0, static_cast<std::uint32_t>(p), Vec3::UnitY());
        const std::size_t q = kParticles - 1 - p;
        reversed.add({static_cast<double>(q), 0.0, 0.0}, 1.0, static_cast<std::uint32_t>(q), Vec3::UnitY());
    }
    const auto placesOf = [](const sim::LiquidParticles& of) {
        const auto [shafts, heads] = velocityArrows(of, 1.0, 0.0f);
        std::set<float> places;
        for (std::size_t i = 0; i < shafts.points.size(); i += 2) places.insert(shafts.points[i].x());
        return places;
    };
    const std::set<float> places = placesOf(liquid);
    EXPECT_LE(places.size(), kMostArrows);
    EXPECT_GT(places.size(), kMostArrows * 9 / 10);
    EXPECT_EQ(places, placesOf(reversed));
    for (auto next = std::next(places.begin()); next != places.end(); ++next) ASSERT_EQ(*next - *std::prev(next), 11.0f);
}

TEST(ContactLines, JoinTheNearestPoints)
{
    const std::vector<Vec3> x = {{0, 0, 0}, {4, 0, 0}, {1, 1, -1}, {1, 1, 1}, {2, 3, 0}};
    sim::Fabric fabric;
    fabric.strands.radius = {{0.1, 0.2}};
    sim::ActiveContacts contacts;
    contacts.vertices = {{0, 1, 2, 3}, {4, 0, 1, 2}};
    contacts.firstSide = {2, 1};
    contacts.weights = {{0.75, 0.25, -0.5, -0.5}, {1.0, -0.25, -0.25, -0.5}};
    const FrameSnapshot::Lines lines = contactLines(contacts, fabric, x);
    ASSERT_EQ(lines.points.size(), 4u);
    EXPECT_EQ(lines.points[0], Eigen::Vector3f(1, 0, 0));
    EXPECT_EQ(lines.points[1], Eigen::Vector3f(1, 1, 0));
    EXPECT_EQ(lines.points[2], Eigen::Vector3f(2, 3, 0));
    EXPECT_EQ(lines.points[3], Eigen::Vector3f(1.5f, 0.5f, -0.5f));
    EXPECT_GT(lines.lift, 0.2f) << "out of the yarn";
}

TEST(Snapshot, HasTheLinesThatAreWantedAndNoOthers)
{
    sim::State state;
    state.grid.setBlocks(std::array{Vec3i(0, 0, 0)});
    state.pressure.resize(1);
    state.liquid.add({1.0, 1.0, 1.0}, 1.0, 0, Vec3::UnitX());
    state.fabric.x = {{0, 0, 0}, {4, 0, 0}, {1, 1, -1}, {1, 1, 1}};
    sim::ActiveContacts contacts;
    contacts.vertices = {{0, 1, 2, 3}};
    contacts.firstSide = {2};
    contacts.weights = {{0.75, 0.25, -0.5, -0.5}};
    const auto groups = [&](const SnapshotExtras& extras) {
        std::vector<FrameSnapshot::Lines> lines;
        takeLines(state, {}, &contacts, extras, 0.1f, lines);
        return lines.size();
    };
    EXPECT_EQ(groups({}), 0u);
    EXPECT_EQ(groups({.blocks = true}), 1u);
    EXPECT_EQ(groups({.arrows = true}), 2u) << "shafts and heads";
    EXPECT_EQ(groups({.contacts = true}), 1u);

    FrameSnapshot snapshot;
    state.fabric.x.clear();
    fillSnapshot(state, {}, nullptr, 1.0, {.blocks = true}, snapshot);
    ASSERT_EQ(snapshot.view().lines.size(), 1u);
    EXPECT_EQ(snapshot.view().lines[0].points.size(), 24u);
    EXPECT_EQ(snapshot.view().lines[0].width, snapshot.lines[0].width);
    fillSnapshot(state, {}, nullptr, 1.0, {}, snapshot);
    EXPECT_TRUE(snapshot.view().lines.empty()) << "nothing is left of an earlier frame";
}

}  // namespace
}  // namespace app::test
