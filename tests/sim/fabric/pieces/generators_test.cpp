#include "sim/fabric/pieces/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>

namespace {

using sim::FabricGeometry;
using sim::Vec2i;
using sim::Vec3;
using sim::Vec3i;
using sim::Weave;

constexpr double kSpacing = 0.144, kAmplitude = 0.072;  // of the published sheets [cm]

Vec3 sum(const std::vector<Vec3>& points) { return std::accumulate(points.begin(), points.end(), Vec3(Vec3::Zero())); }

FabricGeometry publishedCloth() { return sim::clothGrid({.nodes = {99, 99}, .spacing = {kSpacing, kSpacing}}); }

FabricGeometry publishedYarns(Weave weave = Weave::Herringbone, bool borders = true)
{
    return sim::wovenYarns({.yarns = {100, 100}, .spacing = kSpacing, .amplitude = kAmplitude, .weave = weave, .borders = borders});
}

TEST(ClothGrid, HasThePublishedCountsAndPlaces)
{
    const FabricGeometry cloth = publishedCloth();
    ASSERT_EQ(9801u, cloth.points.size());
    EXPECT_EQ(19208u, cloth.faces.size());
    EXPECT_TRUE(cloth.strands.empty());
    EXPECT_TRUE(sum(cloth.points).isApprox(9801 * Vec3(7.056, 0.0, 7.056), 1.0e-12));
    EXPECT_TRUE(cloth.points[2 * 99 + 5].isApprox(Vec3(0.72, 0.0, 0.288), 1.0e-14));
}

TEST(ClothGrid, CutsEachQuadAlongOneDiagonal)
{
    const FabricGeometry cloth = sim::clothGrid({.nodes = {3, 2}, .spacing = {1.0, 2.0}});
    const std::vector<Vec3i> expected = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}};
    EXPECT_EQ(expected, cloth.faces);
    EXPECT_EQ(Vec3(2.0, 0.0, 2.0), cloth.points[5]);
}

TEST(ClothGrid, IsOrientedAlike)
{
    const FabricGeometry cloth = sim::clothGrid({.nodes = {7, 5}, .spacing = {1.0, 1.0}});
    std::set<std::pair<int, int>> sides;
    for (const Vec3i& f : cloth.faces) {
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(sides.emplace(f[k], f[(k + 1) % 3]).second);
    }
}

TEST(WovenYarns, HaveThePublishedCounts)
{
    const FabricGeometry cloth = publishedYarns();
    EXPECT_EQ(19604u, cloth.points.size());
    ASSERT_EQ(200u, cloth.strands.size());
    std::size_t edges = 0;
    for (const auto& strand : cloth.strands) edges += strand.size() - 1;
    EXPECT_EQ(19800u, edges);
    EXPECT_EQ(19604.0, sim::pointCount(sim::WovenYarns{.yarns = {100, 100}}));
}

TEST(WovenYarns, LieAroundTheMiddle)
{
    // Rows and columns are symmetric about the middle; heights of all x-yarns cancel line by line of the period.
    const FabricGeometry cloth = publishedYarns();
    const Vec3 total = sum(cloth.points);
    EXPECT_NEAR(19604 * 7.128, total[0], 1.0e-8);
    EXPECT_NEAR(19604 * 7.128, total[2], 1.0e-8);
    EXPECT_NEAR(0.0, total[1], 1.0e-10);
}

TEST(WovenYarns, BordersRunThroughTheEndsOfTheOthers)
{
    const FabricGeometry cloth = publishedYarns();
    const auto& left = cloth.strands[196];
    EXPECT_EQ(19600, left.front());
    EXPECT_EQ(19602, left.back());
    EXPECT_EQ(0, left[1]);
    EXPECT_EQ(9700, left[98]);
    const auto& near = cloth.strands[197];
    EXPECT_EQ((std::vector<int>{19600, 9800, 9900}), std::vector<int>(near.begin(), near.begin() + 3));
    EXPECT_EQ(19601, near.back());
    const auto& right = cloth.strands[198];
    EXPECT_EQ((std::vector<int>{19601, 99, 199}), std::vector<int>(right.begin(), right.begin() + 3));
    EXPECT_EQ(19603, right.back());
    const auto& far = cloth.strands[199];
    EXPECT_EQ((std::vector<int>{19602, 9899, 9999}), std::vector<int>(far.begin(), far.begin() + 3));
    EXPECT_EQ(19603, far.back());
    EXPECT_TRUE(cloth.points[19603].isApprox(Vec3(14.256, 0.0, 14.256), 1.0e-14));
    for (int b = 196; b < 200; ++b) EXPECT_EQ(100u, cloth.strands[b].size());
}

/// Over or under, yarn by yarn along u: one character per crossing.
std::string pattern(Weave weave, int k, int count)
{
    std::string out;
    for (int j = 0; j < count; ++j) out += sim::isAbove(weave, j, k) ? '+' : '-';
    return out;
}

TEST(WovenYarns, HerringboneTurnsEveryFourYarns)
{
    const char* expected[] = {"--++--++", "+--++--+", "++--++--", "-++--++-", "-++--++-", "++--++--", "+--++--+", "--++--++"};
    for (int k = 0; k < 24; ++k) EXPECT_EQ(expected[k % 8], pattern(Weave::Herringbone, k, 8)) << k;
}

