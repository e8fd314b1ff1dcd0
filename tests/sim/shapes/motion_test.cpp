#include "sim/shapes/motion.h"

#include "sim/core/check.h"
#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

const Vec3 kPoint(0.4, -0.7, 1.3);

Vec3 place(const Motion& m, double t, const Vec3& x = kPoint) { return m.transform(t) * x; }

/// The velocity is the derivative of the position of one and the same point of the body.
void expectVelocityIsDerivative(const Motion& m, double from, double to)
{
    constexpr double kStep = 1.0e-6;
    for (int n = 0; n < 50; ++n) {
        const double t = from + (to - from) * (n + 0.37) / 50.0;
        const Vec3 slope = (place(m, t + kStep) - place(m, t - kStep)) / (2.0 * kStep);
        EXPECT_LT((m.velocity(t, place(m, t)) - slope).norm(), 1e-5 * (1.0 + slope.norm())) << t;
    }
}

TEST(Motion, TranslatesByExactlyWhatItWasGiven)
{
    for (const auto& [easeIn, easeOut] : {std::pair(0.1, 0.3), std::pair(0.0, 0.0), std::pair(0.5, 0.5), std::pair(0.0, 1.0)}) {
        Motion m;
        m.addTranslation(0.5, 1.5, {1.0, -2.0, 3.0}, easeIn, easeOut);
        EXPECT_LT((m.transform(0.5).translation()).norm(), 1e-14);
        EXPECT_LT((m.transform(1.5).translation() - Vec3(1.0, -2.0, 3.0)).norm(), 1e-14);
        EXPECT_LT((m.transform(1.5 - 1e-9).translation() - Vec3(1.0, -2.0, 3.0)).norm(), 1e-7);
    }
}

TEST(Motion, EasesToAPlateau)
{
    Motion m;
    m.addTranslation(0.0, 1.0, {2.0, 0.0, 0.0}, 0.2, 0.4);
    const double plateau = 2.0 * 2.0 / (1.0 + (1.0 - 0.4) - 0.2);
    EXPECT_NEAR(m.velocity(0.2, kPoint)[0], plateau, 1e-12);
    EXPECT_NEAR(m.velocity(0.5, kPoint)[0], plateau, 1e-12);
    EXPECT_NEAR(m.velocity(0.1, kPoint)[0], 0.5 * plateau, 1e-12);
    EXPECT_NEAR(m.velocity(0.8, kPoint)[0], 0.5 * plateau, 1e-12);
    EXPECT_NEAR(m.velocity(0.0, kPoint)[0], 0.0, 1e-12);
}

TEST(Motion, RestsOutsideOfItsSpan)
{
    Motion m;
    m.addTranslation(1.0, 2.0, {1.0, 0.0, 0.0}, 0.0, 0.0);
    for (double t : {-5.0, 0.0, 0.999, 2.0, 7.0}) EXPECT_TRUE(m.velocity(t, kPoint).isZero(0.0)) << t;
    EXPECT_EQ(place(m, 0.5), kPoint);
    EXPECT_TRUE(m.transform(9.0).translation().isApprox(Vec3(1.0, 0.0, 0.0)));
    EXPECT_TRUE(Motion().isStatic());
    EXPECT_FALSE(m.isStatic());
}

TEST(Motion, AFullTurnComesHome)
{
    Motion m;
    m.addRotation(0.0, 2.0, {Vec3(1.0, 1.0, 0.0).normalized(), {1.0, 2.0, 3.0}}, 2.0 * kPi, 0.5, 0.5);
    EXPECT_LT((place(m, 2.0) - kPoint).norm(), 1e-13);
    EXPECT_LT((place(m, 10.0) - kPoint).norm(), 1e-13);
    EXPECT_GT((place(m, 1.0) - kPoint).norm(), 1.0);
    EXPECT_LT((m.transform(0.7) * Vec3(1.0, 2.0, 3.0) - Vec3(1.0, 2.0, 3.0)).norm(), 1e-13);
}

