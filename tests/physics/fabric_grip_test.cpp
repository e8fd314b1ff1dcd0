#include "tests/physics/fabric_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <optional>

// Friction of what touches at few points: of yarns that lie across yarns, and of coarse fabric that touches with none of its vertices.

namespace sim::test {
namespace {

using testing::pieceOf;

constexpr double kFriction = 0.577350;  ///< of 30 degrees [-]
constexpr double kRadius = 0.03;        ///< of the fabric [cm]

/// Gravity on a slope down z, whose tangent relative to that of the friction angle is given [cm/s²].
Vec3 gravityOn(double steepness)
{
    const double angle = std::atan(steepness * kFriction);
    return kEarthGravity * Vec3(0.0, -std::cos(angle), std::sin(angle));
}

/// Mean over vertices from `first` on of their z, or their speed down the slope.
double meanDown(const std::vector<Vec3>& of, std::size_t first = 0)
{
    double sum = 0.0;
    for (std::size_t v = first; v < of.size(); ++v) sum += of[v].z();
    return sum / static_cast<double>(of.size() - first);
}

/// A yarn along x on two held ones down the slope.
struct YarnOnYarns {
    YarnOnYarns(double steepness, double step) : h(step)
    {
        std::vector<FabricPiece> pieces;
        for (double x : {-0.6, 0.6}) {
            pieces.push_back(pieceOf(strand(Vec3(x, 0.0, -2.0), Vec3(x, 0.0, 8.0), 40), testing::wool(), {kRadius, kRadius}));
            std::vector<int> all(pieces.back().points.size());
            std::iota(all.begin(), all.end(), 0);
            pieces.back().pins.push_back(pinned(all));
            first += all.size();
        }
        const Vec3 begin(-1.0, 2.5 * kRadius, 0.07), end(1.0, 2.5 * kRadius, 0.07);
        pieces.push_back(pieceOf(strand(begin, end, 9), testing::wool(), {kRadius, kRadius}));
        for (FabricPiece& piece : pieces) piece.material.frictionAngle = std::atan(kFriction);
        run.emplace(pieces, FabricSettings{});
        run->gravity = gravityOn(steepness);
    }
    void until(double t) { run->steps(static_cast<int>(std::lround((t - time) / h)), h), time = t; }
    double place() const { return meanDown(run->state.x, first); }
    double speed() const { return meanDown(run->state.v, first); }