TEST(WovenYarns, TwillGoesOnePerYarn)
{
    for (int k = 0; k < 9; ++k) {
        const std::string here = pattern(Weave::Twill, k, 12), next = pattern(Weave::Twill, k + 1, 12);
        EXPECT_EQ(here.substr(0, 11), next.substr(1)) << k;
        EXPECT_NE(std::string::npos, here.find("++--++--")) << k;
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(pattern(Weave::Herringbone, k, 8), pattern(Weave::Twill, k, 8)) << k;
}

TEST(WovenYarns, PlainAlternates)
{
    EXPECT_EQ("+-+-", pattern(Weave::Plain, 0, 4));
    EXPECT_EQ("-+-+", pattern(Weave::Plain, 1, 4));
}

TEST(WovenYarns, PassOnOppositeSidesOfEachCrossing)
{
    for (const Weave weave : {Weave::Plain, Weave::Twill, Weave::Herringbone}) {
        const FabricGeometry cloth = publishedYarns(weave);
        std::map<std::pair<int, int>, std::vector<double>> heights;
        for (std::size_t i = 0; i < cloth.points.size(); ++i) heights[{cloth.lattice[i][0], cloth.lattice[i][1]}].push_back(cloth.points[i][1]);
        EXPECT_EQ(10000u, heights.size());
        for (const auto& [place, h] : heights) {
            const bool isInside = place.first > 0 && place.first < 99 && place.second > 0 && place.second < 99;
            ASSERT_EQ(isInside ? 2u : 1u, h.size());
            if (!isInside) continue;
            ASSERT_EQ(0.0, h[0] + h[1]);
            ASSERT_EQ(kAmplitude, std::abs(h[0]));
        }
    }
}

TEST(WovenYarns, FirstYarnHasTheRecipesHeights)
{
    // p(1) = 1: + where (j + 1) mod 4 < 2.
    const FabricGeometry cloth = publishedYarns();
    const double expected[] = {1, -1, -1, 1, 1, -1, -1, 1};
    for (int j = 0; j < 8; ++j) {
        EXPECT_TRUE(cloth.points[j].isApprox(Vec3(kSpacing * j, kAmplitude * expected[j], kSpacing), 1.0e-14)) << j;
    }
    // The first yarn across, m = 1: the opposite of S(1, i), p = 2, 1, 0, −1, −1, 0, 1, 2.
    const double across[] = {1, 1, -1, -1, -1, -1, 1, 1};
    for (int i = 0; i < 8; ++i) {
        EXPECT_TRUE(cloth.points[9800 + i].isApprox(Vec3(kSpacing, kAmplitude * across[i], kSpacing * i), 1.0e-14)) << i;
    }
}

TEST(WovenYarns, WithoutBordersOnlyThoseAreLeftOut)
{
    const FabricGeometry with = publishedYarns(), without = publishedYarns(Weave::Herringbone, false);
    ASSERT_EQ(19600u, without.points.size());
    ASSERT_EQ(196u, without.strands.size());
    EXPECT_TRUE(std::equal(without.points.begin(), without.points.end(), with.points.begin()));
    EXPECT_TRUE(std::equal(without.strands.begin(), without.strands.end(), with.strands.begin()));
}

TEST(WovenYarns, NeedNotBeSquare)
{
    const FabricGeometry cloth = sim::wovenYarns({.yarns = {5, 8}, .spacing = 1.0, .amplitude = 0.5});
    EXPECT_EQ(3u * 8u + 6u * 5u + 4u, cloth.points.size());
    EXPECT_EQ(3u + 6u + 4u, cloth.strands.size());
    EXPECT_EQ(8u, cloth.strands[0].size());
    EXPECT_EQ(5u, cloth.strands[3].size());
    EXPECT_EQ(Vec3(7.0, 0.0, 4.0), cloth.points.back());
    for (const auto& strand : cloth.strands) {  // neighbours are one spacing apart in the plane
        for (std::size_t j = 0; j + 1 < strand.size(); ++j) {
            const Vec3 d = cloth.points[strand[j + 1]] - cloth.points[strand[j]];
            EXPECT_EQ(1.0, d[0] + d[2]);
            EXPECT_EQ(0.0, d[0] * d[2]);
        }
    }
}

TEST(WovenYarns, RunAlongAnyTwoDirections)
{
    const sim::WovenYarns flat{.yarns = {6, 9}, .spacing = 0.1, .amplitude = 0.05, .weave = Weave::Twill};
    sim::WovenYarns upright = flat;
    upright.u = Vec3::UnitY();
    upright.v = Vec3::UnitX();
    const FabricGeometry a = sim::wovenYarns(flat), b = sim::wovenYarns(upright);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i)  // heights along v × u: +y of the flat one, +z of the upright
        EXPECT_EQ(Vec3(a.points[i][2], a.points[i][0], a.points[i][1]), b.points[i]);
}

TEST(Strand, DividesTheSegmentEvenly)
{
    const FabricGeometry yarn = sim::strand(Vec3(1, 0, 0), Vec3(5, 0, 0), 4);
    ASSERT_EQ(5u, yarn.points.size());
    EXPECT_EQ(Vec3(5, 0, 0), yarn.points[4]);
    EXPECT_EQ((std::vector<int>{0, 1, 2, 3, 4}), yarn.strands.at(0));
    for (int i = 0; i < 5; ++i) EXPECT_EQ(Vec3(1 + i, 0, 0), yarn.points[i]);
}

}  // namespace
