// Momentum and energy through the transfers (transfer/README.md, Conservation).
#include "sim/liquid/energy.h"
#include "sim/sources/emit.h"
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

using namespace sim;
using namespace sim::test;

namespace {

constexpr double kDt = 0.02;  ///< with modes of order 1 cm/s and cells of 0.288 cm: dt |C| of about 0.1

struct Change {
    double linear, angular;
};

/// What P2G → G2P → advection → P2G does to the momenta on the faces, relative to the sums of their sizes.
Change changeOfMomenta(int modes, XiMap map)
{
    Transfers t(randomLiquid(3000, modes));
    t.toFaces();
    const Vec3 linear = t.faceMomentum(), angular = t.faceAngularMomentum();
    const double linearScale = t.momentumScale(), angularScale = t.angularMomentumScale();
    t.toParticles(modes, kDt);
    t.liquid.sort();
    t.toFaces(map, kDt);
    return {(t.faceMomentum() - linear).norm() / linearScale, (t.faceAngularMomentum() - angular).norm() / angularScale};
}

}  // namespace

TEST(Momentum, TranslationKeepsLinearMomentumForAnyModes)
{
    for (int modes : {1, 4, 6, 8, 10, 11, 15, 27}) EXPECT_LT(changeOfMomenta(modes, XiMap::Translation).linear, 1e-13) << modes << " modes";
}

TEST(Momentum, TranslationKeepsAngularMomentumWithFourAndEightModes)
{
    for (int modes : {4, 8}) EXPECT_LT(changeOfMomenta(modes, XiMap::Translation).angular, 1e-13) << modes << " modes";
    EXPECT_GT(changeOfMomenta(1, XiMap::Translation).angular, 1e-4) << "PIC is known to lose it";
}

TEST(Momentum, AffineConservativeKeepsBoth)
{
    for (int modes : {4, 8, 10, 11, 15, 27}) {
        EXPECT_LT(changeOfMomenta(modes, XiMap::AffineConservative).linear, 1e-13) << modes << " modes";
        EXPECT_LT(changeOfMomenta(modes, XiMap::AffineConservative).angular, 1e-13) << modes << " modes";
    }
}

TEST(Momentum, AffineKeepsNeitherButLinearMomentumWithFourModes)
{
    EXPECT_LT(changeOfMomenta(4, XiMap::Affine).linear, 1e-13);
    EXPECT_GT(changeOfMomenta(4, XiMap::Affine).angular, 1e-6);
    EXPECT_GT(changeOfMomenta(8, XiMap::Affine).linear, 1e-6);
    EXPECT_GT(changeOfMomenta(27, XiMap::Affine).angular, 1e-6);
}

// Laws 1 and 2 (transfer/README.md, Conservation): what the faces get is what the particles have.
TEST(Momentum, FacesGetWhatTheParticlesHave)
{
    for (int modes : {1, 4, 8, 11, 27}) {
        Transfers t(randomLiquid(3000, modes));
        const LiquidParticles& p = t.liquid.particles;
        const double h = t.grid().dx;
        Vec3 angular = Vec3::Zero();
        for (std::size_t s = 0; s < p.count; ++s) {
            const int row = t.liquid.order.source[s];
            angular += p.mass[s] * p.position(s).cross(p.velocity(row));
            for (int a = 0; a < kAxes; ++a) {
                Modes c{};
                for (int r = 0; r < p.modeCount; ++r) c[r] = p.mode(a, r)[row];
                c = toOrthogonal(Stencil(t.grid(), a, p.position(s)).basis, c);
                angular += p.mass[s] * 0.25 * h * h * (Vec3(c[1], c[2], c[3]) / h).cross(unitVector(a));
            }
        }
        t.toFaces();
        EXPECT_LT((t.faceMomentum() - t.particleMomentum()).norm(), 1e-13 * t.momentumScale()) << modes << " modes";
        EXPECT_LT((t.faceAngularMomentum() - angular).norm(), 1e-13 * t.angularMomentumScale()) << modes << " modes";
    }
}

// Whatever is done to the set of particles between two steps.
class ParticleSet : public ::testing::TestWithParam<int> {
 protected:
    /// Mass and momentum on the faces after one P2G of these particles.
    struct Totals {
        double mass;
        Vec3 momentum;
        double scale;
    };
    static Totals totals(Transfers& t)
    {
        t.liquid.sort();
        t.toFaces();
        Totals sum{0.0, t.faceMomentum(), t.momentumScale()};
        const LiquidParticles& p = t.liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s) sum.mass += p.mass[s];
        t.liquid.moveModesHome();
        return sum;
    }
    static void expectSame(const Totals& a, const Totals& b)
    {
        EXPECT_NEAR(a.mass, b.mass, 1e-13 * b.mass);
        EXPECT_LT((a.momentum - b.momentum).norm(), 1e-13 * b.scale);
    }
    static Transfers start()
    {
        Transfers t(randomLiquid(2000, GetParam()));
        t.liquid.moveModesHome();
        return t;
    }
};
INSTANTIATE_TEST_SUITE_P(Modes, ParticleSet, ::testing::Values(1, 4, 8, 11, 27));

TEST_P(ParticleSet, SwappingParticlesChangesNothing)
{
    Transfers t = start();
    const Totals before = totals(t);
    LiquidParticles& p = t.liquid.particles;
    for (std::size_t s = 0; s < p.count; ++s) {
        const std::size_t other = (s * 7919) % p.count;
        p.resize(p.count + 1);
        p.copy(s, p.count - 1);
        p.copy(other, s);
        p.copy(p.count - 1, other);
        p.resize(p.count - 1);
    }
    expectSame(totals(t), before);
}

