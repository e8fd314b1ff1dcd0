// No straight path of a particle goes through a solid: where it meets one is found, whatever the solid and however it moves.
#include "tests/sim/grid/random_solids.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kResolution = 1.0e-3;  // [cm]
constexpr int kSamples = 500;

/// What samples of a path say about the first contact with the solids where they are at the end of the step.
/// @return whether there was one
bool expectFirst(const Obstacles& obstacles, const Vec3& from, const Vec3& to, const std::optional<Obstacles::Contact>& contact)
{
    const Vec3 way = to - from;
    const double length = way.norm(), until = contact ? (contact->x - from).dot(way) / (length * length) : 1.0;
    for (int n = 0; n <= kSamples; ++n) {
        const double share = until * n / kSamples;
        // Where only a corner of the solid is cut off, over less than the resolution, it may be missed.
        EXPECT_GT(obstacles.distance(from + share * way), -kResolution) << "at " << share << (contact ? " before the contact" : ": it was missed");
    }
    if (!contact) return false;
    EXPECT_NEAR((contact->x - from - until * way).norm(), 0.0, 1.0e-9) << "the contact is on the path";
    EXPECT_GE(until, -1.0e-12);
    EXPECT_LE(until, 1.0 + 1.0e-12);
    EXPECT_GE(obstacles.distance(contact->x), -1.0e-9);
    EXPECT_LE(obstacles.distance(contact->x), 2.0 * kResolution);
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1.0e-9);
    // A corner may be met by a path that goes past it within the resolution; else the path goes into the solid.
    EXPECT_LT(obstacles.distance(contact->x + kResolution / length * way), kResolution);
    return true;
}

TEST(FirstContact, IsWhereSamplesOfThePathFirstMeetTheSolid)
{
    for (const Kind& kind : kSolidKinds) {
        SCOPED_TRACE(kind.name);
        Chance chance(1);
        int met = 0, free = 0;
        for (int n = 0; n < (kind.isMesh ? 4 : 20) && !testing::Test::HasFailure(); ++n) {
            Obstacles obstacles;
            obstacles.add(kind.make(chance).moved(chance.turn(0.5)), {});
            obstacles.moveTo(0.0, 0.0);
            for (int path = 0; path < 100; ++path) {
                const Vec3 from = chance.inCube(2.0), to = n % 2 == 0 ? chance.inCube(2.0) : Vec3(from + 0.5 * chance.direction());
                if (obstacles.distance(from) <= 0.0) continue;
                (expectFirst(obstacles, from, to, obstacles.firstContact(from, to, kResolution)) ? met : free)++;
            }
        }
        EXPECT_GT(met, 20);
        EXPECT_GT(free, 20);
    }
}

/// From far away, along its faces and past its corners, onto a mesh: its distance outside of the lattice is more than that to the mesh.
TEST(FirstContact, OfMeshesIsFoundFromFarAway)
{
    Chance chance(2);
    for (int n = 0; n < 6; ++n) {
        Obstacles obstacles;
        obstacles.add(meshOfBox({chance.between(0.05, 0.15), 0.5, 0.4}, 0.05).moved(chance.turn(0.1)), {});
        obstacles.moveTo(0.0, 0.0);
        int met = 0;
        for (int path = 0; path < 400; ++path) {
            const Vec3 from = chance.between(1.0, 8.0) * chance.direction(), through = chance.inCube(0.4),
                       to = from + chance.between(1.0, 2.0) * (through - from);
            if (obstacles.distance(from) <= 0.0) continue;
            met += expectFirst(obstacles, from, to, obstacles.firstContact(from, to, kResolution));
        }
        EXPECT_GT(met, 50);
    }
}

/// Of several solids the first one counts.
TEST(FirstContact, IsThatOfTheNearestOfManySolids)
{
    Chance chance(3);
    int met = 0;
    for (int n = 0; n < 30; ++n) {
        Obstacles obstacles;
        for (int solid = 0; solid < 5; ++solid) {
            const Kind& kind = kSolidKinds[chance.random() % 9];
            obstacles.add(kind.make(chance).moved(chance.turn(3.0)), {});
        }
        obstacles.moveTo(0.0, 0.0);
        for (int path = 0; path < 100; ++path) {
            const Vec3 from = chance.inCube(4.0), to = chance.inCube(4.0);
            if (obstacles.distance(from) > 0.0) met += expectFirst(obstacles, from, to, obstacles.firstContact(from, to, kResolution));
        }
    }
    EXPECT_GT(met, 300);
}