    double h, time = 0.0;
    std::size_t first = 0;
    std::optional<FabricRun> run;
};

TEST(YarnOnYarns, HoldsBelowTheFrictionAngle)
{
    for (double h : {5.0e-4, 2.0e-3})
        for (double steepness : {0.3, 0.8}) {
            YarnOnYarns yarn(steepness, h);
            yarn.until(0.4);
            const double before = yarn.place();
            yarn.until(0.6);
            EXPECT_LT(std::abs(yarn.place() - before) / 0.2, 2.0e-3) << h << " steepness " << steepness;
        }
}

TEST(YarnOnYarns, SlidesAboveTheFrictionAngle)
{
    for (double h : {5.0e-4, 1.0e-3, 2.0e-3}) {
        YarnOnYarns yarn(1.6, h);
        yarn.until(0.05);
        const double before = yarn.speed(), angle = std::atan(1.6 * kFriction);
        yarn.until(0.15);
        const double coulomb = kEarthGravity * (std::sin(angle) - kFriction * std::cos(angle));
        // In long steps the normal force, which two Newton iterations leave in a cycle of two steps, holds it back by 16 %.
        EXPECT_NEAR((yarn.speed() - before) / 0.1 / coulomb, 1.0, h > 1.0e-3 ? 0.2 : 0.1) << h;
    }
}

/// Coarse fabric over two blades that point down the slope, which it touches neither with vertices nor with the middles of edges.
struct OnBlades {
    OnBlades(bool isYarn, double steepness)
    {
        ClothGrid grid;
        grid.nodes = Vec2i(6, 6);
        grid.spacing = {0.4, 0.4};
        grid.origin = Vec3(-1.0, kRadius, -1.0);
        const FabricGeometry yarn = strand(Vec3(-1.0, kRadius, 0.1), Vec3(1.0, kRadius, -0.1), 5);
        FabricPiece piece = pieceOf(isYarn ? yarn : clothGrid(grid), testing::wool(), {kRadius, kRadius});
        piece.material.frictionAngle = std::atan(kFriction);
        std::vector<ObstacleSettings> blades;
        for (double x : {-0.69, 0.71}) {
            ObstacleSettings& blade = blades.emplace_back();
            blade.name = "blade";
            blade.shape = Shape::box(Vec3(x, -2.0, 0.0), Vec3(0.01, 2.0, 20.0));
        }
        run.emplace(piece, FabricSettings{}, blades);
        run->gravity = gravityOn(steepness);
    }
    double creep()
    {
        run->steps(300, 2.0e-3);
        const double before = meanDown(run->state.x);
        run->steps(100, 2.0e-3);
        return std::abs(meanDown(run->state.x) - before) / 0.2;
    }
    std::optional<FabricRun> run;
};

TEST(OnBlades, HoldsBelowTheFrictionAngleWithNoneOfItsVertices)
{
    for (bool isYarn : {false, true})
        for (double steepness : {0.3, 0.8}) EXPECT_LT(OnBlades(isYarn, steepness).creep(), 2.0e-3) << isYarn << " steepness " << steepness;
}

/// Two yarns that cross, pressed against each other and pushed sideways by the pins at their ends, which then turn with all of it.
struct TurningCross {
    TurningCross(const Vec3& axis, double angle)
    {
        constexpr double kPressed = 1.6 * kRadius, kTo = 0.5, kFrom = 0.1;
        std::vector<FabricPiece> pieces;
        for (int n = 0; n < 2; ++n) {
            const Vec3 along = n == 0 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.5, 0.0, 0.87), at = n == 0 ? Vec3(0.0, 0.0, 0.0) : Vec3(0.0, 2.4 * kRadius, 0.0);
            pieces.push_back(pieceOf(strand(at - along, at + along, 21), testing::wool(), {kRadius, kRadius}));
            pieces.back().material.frictionAngle = std::atan(kFriction);
            Motion motion;
            if (n == 1) motion.addTranslation(0.0, kFrom, Vec3(0.3 * kRadius, kPressed - 2.4 * kRadius, 0.3 * kRadius), 0.0, 0.0);
            motion.addRotation(kFrom, kTo, {.direction = axis, .through = Vec3::Zero()}, angle, 0.1, 0.0);
            pieces.back().pins = {pinned({0, 21}, false, motion)};
        }
        run.emplace(pieces, FabricSettings{});
        run->gravity.setZero();
        run->solver.bookEnergy();
        run->steps(200, 1.0e-3);  // at full speed
    }
    std::optional<FabricRun> run;
};

/// What turns as a whole neither slides nor gains: friction that is held across the gap of a pair would else drive it, or brake it, all around.
TEST(FabricGrip, TurnsOfAPairGiveNothing)
{
    testing::Noise random(12);
    for (int n = 0; n < 6; ++n) {
        const Vec3 axis = n == 0 ? Vec3::UnitX().eval() : n == 1 ? Vec3::UnitZ().eval() : random.vector().normalized();
        TurningCross cross(axis, n % 2 == 0 ? 6.0 : -6.0);
        double held = 0.0, work = 0.0, turned = 0.0;
        for (int i = 0; i < 300; ++i) {
            const EnergyChanges changes = *cross.run->step(1.0e-3).energyChanges;
            for (const Vec3& force : cross.run->state.vertexSolver.onFabric.force) held = std::max(held, force.norm());
            work += changes[EnergyChange::Friction];
            turned += 6.0 * 1.0e-3 / 0.35;
        }
        ASSERT_GT(held, 0.0);
        // By as much as a pair's moment would: force times gap times angle.
        EXPECT_LT(std::abs(work), 0.02 * held * 2.0 * kRadius * turned) << n;
    }
}

}  // namespace
}  // namespace sim::test