TEST_P(ParticleSet, DeletedParticlesAreInTheLedger)
{
    Transfers t = start();
    const Totals before = totals(t);
    const Shape domain = Shape::ball(t.grid().origin, 1.5);
    sortParticles(t.liquid.particles, t.liquid.grid, &domain, t.liquid.order, &t.liquid.ledger);
    t.toFaces();
    EXPECT_GT(t.liquid.ledger.leftMass, 0.1 * before.mass);
    EXPECT_GT(t.liquid.particles.count, 50);
    EXPECT_LT((t.faceMomentum() + t.liquid.ledger.leftMomentum - before.momentum).norm(), 1e-13 * before.scale);
}

TEST_P(ParticleSet, EmittedParticlesBringTheirMomentum)
{
    Transfers t = start();
    const Totals before = totals(t);
    Scene scene;
    scene.settings.cell = t.grid().dx;
    Emission emission;
    emission.velocity = {0.3, -2.0, 0.7};
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball({6.0, 0.5, 1.0}, 0.8);
    drop.emissions = {emission};
    scene.sources.push_back(drop);
    State state;
    state.liquid = t.liquid.particles;
    state.grid = t.liquid.grid;
    emitLiquid(scene, state, 0.0, 0.0);
    t.liquid.particles = state.liquid;
    const Totals after = totals(t);
    EXPECT_GT(state.ledger.emittedMass, 0.5);
    EXPECT_LT((after.momentum - before.momentum - state.ledger.emittedMass * emission.velocity).norm(), 1e-13 * after.scale);
}

// Law 4 (transfer/README.md, Conservation).
TEST(Energy, NeverGrowsInATransfer)
{
    for (int modes : {1, 4, 8, 11, 15, 27}) {
        SCOPED_TRACE(modes);
        Transfers t(randomLiquid(3000, modes));
        t.toFaces();
        fillRandomVelocities(t.grid(), t.faces);
        const double onFaces = t.faceEnergy();
        t.toParticles(modes);
        t.liquid.sort();
        const double onParticles = liquidEnergies(t.liquid.particles, t.grid(), Vec3::Zero()).total();
        t.toFaces();
        const double onFacesAgain = t.faceEnergy();
        EXPECT_LE(onParticles, onFaces * (1.0 + 1e-13));
        EXPECT_LE(onFacesAgain, onParticles * (1.0 + 1e-13));
        if (modes == 27) EXPECT_NEAR(onFacesAgain, onFaces, 1e-12 * onFaces);
        else EXPECT_LT(onFacesAgain, 0.95 * onFaces);
    }
}

// What G2P counts on the way is what liquidEnergies() finds afterwards, at the new positions.
TEST(Energy, GatherCountsWhatTheParticlesThenHave)
{
    for (int modes : {1, 4, 6, 8, 10, 11, 15, 27})
        for (double keep : {1.0, 0.6}) {
            SCOPED_TRACE(modes);
            Transfers t(randomLiquid(3000, modes));
            fillRandomVelocities(t.grid(), t.faces);
            std::array<AlignedArray<double>, kAxes> displacement;
            for (int a = 0; a < kAxes; ++a) {
                displacement[a].resize(t.liquid.particles.mass.size());
                for (std::size_t s = 0; s < displacement[a].size(); ++s) displacement[a][s] = 0.1 * std::sin(static_cast<double>(3 * s + a));
            }
            GatherSettings settings;
            settings.modes = modes;
            settings.dt = 0.1;
            settings.keep = keep;
            settings.displacement = displacement.data();
            const GatherSums sums = t.toParticles(settings);
            const LiquidEnergies energies = liquidEnergies(t.liquid.particles, t.grid(), Vec3::Zero());
            EXPECT_NEAR(sums.kinetic, energies.kinetic, 1e-12 * energies.kinetic);
            EXPECT_NEAR(sums.modal, energies.modal, 1e-12 * energies.modal);
            EXPECT_EQ(energies.modal > 0.0, modes > 1);
            const double strain = strainEnergy(t.liquid.particles, t.grid());
            EXPECT_NEAR(sums.strain, strain, 1e-12 * strain);
            EXPECT_LE(strain, energies.modal);
            EXPECT_EQ(strain > 0.0, modes > 1);
        }
}

// Of all modes, what weight does along each axis is what it does to the particles' velocities.
TEST(Energy, WeightWorksOnTheVelocityOfTheParticles)
{
    constexpr double kDuration = 0.01;
    for (int modes : {1, 8, 11, 27})
        for (const Vec3& gravity : {Vec3(0.0, -981.0, 0.0), Vec3(300.0, -800.0, 500.0)}) {
            SCOPED_TRACE(modes);
            const Transfers t(randomLiquid(3000, modes));
            const LiquidParticles& p = t.liquid.particles;
            double work = 0.0, size = 0.0;
            for (std::size_t i = 0; i < p.count; ++i) {
                const double power = p.mass[i] * gravity.dot(p.velocity(i));
                work += kDuration * power;
                size += kDuration * std::abs(power);
            }
            EXPECT_NEAR(weightWork(p, gravity, kDuration), work, 1e-12 * size);
        }
}