/// As seen from a solid that moves, a particle at rest goes the other way; and no contact depends on where all of it is, or how it is turned.
TEST(FirstContact, IsTheSameForAMovingSolidAndInAnyFrame)
{
    for (const Kind& kind : kSolidKinds) {
        if (kind.isMesh) continue;
        SCOPED_TRACE(kind.name);
        Chance chance(4);
        int met = 0;
        for (int n = 0; n < 20; ++n) {
            const Shape shape = kind.make(chance);
            const Motion motion = randomMotion(chance, 1.5, 1.0);
            const Eigen::Isometry3d before = motion.transform(0.2), now = motion.transform(0.7), frame = chance.turn(3.0);
            Obstacles moving, resting, turned;
            moving.add(shape, motion);
            resting.add(shape, {});
            turned.add(shape.moved(frame), {});
            moving.moveTo(0.2, 0.7);
            resting.moveTo(0.2, 0.7);
            turned.moveTo(0.2, 0.7);
            for (int path = 0; path < 50; ++path) {
                // One half of the particles rest while the solid comes.
                const Vec3 from = chance.inCube(2.0), to = path % 2 == 0 ? from : chance.inCube(2.0), a = before.inverse() * from,
                           b = now.inverse() * to;
                const auto contact = moving.firstContact(from, to, kResolution), still = resting.firstContact(a, b, kResolution);
                const auto inFrame = turned.firstContact(frame * a, frame * b, kResolution),
                           atEnd = moving.firstContactAtEnd(now * a, to, kResolution);
                ASSERT_EQ(contact.has_value(), still.has_value());
                ASSERT_EQ(inFrame.has_value(), still.has_value());
                ASSERT_EQ(atEnd.has_value(), still.has_value());
                if (!contact) continue;
                ++met;
                ASSERT_NEAR((contact->x - now * still->x).norm(), 0.0, 2.0 * kResolution);
                ASSERT_NEAR((inFrame->x - frame * still->x).norm(), 0.0, 2.0 * kResolution);
                ASSERT_NEAR((atEnd->x - contact->x).norm(), 0.0, 2.0 * kResolution);
                ASSERT_LE(moving.distance(contact->x), 2.0 * kResolution);
                ASSERT_GE(moving.distance(contact->x), -1.0e-9);
            }
        }
        EXPECT_GT(met, 20);
    }
}

/// Walls that are thicker than the resolution stop whatever goes through them, however fast and at whatever angle.
TEST(FirstContact, NoPathCrossesAPlate)
{
    Chance chance(5);
    int crossing = 0;
    for (int n = 0; n < 4000; ++n) {
        const double half = kResolution * chance.between(0.6, 3.0);
        const Eigen::Isometry3d turn = chance.turn(2.0);
        Obstacles obstacles;
        obstacles.add(Shape::box(Vec3::Zero(), {half, 100.0, 100.0}).moved(turn), {});
        obstacles.moveTo(0.0, 0.0);
        // From right at the surface to far away, to the other side.
        const double far = std::pow(10.0, chance.between(-6.0, 1.0));
        const Vec3 a(half + far, chance.between(-5.0, 5.0), 0.0), b(-half - chance.between(0.0, 2.0), chance.between(-5.0, 5.0), 1.0);
        const auto contact = obstacles.firstContact(turn * a, turn * b, kResolution);
        ASSERT_TRUE(contact.has_value()) << "half " << half << " from " << far;
        ASSERT_GT((turn.inverse() * contact->x).x(), 0.0) << "on the side from which it came";
        ASSERT_NEAR((contact->normal - turn.linear() * Vec3::UnitX()).norm(), 0.0, 1.0e-9);
        ++crossing;
    }
    EXPECT_EQ(crossing, 4000);
}

}  // namespace
}  // namespace sim::test
