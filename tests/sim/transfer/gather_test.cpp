// What G2P does beside gathering: FLIP, paths, reflection, damping, fewer modes at the surface, displacements (transfer/README.md, Grid to
// particles).
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

using namespace sim;
using namespace sim::test;

namespace {

std::vector<Vec3> velocities(const Transfers& t)
{
    std::vector<Vec3> v(t.liquid.particles.count);
    for (std::size_t s = 0; s < v.size(); ++s) v[s] = t.liquid.particles.velocity(t.liquid.order.source[s]);
    return v;
}

GatherSettings flip(const Transfers& t, double ratio)
{
    GatherSettings settings;
    settings.modes = 1;
    settings.dt = 0.02;
    settings.flipRatio = ratio;
    settings.flipVelocity = &t.faces.velocity;
    return settings;
}

}  // namespace

TEST(Flip, KeepsVelocitiesWithoutForces)
{
    Transfers t(randomLiquid(3000, 1));
    const std::vector<Vec3> before = velocities(t);
    t.toFaces();
    const GatherSums sums = t.toParticles(flip(t, 1.0));
    double kinetic = 0.0;
    for (std::size_t s = 0; s < before.size(); ++s) {
        EXPECT_LT((t.liquid.particles.velocity(s) - before[s]).norm(), 1e-14);
        kinetic += 0.5 * t.liquid.particles.mass[s] * before[s].squaredNorm();
    }
    EXPECT_NEAR(sums.kinetic, kinetic, 1e-12 * kinetic);
}

TEST(Flip, AddsTheChangeOfTheFaces)
{
    Transfers t(randomLiquid(3000, 1));
    const std::vector<Vec3> before = velocities(t);
    t.toFaces();
    const auto old = t.faces.velocity;
    const Vec3 kick(0.5, -1.0, 2.0);
    t.setVelocities([&](int axis, int b, int c) { return old.block(b, axis)[c] + kick[axis]; });
    GatherSettings settings = flip(t, 1.0);
    settings.flipVelocity = &old;
    t.toParticles(settings);
    for (std::size_t s = 0; s < before.size(); ++s) EXPECT_LT((t.liquid.particles.velocity(s) - before[s] - kick).norm(), 1e-14);
}

TEST(Flip, IsPicWithRatioZeroAndMovesAsPicWithAny)
{
    Transfers pic(randomLiquid(3000, 1)), none(randomLiquid(3000, 1)), most(randomLiquid(3000, 1));
    for (Transfers* t : {&pic, &none, &most}) t->toFaces();
    pic.toParticles(1, 0.02);
    none.toParticles(flip(none, 0.0));
    most.toParticles(flip(most, 0.95));
    double largest = 0.0;
    for (std::size_t s = 0; s < pic.liquid.particles.count; ++s) {
        EXPECT_LT((none.liquid.particles.velocity(s) - pic.liquid.particles.velocity(s)).norm(), 1e-14);
        EXPECT_LT((none.liquid.particles.position(s) - pic.liquid.particles.position(s)).norm(), 1e-14);
        EXPECT_LT((most.liquid.particles.position(s) - pic.liquid.particles.position(s)).norm(), 1e-14);
        largest = std::max(largest, (most.liquid.particles.velocity(s) - pic.liquid.particles.velocity(s)).norm());
    }
    EXPECT_GT(largest, 0.1);
}

Vec3 affine(const Vec3& x) { return {0.3 - x.x() + 2.0 * x.y() + 0.5 * x.z(), 1.0 - 2.0 * x.x() - 0.4 * x.z(), -0.7 + 0.3 * x.y() + x.z()}; }

/// x + dt u(x + dt/2 u(x)) in half of the cells, which linear modes know exactly; in the others particles move with what they get.
TEST(Midpoint, IsExactInAffineFieldsWhereItIsAskedFor)
{
    const double dt = 0.05;
    for (const int modes : {1, 4, 8, 11, 27}) {
        SCOPED_TRACE(modes);
        for (const bool reflects : {false, true}) {
            Transfers t(randomLiquid(2000, modes));
            t.setVelocities([&](int axis, int b, int c) { return affine(faceMiddle(t.grid(), axis, b, c))[axis]; });
            FaceFields other;
            fillRandomVelocities(t.grid(), other);
            Transfers given(randomLiquid(2000, modes));
            given.setVelocities([&](int axis, int b, int c) { return (reflects ? other : t.faces).velocity.block(b, axis)[c]; });
            const LiquidParticles before = t.liquid.particles;
            BlockBits<> atMidpoint;
            atMidpoint.resize(t.grid().count());
            for (int b = 0; b < t.grid().count(); ++b) std::fill_n(atMidpoint.block(b), BlockBits<>::kWords, 0x5555555555555555u);
            GatherSettings settings;
            settings.modes = modes;
            settings.dt = dt;
            given.toParticles(settings);
            settings.atMidpoint = &atMidpoint;
            if (reflects) settings.reflected = &other.velocity;
            t.toParticles(settings);
            const LiquidParticles &p = t.liquid.particles, &q = given.liquid.particles;
            for (std::size_t s = 0; s < before.count; ++s) {
                const Vec3 x = before.position(s), end = x + dt * affine(x + 0.5 * dt * affine(x));
                const int column = static_cast<int>(std::floor((x.x() - t.grid().origin.x()) / t.grid().dx));
                EXPECT_LT((p.position(s) - (column % 2 == 0 ? end : q.position(s))).norm(), 1e-13);
                for (int a = 0; a < kAxes; ++a)
                    for (int r = 0; r < modes; ++r) EXPECT_EQ(p.mode(a, r)[s], q.mode(a, r)[s]);
            }
        }
    }
}

