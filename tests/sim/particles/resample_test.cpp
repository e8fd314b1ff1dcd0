#include "sim/particles/resample.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

using namespace sim;
using namespace sim::test;

namespace {

constexpr double kDx = 0.288;

ResampleSettings every(double nominalMass)
{
    ResampleSettings settings;
    settings.nominalMass = nominalMass;
    settings.nominalRadius = 0.2041 * kDx;
    settings.dx = kDx;
    settings.mergeInterval = 1;
    return settings;
}

/// A velocity that is quadratic along each axis, and linear with `quadratic` = 0.
double field(int axis, const Vec3& z, double quadratic)
{
    const double linear = 1.0 + 0.3 * z.x() - 0.5 * (1 + axis) * z.y() + 0.2 * z.z();
    return linear + quadratic * (z.x() * z.x() * z.y() - 0.7 * z.z() * z.z() + 0.4 * z.x() * z.z());
}

/// Particles that carry the field exactly, in 4 or 27 modes.
LiquidParticles inField(std::size_t count, double quadratic, double lightest, double heaviest)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    LiquidParticles particles;
    particles.modeCount = quadratic == 0.0 ? 4 : 27;
    for (std::uint32_t p = 0; p < count; ++p) {
        const Vec3 z(4.0 * unit(random), 4.0 * unit(random), 4.0 * unit(random));
        particles.add(kDx * z, lightest + (heaviest - lightest) * unit(random), p, Vec3::Zero());
        for (int a = 0; a < kAxes; ++a) {
            Modes atOrigin{};
            const double linear[] = {1.0, 0.3, -0.5 * (1 + a), 0.2};
            std::copy(linear, linear + 4, atOrigin.begin());
            atOrigin[modeOfDegrees(2, 1, 0)] = quadratic;
            atOrigin[modeOfDegrees(0, 0, 2)] = -0.7 * quadratic;
            atOrigin[modeOfDegrees(1, 0, 1)] = 0.4 * quadratic;
            const Modes here = shifted(z, atOrigin);
            for (int r = 0; r < particles.modeCount; ++r) particles.mode(a, r)[p] = here[r];
        }
    }
    return particles;
}

/// Largest difference of what a particle carries around it from the field; where that is quadratic, but for a constant
/// per particle.
double largestError(const LiquidParticles& particles, double quadratic)
{
    double worst = 0.0;
    for (std::size_t p = 0; p < particles.count; ++p)
        for (int a = 0; a < kAxes; ++a) {
            Modes c{};
            for (int r = 0; r < particles.modeCount; ++r) c[r] = particles.mode(a, r)[p];
            const Vec3 z = particles.position(p) / kDx;
            const double offset = c[0] - field(a, z, quadratic);
            for (const Vec3& d : {Vec3(1.0, 0.5, -0.7), Vec3(-0.3, 0.9, 0.8), Vec3(0.1, -1.0, 0.4)})
                worst = std::max(worst, std::abs(evaluateModes(d, c) - field(a, z + d, quadratic) -
                                                 (quadratic == 0.0 ? 0.0 : offset)));
        }
    return worst;
}

double totalMass(const LiquidParticles& particles)
{
    return std::accumulate(particles.mass.data(), particles.mass.data() + particles.count, 0.0);
}

using Summary = std::map<std::uint32_t, std::array<double, 5>>;

/// Mass, place and one velocity component of each particle, by id.
Summary byId(const LiquidParticles& particles)
{
    Summary all;
    for (std::size_t p = 0; p < particles.count; ++p)
        all[particles.id[p]] = {particles.mass[p], particles.x[0][p], particles.x[1][p], particles.x[2][p],
                                particles.velocity(p).y()};
    return all;
}

}  // namespace

TEST(Resample, NominalParticlesAreLeftAlone)
{
    LiquidParticles particles = inField(200, 0.0, 0.91, 1.09);
    const Summary before = byId(particles);
    EXPECT_FALSE(needsResampling(particles, 1.0));
    std::uint32_t nextId = 200;
    resample(every(1.0), 3, particles, nextId);
    EXPECT_EQ(byId(particles), before);
    particles.mass[150] = 0.89;
    EXPECT_TRUE(needsResampling(particles, 1.0));
    particles.mass[150] = 1.11;
    EXPECT_TRUE(needsResampling(particles, 1.0));
}

TEST(Resample, SplitsIntoAsManyAsTheMassAsksFor)
{
    for (const auto& [mass, children] :
         {std::pair{2.5, 3}, {4.0, 4}, {4.5, 5}, {5.5, 6}, {7.0, 7}, {7.5, 8}, {20.0, 8}}) {
        LiquidParticles particles = inField(1, 0.0, mass, mass);
        const Vec3 parent = particles.position(0);
        std::uint32_t nextId = 10;
        resample(every(1.0), 1, particles, nextId);
        ASSERT_EQ(particles.count, static_cast<std::size_t>(children));
        EXPECT_EQ(nextId, 9 + static_cast<std::uint32_t>(children));
        EXPECT_EQ(byId(particles).size(), particles.count);
        EXPECT_NEAR(totalMass(particles), mass, 1e-14 * mass);
        const double radius = every(1.0).nominalRadius * std::cbrt(mass), newRadius = radius / std::cbrt(children);
        for (std::size_t p = 0; p < particles.count; ++p) {
            EXPECT_NEAR((particles.position(p) - parent).norm(), 0.75 * std::max(newRadius, radius - newRadius), 1e-14);
            for (std::size_t q = 0; q < p; ++q)
                EXPECT_GT((particles.position(p) - particles.position(q)).norm(), 0.74 * newRadius);
        }
    }
}

