// Particles stay on their side of every solid, however thin, turned and fast it is, and what that costs them is booked.
#include "sim/liquid/push_out.h"

#include "tests/sim/fixtures.h"
#include "tests/sim/grid/random_solids.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kCell = 0.25;      // [cm]
const Vec3 kVessel(2.6, 2.7, 2.8);  // half its sizes [cm]

double kinetic(const LiquidParticles& particles)
{
    double sum = 0.0;
    for (std::size_t p = 0; p < particles.count; ++p) sum += 0.5 * particles.mass[p] * particles.velocity(p).squaredNorm();
    return sum;
}

/// Random particles that went by up to `farthest` [cm] in any direction, or up to `speed` [cm/s], while the solids moved.
struct Gone {
    SortedLiquid liquid = randomLiquid(3000, 1, {24, 24, 24}, {-12, -12, -12}, kCell);
    std::vector<Vec3> from, after;
    PushOutTotals pushed;
    double lost = 0.0;  ///< kinetic energy [erg]

    Gone(const Obstacles& obstacles, double farthest, Chance& chance)
    {
        LiquidParticles& particles = liquid.particles;
        ObstacleField field;
        field.update(liquid.grid, std::vector<int>(liquid.grid.count(), BlockGrid::kNone), obstacles, false);
        const auto before = particles.x;
        for (std::size_t p = 0; p < particles.count; ++p) {
            from.push_back(particles.position(p));
            const Vec3 way = chance.between(0.0, farthest) * chance.direction(), velocity = chance.inCube(10.0);
            for (int a = 0; a < kAxes; ++a) {
                particles.x[a][p] += way[a];
                particles.mode(a, 0)[p] = velocity[a];
            }
        }
        lost = kinetic(particles);
        ChunkSums<Impulse> onSolids;
        pushed = pushOutOfObstacles(liquid.order, {liquid.grid, field, obstacles}, farthest, &before, particles, onSolids);
        lost -= kinetic(particles);
        for (std::size_t p = 0; p < from.size(); ++p) after.push_back(particles.position(p));
    }
};

/// A vessel and a plate through all of it, from −half to half along its own x.
struct Divided {
    Obstacles obstacles, atStart;
    Eigen::Isometry3d before, now;
    double half;

    Divided(Chance& chance, double far, double angle) : half(0.5 * kCell * std::pow(10.0, chance.between(-1.7, 0.0)))
    {
        const Eigen::Isometry3d place = chance.turn(0.8);
        const Motion motion = far > 0.0 ? randomMotion(chance, far, angle) : Motion();
        const Shape plate = Shape::box(Vec3::Zero(), {half, 50.0, 50.0}).moved(place);
        for (Obstacles* all : {&obstacles, &atStart}) {
            all->add(Shape::box(Vec3::Zero(), kVessel).inverted(), {});
            all->add(plate, motion);
        }
        obstacles.moveTo(0.0, 1.0);
        atStart.moveTo(0.0, 0.0);
        before = motion.transform(0.0) * place;
        now = motion.transform(1.0) * place;
    }

    /// How far a side of the plate reaches into the vessel at the end of the step: where nothing is left of it, nothing can be there [cm].
    double left(double side) const
    {
        double most = -half;
        for (int n = 0; n < 8; ++n) {
            const Vec3 corner = kVessel.cwiseProduct(Vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1));
            most = std::max(most, std::copysign(1.0, side) * (now.inverse() * corner).x() - half);
        }
        return most;
    }
    /// How many that began outside of all solids were moved; none of them is inside or on the other side.
    int expectKept(const Gone& gone) const
    {
        int met = 0;
        for (std::size_t p = 0; p < gone.from.size(); ++p) {
            if (atStart.distance(gone.from[p]) <= 1.0e-9) continue;
            const double side = (before.inverse() * gone.from[p]).x(), end = (now.inverse() * gone.after[p]).x();
            EXPECT_GT(side * end, 0.0) << "went through the plate, of " << 2.0 * half / kCell << " cells, from " << side / kCell << " to "
                                       << end / kCell;
            if (left(side) < 0.1 * kCell) continue;
            EXPECT_GT(obstacles.distance(gone.after[p]), -1.0e-9) << left(side) / kCell << " cells are left";
            met += std::abs(end) < half + 2.0 * kPushedInFront * kCell;
        }
        return met;
    }
};