/// What moves by the midpoint rule in a frame that goes along goes as it does in one at rest, and as far as that has gone.
TEST(Midpoint, IsThatOfTheFrameInWhichItIsTaken)
{
    const double dt = 0.05;
    Transfers resting(randomLiquid(2000, 8)), carried(randomLiquid(2000, 8));
    const std::vector<Vec3> frames(carried.grid().count(), Vec3(3.0, -7.0, 2.0));
    resting.setVelocities([&](int axis, int b, int c) { return affine(faceMiddle(resting.grid(), axis, b, c))[axis]; });
    carried.setVelocities([&](int axis, int b, int c) { return (affine(faceMiddle(carried.grid(), axis, b, c)) + frames[0])[axis]; });
    BlockBits<> everywhere;
    everywhere.resize(carried.grid().count());
    for (int b = 0; b < carried.grid().count(); ++b) std::fill_n(everywhere.block(b), BlockBits<>::kWords, ~std::uint64_t{0});
    GatherSettings settings;
    settings.dt = dt;
    settings.atMidpoint = &everywhere;
    resting.toParticles(settings);
    settings.frames = frames.data();
    carried.toParticles(settings);
    for (std::size_t p = 0; p < carried.liquid.particles.count; ++p)
        EXPECT_LT((carried.liquid.particles.position(p) - resting.liquid.particles.position(p) - dt * frames[0]).norm(), 1e-13);
}

TEST(Damping, ScalesAllModesButTheMean)
{
    const double keep = 0.37;
    for (int modes : {1, 4, 8, 10, 11, 15, 27}) {
        SCOPED_TRACE(modes);
        Transfers t(randomLiquid(2000, modes)), damped(randomLiquid(2000, modes));
        fillRandomVelocities(t.grid(), t.faces);
        fillRandomVelocities(damped.grid(), damped.faces);
        GatherSettings settings;
        settings.modes = modes;
        settings.dt = 0.05;
        t.toParticles(settings);
        settings.keep = keep;
        damped.toParticles(settings);
        const LiquidParticles &p = t.liquid.particles, &q = damped.liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s) {
            EXPECT_LT((q.velocity(s) - p.velocity(s)).norm(), 1e-13);
            EXPECT_LT((q.position(s) - p.position(s)).norm(), 1e-13);
            for (int a = 0; a < kAxes; ++a)
                for (int r = 1; r < p.modeCount; ++r) EXPECT_NEAR(q.mode(a, r)[s], keep * p.mode(a, r)[s], 1e-13);
        }
    }
}

TEST(Gather, CellsWithoutManyModesGetEight)
{
    for (int modes : {11, 20, 27}) {
        SCOPED_TRACE(modes);
        const auto gather = [&](int gathered, const BlockBits<>* manyModes) {
            Transfers t(randomLiquid(500, modes));
            fillRandomVelocities(t.grid(), t.faces);
            GatherSettings settings;
            settings.modes = gathered;
            settings.dt = 0.01;
            settings.manyModes = manyModes;
            t.toParticles(settings);
            return t.liquid.particles;
        };
        Transfers like(randomLiquid(500, modes));
        BlockBits<> none;
        none.resize(like.grid().count());
        for (int b = 0; b < like.grid().count(); ++b) std::fill_n(none.block(b), BlockBits<>::kWords, 0);
        const LiquidParticles limited = gather(modes, &none), eight = gather(kModesAtSurface, nullptr), many = gather(modes, nullptr);
        double difference = 0.0;
        for (std::size_t s = 0; s < eight.count; ++s)
            for (int a = 0; a < kAxes; ++a)
                for (int r = 0; r < eight.modeCount; ++r) {
                    EXPECT_NEAR(limited.mode(a, r)[s], eight.mode(a, r)[s], 1.0e-13);
                    difference = std::max(difference, std::abs(limited.mode(a, r)[s] - many.mode(a, r)[s]));
                }
        EXPECT_GT(difference, 0.1) << "the limit matters";
    }
}

TEST(Gather, FaceDisplacementsMoveParticlesBesideTheirVelocity)
{
    const auto displaced = [](int axis, const Vec3& x) { return 0.01 * (1.0 + axis + (2.0 - axis) * x.x() - 3.0 * x.y() + (0.5 + axis) * x.z()); };
    for (int modes : {1, 8, 27}) {
        SCOPED_TRACE(modes);
        Transfers still(randomLiquid(500, modes)), moved(randomLiquid(500, modes));
        for (Transfers* t : {&still, &moved}) t->setVelocities([](int axis, int, int) { return 3.0 - axis; });
        BlockArray<double, 3> field;
        field.resize(moved.grid().count());
        for (int b = 0; b < moved.grid().count(); ++b)
            for (int a = 0; a < kAxes; ++a)
                for (int c = 0; c < kBlockCells; ++c) field.block(b, a)[c] = displaced(a, faceMiddle(moved.grid(), a, b, c));
        const LiquidParticles before = moved.liquid.particles;
        GatherSettings settings;
        settings.modes = modes;
        settings.dt = 0.01;
        still.toParticles(settings);
        settings.faceDisplacement = &field;
        moved.toParticles(settings);
        const LiquidParticles &p = still.liquid.particles, &q = moved.liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s)
            for (int a = 0; a < kAxes; ++a) {
                EXPECT_NEAR(q.x[a][s] - p.x[a][s], displaced(a, before.position(s)), 1.0e-13);
                for (int r = 0; r < q.modeCount; ++r) EXPECT_NEAR(q.mode(a, r)[s], p.mode(a, r)[s], 1.0e-12);
            }
    }
}