TEST(Resample, SplittingCarriesTheFieldAlong)
{
    std::uint32_t nextId = 1000;
    LiquidParticles linear = inField(100, 0.0, 2.1, 9.0);
    resample(every(1.0), 1, linear, nextId);
    EXPECT_LT(largestError(linear, 0.0), 1e-13);
    // Beyond linear fields all but the mean are exact: that is corrected for momentum.
    LiquidParticles quadratic = inField(100, 0.8, 2.1, 9.0);
    resample(every(1.0), 1, quadratic, nextId);
    EXPECT_LT(largestError(quadratic, 0.8), 1e-12);
}

TEST(Resample, MergingCarriesALinearFieldAlong)
{
    LiquidParticles particles = inField(1000, 0.0, 0.2, 1.9);
    std::uint32_t nextId = 1000;
    const double mass = totalMass(particles);
    resample(every(1.0), 1, particles, nextId);
    EXPECT_LT(particles.count, 950);
    EXPECT_NEAR(totalMass(particles), mass, 1e-13 * mass);
    EXPECT_LT(largestError(particles, 0.0), 1e-13);
}

TEST(Resample, TinyParticlesGoOverToNeighboursInReachOnly)
{
    const double reach = 2.0 * every(1.0).nominalRadius;
    for (double distance : {0.99 * reach, 1.01 * reach}) {
        LiquidParticles particles;
        particles.add(Vec3::Zero(), 0.4, 0, {1.0, 0.0, 0.0});
        particles.add({0.0, distance, 0.0}, 0.8, 1, {0.0, 0.0, 2.0});
        particles.add({0.0, 0.0, -distance}, 0.6, 2, Vec3::Zero());
        particles.add({0.5 * distance, 0.0, 0.0}, 1.5, 3, Vec3::Zero());   // heavy already: takes nothing …
        particles.add({0.5 * distance, 0.0, 10.0}, 1.5, 4, Vec3::Zero());  // … and finds nobody to give to
        std::uint32_t nextId = 5;
        resample(every(1.0), 1, particles, nextId);
        const Summary after = byId(particles);
        EXPECT_EQ(after.count(0), distance > reach ? 1 : 0);
        EXPECT_EQ(after.at(4)[0], 1.5);
        if (distance < reach) {
            EXPECT_NEAR(after.at(1)[0], 1.0, 1e-14);
            EXPECT_NEAR(after.at(1)[2], 0.8 * distance, 1e-14);
            EXPECT_NEAR(after.at(2)[0], 0.8, 1e-14);
        }
    }
}

TEST(Resample, HeavyParticlesGiveWhatTheyHaveTooMuch)
{
    LiquidParticles particles;
    particles.add(Vec3::Zero(), 1.5, 0, {1.0, 0.0, 0.0});
    particles.add({0.0, 0.05, 0.0}, 0.7, 1, Vec3::Zero());   // light: takes
    particles.add({0.05, 0.0, 0.0}, 0.95, 2, Vec3::Zero());  // nominal: does not
    std::uint32_t nextId = 3;
    resample(every(1.0), 1, particles, nextId);
    const Summary after = byId(particles);
    EXPECT_NEAR(after.at(0)[0], 1.0, 1e-14);
    EXPECT_NEAR(after.at(1)[0], 1.2, 1e-14);
    EXPECT_EQ(after.at(2)[0], 0.95);
}

TEST(Resample, OneInSoManyMergesPerStep)
{
    LiquidParticles start = inField(4000, 0.0, 0.3, 0.45);
    ResampleSettings settings = every(1.0);
    settings.mergeInterval = 8;
    std::set<std::uint32_t> gone;
    for (int step = 1; step <= 2; ++step) {
        LiquidParticles particles = start;
        std::uint32_t nextId = 4000;
        resample(settings, step, particles, nextId);
        EXPECT_NEAR(static_cast<double>(4000 - particles.count), 500.0, 75.0);
        const Summary left = byId(particles);
        for (std::uint32_t id = 0; id < 4000; ++id)
            if (left.count(id) == 0) gone.insert(id);
    }
    EXPECT_GT(gone.size(), 800) << "the same particles in every step";
}

TEST(Resample, DoesNotDependOnTheOrderOfTheArraysOrOnThreads)
{
    const auto result = [](bool reversed, int threads) {
        return onThreads(threads, [&] {
            LiquidParticles particles = inField(2000, 0.8, 0.1, 4.0);
            if (reversed) {
                const LiquidParticles old = particles;
                for (std::size_t p = 0; p < old.count; ++p) {
                    const std::size_t q = old.count - 1 - p;
                    particles.mass[p] = old.mass[q];
                    particles.id[p] = old.id[q];
                    for (int a = 0; a < kAxes; ++a) {
                        particles.x[a][p] = old.x[a][q];
                        for (int r = 0; r < old.modeCount; ++r) particles.mode(a, r)[p] = old.mode(a, r)[q];
                    }
                }
            }
            std::uint32_t nextId = 2000;
            for (int step = 0; step < 3; ++step) resample(every(1.0), step, particles, nextId);
            return byId(particles);
        });
    };
    const Summary one = result(false, 1);
    EXPECT_EQ(result(true, 1), one);
    EXPECT_EQ(result(false, 8), one);
}