TEST(Crossing, NoParticleGoesThroughAPlateAtRest)
{
    Chance chance(1);
    for (int n = 0; n < 16; ++n) {
        const Divided divided(chance, 0.0, 0.0);
        const double farthest = kCell * std::pow(10.0, chance.between(-1.0, 0.7));
        SCOPED_TRACE(farthest / kCell);
        const Gone gone(divided.obstacles, farthest, chance);
        const int met = divided.expectKept(gone);
        EXPECT_GT(met, farthest > kCell ? 10 : -1);
        EXPECT_NEAR(gone.pushed.lost, gone.lost, 1.0e-9 * std::abs(gone.lost));
        EXPECT_GE(gone.pushed.lost, 0.0);
        EXPECT_EQ(gone.pushed.work, 0.0);
        EXPECT_TRUE(gone.pushed.carried.isZero());
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Crossing, NoParticleGoesThroughAPlateThatMoves)
{
    Chance chance(2);
    for (int n = 0; n < 30; ++n) {
        const double far = kCell * std::pow(10.0, chance.between(-1.5, 0.5)), farthest = kCell * std::pow(10.0, chance.between(-1.0, 0.5));
        const Divided divided(chance, far, n % 2 == 0 ? 0.0 : 0.1);
        SCOPED_TRACE(farthest / kCell);
        SCOPED_TRACE(far / kCell);
        const Gone gone(divided.obstacles, farthest, chance);
        divided.expectKept(gone);
        EXPECT_NEAR(gone.pushed.lost, gone.lost, 1.0e-9 * std::abs(gone.lost));
        EXPECT_GE(gone.pushed.work + gone.pushed.lost, 0.0) << "contacts are inelastic";
    }
}

/// Solids of any kind in a vessel: nothing that was outside gets in.
TEST(Crossing, NoParticleGetsIntoASolid)
{
    for (const Kind& kind : kSolidKinds) {
        SCOPED_TRACE(kind.name);
        Chance chance(3);
        for (int n = 0; n < 3 && !testing::Test::HasFailure(); ++n) {
            const Shape shape = kind.make(chance).moved(chance.turn(1.0));
            const Motion motion = n % 2 == 0 ? Motion() : randomMotion(chance, 0.5, 0.2);
            Obstacles obstacles;
            obstacles.add(Shape::box(Vec3::Zero(), kVessel).inverted(), {});
            obstacles.add(shape, motion);
            Obstacles atStart = obstacles;
            atStart.moveTo(0.0, 0.0);
            obstacles.moveTo(0.0, 1.0);
            const Gone gone(obstacles, kCell * chance.between(0.1, 2.0), chance);
            for (std::size_t p = 0; p < gone.from.size(); ++p)
                EXPECT_TRUE(atStart.distance(gone.from[p]) <= 1.0e-9 || obstacles.distance(gone.after[p]) > -1.0e-6) << gone.from[p].transpose();
            EXPECT_NEAR(gone.pushed.lost, gone.lost, 1.0e-9 * std::abs(gone.lost));
            EXPECT_GE(gone.pushed.work + gone.pushed.lost, 0.0);
        }
    }
}

/// Where a path meets two solids at once, as good as: what goes by one of them from there is in front of the other, too.
TEST(Crossing, NoParticleGetsIntoTheSecondOfTwoSolidsThatItMeets)
{
    Chance chance(11);
    constexpr double kResolution = 5.0e-3;  // [cells]
    for (int n = 0; n < 60000; ++n) {
        const Motion motion = n % 2 == 0 ? Motion() : randomMotion(chance, 10.0, 0.0);
        Obstacles obstacles;
        obstacles.add(Shape::box({0.0, -1.0, 0.0}, {9.0, 1.0, 9.0}), {});
        const Eigen::Isometry3d turned(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), chance.direction()));
        obstacles.add(Shape::box({-1.0, 0.0, 0.0}, {1.0, 9.0, 9.0}).moved(turned), motion);
        Obstacles atStart = obstacles;
        atStart.moveTo(0.0, 0.0);
        obstacles.moveTo(0.0, 0.05);
        // In front of both, as near to each as the resolution, and towards both.
        const Vec3 from = chance.inCube(0.02), to = chance.inCube(0.1);
        if (atStart.distance(from) <= 0.0 || from.norm() > 0.02) continue;
        const auto contact = obstacles.firstContact(Obstacles::Path(from), to, kResolution * kCell);
        if (!contact) continue;
        Obstacles then = obstacles;
        then.moveTo(0.0, 0.05 * contact->share);
        EXPECT_GT(then.distance(from + contact->share * (to - from)), -1.0e-3 * kResolution * kCell) << n;
    }
}

}  // namespace
}  // namespace sim::test