TEST(Motion, VelocityIsTheDerivativeOfThePosition)
{
    Motion m;
    m.addTranslation(0.0, 1.0, {1.0, 2.0, 0.5}, 0.3, 0.2);
    m.addRotation(0.2, 1.4, {Vec3(1.0, 0.5, -1.0).normalized(), {0.3, 0.0, 1.0}}, 2.5, 0.4, 0.4);
    m.addRotation(0.5, 1.5, {Vec3::UnitY(), {1.0, 0.2, 0.0}, Motion::Frame::Local}, -1.5, 0.1, 0.1);
    m.addSwing(0.1, 1.6, {Vec3::UnitX(), {0.0, 1.0, 0.0}, Motion::Frame::Local}, 0.4, 2.0);
    m.addOscillation(0.0, 2.0, Vec3::UnitZ(), 0.5, 1.5);
    m.addPath({0.0, 0.7, 1.0, 1.9}, {Vec3::Zero(), Vec3::Ones(), {2.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}, true);
    expectVelocityIsDerivative(m, 0.0, 1.9);
}

TEST(Motion, AnAxisStandsInTheWorldOrGoesWithTheBody)
{
    for (const auto frame : {Motion::Frame::World, Motion::Frame::Local}) {
        Motion m;
        // Given in the wrong order: what begins first acts first.
        m.addRotation(1.0, 2.0, {Vec3::UnitZ(), Vec3::Zero(), frame}, kPi, 0.0, 0.0);
        m.addTranslation(0.0, 1.0, {3.0, 0.0, 0.0}, 0.0, 0.0);
        const Vec3 expected = frame == Motion::Frame::World ? Vec3(-4.0, 0.0, 0.0) : Vec3(2.0, 0.0, 0.0);
        EXPECT_LT((m.transform(2.0) * Vec3(1.0, 0.0, 0.0) - expected).norm(), 1e-13);
    }
}

TEST(Motion, SwingsAboutItsMiddle)
{
    Motion m;
    m.addOscillation(1.0, 3.0, Vec3::UnitY(), 0.5, 2.0);
    EXPECT_NEAR(m.transform(1.125).translation()[1], 0.5, 1e-12);
    EXPECT_NEAR(m.transform(1.375).translation()[1], -0.5, 1e-12);
    EXPECT_NEAR(m.transform(3.0).translation()[1], 0.0, 1e-12);
    EXPECT_NEAR(m.velocity(1.5, kPoint)[1], 0.5 * 2.0 * kPi * 2.0, 1e-9);
}

TEST(Motion, APathPassesThroughItsKeysWithoutOvershoot)
{
    const std::vector<double> times = {0.0, 1.0, 1.5, 3.0, 4.0, 5.0};
    const std::vector<Vec3> offsets = {Vec3::Zero(), {1.0, 0.0, 0.0}, {1.0, 2.0, 0.0}, {1.0, 2.0, -1.0}, {0.0, 2.0, -3.0}, {0.5, 0.0, -1.0}};
    for (bool cubic : {true, false}) {
        Motion m;
        m.addPath(times, offsets, cubic);
        for (std::size_t k = 0; k < times.size(); ++k) EXPECT_LT((m.transform(times[k]).translation() - offsets[k]).norm(), 1e-13);
        for (std::size_t k = 0; k + 1 < times.size(); ++k)
            for (double u : {0.1, 0.5, 0.9}) {
                const Vec3 x = m.transform((1.0 - u) * times[k] + u * times[k + 1]).translation();
                const Vec3 low = offsets[k].cwiseMin(offsets[k + 1]), high = offsets[k].cwiseMax(offsets[k + 1]);
                EXPECT_TRUE((x.array() >= low.array() - 1e-12).all() && (x.array() <= high.array() + 1e-12).all());
                if (cubic) continue;
                EXPECT_LT((x - (1.0 - u) * offsets[k] - u * offsets[k + 1]).norm(), 1e-12);
            }
        expectVelocityIsDerivative(m, 0.0, 5.0);
    }
}

TEST(Motion, TellsWhenItMoves)
{
    Motion m;
    m.addTranslation(1.0, 2.0, {1.0, 0.0, 0.0}, 0.2, 0.2);
    m.addRotation(4.0, 5.0, {Vec3::UnitX(), Vec3::Zero()}, 0.0, 0.0, 0.0);
    m.addPath({6.0, 7.0, 8.0}, {Vec3::Zero(), Vec3::Zero(), Vec3::Ones()}, true);
    EXPECT_FALSE(m.moves(0.0, 1.0));
    EXPECT_TRUE(m.moves(0.9, 1.1));
    EXPECT_TRUE(m.moves(1.4, 1.5));
    EXPECT_TRUE(m.moves(0.0, 9.0));
    EXPECT_TRUE(m.moves(1.5, 1.5));
    EXPECT_FALSE(m.moves(2.0, 4.5));
    EXPECT_FALSE(m.moves(4.0, 7.0));
    EXPECT_TRUE(m.moves(6.9, 7.1));
    EXPECT_FALSE(m.moves(8.0, 9.0));
    EXPECT_FALSE(Motion().moves(0.0, 1.0));
}

TEST(Motion, RefusesWhatMakesNoSense)
{
    Motion m;
    EXPECT_THROW(m.addTranslation(1.0, 1.0, Vec3::Ones(), 0.0, 0.0), InputError);
    EXPECT_THROW(m.addTranslation(0.0, 1.0, Vec3::Ones(), 0.6, 0.6), InputError);
    EXPECT_THROW(m.addTranslation(0.0, 1.0, Vec3::Ones(), -0.1, 0.0), InputError);
    EXPECT_THROW(m.addTranslation(0.0, 1.0, Vec3::Constant(std::nan("")), 0.0, 0.0), InputError);
    EXPECT_THROW(m.addRotation(0.0, 1.0, {Vec3::Ones(), Vec3::Zero()}, 1.0, 0.0, 0.0), InputError);
    EXPECT_THROW(m.addOscillation(0.0, 1.0, Vec3::Zero(), 1.0, 1.0), InputError);
    EXPECT_THROW(m.addPath({0.0}, {Vec3::Zero()}, true), InputError);
    EXPECT_THROW(m.addPath({0.0, 0.0}, {Vec3::Zero(), Vec3::Ones()}, true), InputError);
    EXPECT_TRUE(m.isStatic());
}

TEST(Motion, OfAProgramGoesWhereItSays)
{
    Motion m;
    m.addGiven([](double t) { return Eigen::Translation3d(std::sin(t), 0.0, t * t) * Eigen::AngleAxisd(3.0 * t, Vec3(1.0, 2.0, 2.0) / 3.0); });
    const Vec3 expected = Vec3(std::sin(0.7), 0.0, 0.49) + Eigen::AngleAxisd(2.1, Vec3(1.0, 2.0, 2.0) / 3.0) * kPoint;
    EXPECT_LT((place(m, 0.7) - expected).norm(), 1e-14);
    expectVelocityIsDerivative(m, -1.0, 2.0);
    EXPECT_FALSE(m.isStatic());
    EXPECT_TRUE(m.moves(0.0, 1.0e-3));
    // Pieces that begin act on it.
    m.addTranslation(1.0, 2.0, {0.0, 5.0, 0.0}, 0.0, 0.0);
    expectVelocityIsDerivative(m, 1.0, 2.0);
}

}  // namespace
}  // namespace sim
