#include "tests/physics/fabric_runs.h"
#include "tests/physics/intersection_check.h"

#include <gtest/gtest.h>

// Nothing ever passes through fabric (fabric/contact/README.md, Limiter).

namespace sim::test {
namespace {

using testing::pieceOf;

constexpr double kPitch = 0.144;

/// The published scene's weave, coarse: 20 by 20 yarns in two layers, held at its corners.
FabricPiece weave(Weave kind = Weave::Herringbone)
{
    WovenYarns yarns;
    yarns.yarns = Vec2i(20, 20);
    yarns.spacing = kPitch;
    yarns.amplitude = 0.072;
    yarns.weave = kind;
    FabricPiece piece = pieceOf(wovenYarns(yarns), testing::wool(), {0.048, 0.048});
    const int points = static_cast<int>(piece.points.size());
    piece.pins.push_back(pinned({points - 4, points - 3, points - 2, points - 1}));
    return piece;
}

ObstacleSettings ball(const Vec3& center, double radius, const Motion& motion = {})
{
    ObstacleSettings obstacle;
    obstacle.name = "ball";
    obstacle.shape = Shape::ball(center, radius);
    obstacle.motion = motion;
    return obstacle;
}

/// Passed through on purpose, the checker sees it: a weave's upper layer pulled down through the lower one.
TEST(CrossingChecker, SeesWhatHasPassedThrough)
{
    const Fabric fabric = testing::fabricOf(weave(Weave::Plain));
    Crossings crossings(fabric, Vec3::UnitY());
    EXPECT_EQ(crossings.size(), 18u * 18u);
    EXPECT_EQ(crossings.count(fabric.rest).flipped, 0);
    EXPECT_GT(crossings.nearness(fabric.rest).spare, 0.0);

    std::vector<Vec3> x = fabric.rest;
    x[5 * 20 + 7].y() *= -3.0;  // one vertex of one yarn, through the one that crosses there
    EXPECT_EQ(crossings.count(x).flipped, 1);
    for (Vec3& p : x) p = Vec3(p.x(), 0.1 * p.y(), p.z());
    EXPECT_LT(crossings.nearness(x).spare, 0.0);
}

TEST(CrossingChecker, SeesFacesThatArePierced)
{
    ClothGrid grid;
    grid.nodes = Vec2i(5, 5);
    grid.spacing = {0.1, 0.1};
    FabricPiece lower = pieceOf(clothGrid(grid), testing::wool(), {0.005, 0.005});
    grid.origin = Vec3(0.03, 0.1, 0.02);
    const FabricPiece upper = pieceOf(clothGrid(grid), testing::wool(), {0.005, 0.005});
    const Fabric fabric = assembleFabric(std::vector<FabricPiece>{lower, upper});
    std::vector<Vec3> x = fabric.rest;
    EXPECT_EQ(piercedFaces(fabric, x), 0);
    x[25 + 12].y() -= 0.15;  // the upper one's middle
    EXPECT_GT(piercedFaces(fabric, x), 0);
}

/// Two yarns, one above the other, turned about the vertical by an angle; heights of the upper one.
std::vector<Vec3> turnedYarns(const Fabric& fabric, double degrees, double height)
{
    std::vector<Vec3> x = fabric.rest;
    const double c = std::cos(degrees * kPi / 180.0), s = std::sin(degrees * kPi / 180.0);
    for (std::size_t v = x.size() / 2; v < x.size(); ++v) x[v] = Vec3(c * x[v].z(), height, s * x[v].z());
    return x;
}

TEST(CrossingChecker, TellsYarnsThatTurnFromYarnsThatPass)
{
    const auto yarn = [](const Vec3& from, const Vec3& to) { return pieceOf(strand(from, to, 9), testing::wool(), {0.02, 0.02}); };
    const Fabric fabric =
        assembleFabric(std::vector<FabricPiece>{yarn(Vec3(-1.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)), yarn(Vec3(0.0, 0.05, -1.0), Vec3(0.0, 0.05, 1.0))});
    Crossings turned(fabric, Vec3::UnitY()), passed(fabric, Vec3::UnitY());
    ASSERT_EQ(turned.size(), 1u);
    for (double angle : {90.0, 40.0, 3.0, -3.0, -40.0, -90.0}) EXPECT_EQ(turned.count(turnedYarns(fabric, angle, 0.05)).flipped, 0) << angle;
    EXPECT_EQ(turned.count(turnedYarns(fabric, -90.0, -0.05)).flipped, 1) << "through each other after they turned";
    EXPECT_EQ(passed.count(turnedYarns(fabric, 90.0, 0.05)).flipped, 0);
    EXPECT_EQ(passed.count(turnedYarns(fabric, 90.0, -0.05)).flipped, 1);
}

/// A ball of 1.44 cm across strikes the weave at 300 cm/s and drives it 1.2 cm ahead.
TEST(Weave, NoYarnPassesAnotherWhenABallStrikes)
{
    const double middle = 0.5 * kPitch * 19, radius = 0.72;
    Motion strike;
    strike.addTranslation(0.0, 5.0e-3, Vec3(0.0, -1.5, 0.0), 0.0, 0.0);
    const FabricPiece piece = weave();
    FabricSettings settings;
    FabricRun run(piece, settings, {ball(Vec3(middle, radius + 0.3, middle), radius, strike)});
    Crossings crossings(run.fabric, Vec3::UnitY());
    ASSERT_EQ(crossings.size(), 18u * 18u);
    int undecided = 0, splits = 0, globalScalings = 0, truncated = 0;
    double spare = 1.0, nearest = 1.0, fastest = 0.0, deepest = -1.0;
    for (int i = 0; i < 40; ++i) {
        const FabricReport report = run.step(1.0e-3);
        const Crossings::Count count = crossings.count(run.state.x);
        const Crossings::Nearness near = crossings.nearness(run.state.x);
        EXPECT_EQ(count.flipped, 0) << "step " << i;
        EXPECT_GE(near.spare, 0.0) << "step " << i;
        undecided = std::max(undecided, count.undecided);
        splits += report.substepSplits, globalScalings += report.globalScalings, truncated += report.truncatedSubsteps;
        spare = std::min(spare, near.spare), nearest = std::min(nearest, near.relative), fastest = std::max(fastest, run.fastest());
        deepest = std::max(deepest, run.solver.deepestInObstacles(run.state));
    }
    EXPECT_GT(fastest, 250.0);  // it was struck
    RecordProperty("weave", "undecided " + std::to_string(undecided) + " splits " + std::to_string(splits) + " scalings " +
                                std::to_string(globalScalings) + " truncated " + std::to_string(truncated) + " spare " + std::to_string(spare) +
                                " nearest " + std::to_string(nearest) + " deepest " + std::to_string(deepest));
}

/// Two sheets of cloth thrown at each other over a ball.
TEST(Cloth, NoFaceIsPierced)
{
    ClothGrid grid;
    grid.nodes = Vec2i(16, 16);
    grid.spacing = {0.15, 0.15};
    FabricMaterial material = testing::wool();
    FabricPiece lower = pieceOf(clothGrid(grid), material, {0.015, 0.015});
    grid.origin = Vec3(0.3, 0.1, 0.2);
    FabricPiece upper = pieceOf(clothGrid(grid), material, {0.015, 0.015});
    upper.velocity = Vec3(20.0, -300.0, 10.0);
    FabricRun run({lower, upper}, FabricSettings{}, {ball(Vec3(1.1, -0.6, 1.1), 0.5)});
    double deepest = -1.0;
    for (int i = 0; i < 40; ++i) {
        run.step(1.0e-3);
        EXPECT_EQ(piercedFaces(run.fabric, run.state.x), 0) << "step " << i;
        deepest = std::max(deepest, run.solver.deepestInObstacles(run.state));
    }
    RecordProperty("deepest", std::to_string(deepest));
}

}  // namespace
}  // namespace sim::test
