// What G2P does beside gathering: FLIP, damping, faces without a velocity (model-fluid 4.1, 4.8, 11).
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
    for (std::size_t s = 0; s < before.size(); ++s)
        EXPECT_LT((t.liquid.particles.velocity(s) - before[s] - kick).norm(), 1e-14);
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

namespace {

/// A linear field, by component.
double linearField(int axis, const Vec3& x)
{
    return 1.0 + axis + (2.0 - axis) * x.x() - 3.0 * x.y() + (0.5 + axis) * x.z();
}
Vec3 linearSlope(int axis)
{
    return {2.0 - axis, -3.0, 0.5 + axis};
}

/// A few particles in a linear field, some of whose faces will be declared invalid.
struct Gaps {
    Gaps() : t(randomLiquid(200, 4, {3, 3, 3}, {6, 6, 6}))
    {
        t.setVelocities([&](int axis, int b, int c) { return linearField(axis, faceMiddle(t.grid(), axis, b, c)); });
    }

    /// Invalidate the faces of the stencils of one particle for which missing(node) holds; those keep a velocity that
    /// must not be read.
    template <class F>
    std::array<std::array<double, 4>, kAxes> gatherWithout(std::size_t s, int modes, F&& missing)
    {
        FaceFields faces = t.faces;
        for (int a = 0; a < kAxes; ++a) {
            const Stencil stencil(t.grid(), a, t.liquid.particles.position(s));
            for (int n = 0; n < 27; ++n) {
                const CellRef face = faceOfCell(t.grid(), stencil.first + Vec3i(n % 3, n / 3 % 3, n / 9));
                if (!missing(n)) continue;
                faces.valid.block(face.block, a)[face.cell >> 6] &= ~(std::uint64_t{1} << (face.cell & 63));
                faces.velocity.block(face.block, a)[face.cell] = 1.0e6;
            }
        }
        return gatherWithGaps(faces, faces.velocity, t.grid(), t.liquid.particles.position(s), modes);
    }

    void expectLinear(const std::array<std::array<double, 4>, kAxes>& c, std::size_t s) const
    {
        for (int a = 0; a < kAxes; ++a) {
            EXPECT_NEAR(c[a][0], linearField(a, t.liquid.particles.position(s)), 1e-10);
            for (int b = 0; b < kAxes; ++b) EXPECT_NEAR(c[a][1 + b], t.grid().dx * linearSlope(a)[b], 1e-10);
        }
    }

    /// Is no node's weight tiny? Then the fit is well conditioned whatever is missing.
    bool isCentral(std::size_t s) const
    {
        for (int a = 0; a < kAxes; ++a) {
            const Stencil stencil(t.grid(), a, t.liquid.particles.position(s));
            for (const Basis1D& basis : stencil.basis)
                if (std::min(basis.weight[0], basis.weight[2]) < 0.01) return false;
        }
        return true;
    }

    Transfers t;
};

}  // namespace

TEST(GatherWithGaps, GivesALinearFieldWhateverFacesAreMissing)
{
    Gaps gaps;
    std::mt19937 random(7);
    int tested = 0;
    for (std::size_t s = 0; s < gaps.t.liquid.particles.count; ++s) {
        if (!gaps.isCentral(s)) continue;
        ++tested;
        gaps.expectLinear(gaps.gatherWithout(s, 4, [](int) { return false; }), s);
        std::array<bool, 27> gone{};
        std::fill_n(gone.begin(), 13, true);
        std::shuffle(gone.begin(), gone.end(), random);
        gaps.expectLinear(gaps.gatherWithout(s, 8, [&](int n) { return gone[n]; }), s);
        const int plane = tested % 9;  // a whole plane of the stencil, as at a surface
        gaps.expectLinear(
            gaps.gatherWithout(s, 27, [&](int n) { return Vec3i(n % 3, n / 3 % 3, n / 9)[plane % 3] == plane / 3; }),
            s);
    }
    EXPECT_GT(tested, 10);
}

TEST(GatherWithGaps, GivesTheMeanOfTheRestWithFewFaces)
{
    Gaps gaps;
    std::mt19937 random(8);
    for (std::size_t s = 0; s < gaps.t.liquid.particles.count; ++s) {
        std::array<bool, 27> gone{};
        std::fill_n(gone.begin(), 14 + static_cast<int>(s % 12), true);
        std::shuffle(gone.begin(), gone.end(), random);
        const auto c = gaps.gatherWithout(s, 8, [&](int n) { return gone[n]; });
        for (int a = 0; a < kAxes; ++a) {
            const Stencil stencil(gaps.t.grid(), a, gaps.t.liquid.particles.position(s));
            double sum = 0.0, weights = 0.0;
            for (int n = 0; n < 27; ++n) {
                if (gone[n]) continue;
                const CellRef face = faceOfCell(gaps.t.grid(), stencil.first + Vec3i(n % 3, n / 3 % 3, n / 9));
                const double w = stencil.weight(n % 3, n / 3 % 3, n / 9);
                sum += w * gaps.t.velocity(a, face.block, face.cell);
                weights += w;
            }
            EXPECT_NEAR(c[a][0], sum / weights, 1e-11);
            for (int r = 1; r < 4; ++r) EXPECT_EQ(c[a][r], 0.0);
        }
    }
}

TEST(GatherWithGaps, GivesRestWithoutAnyFace)
{
    Gaps gaps;
    for (const auto& component : gaps.gatherWithout(0, 8, [](int) { return true; }))
        for (double c : component) EXPECT_EQ(c, 0.0);
}

// The same through facesToParticles, with every cell marked: nothing above the gradient, all else as in the ordinary
// gather.
TEST(GatherWithGaps, AgreesWithTheOrdinaryGatherOnLinearFields)
{
    for (int modes : {1, 4, 8, 11, 27}) {
        SCOPED_TRACE(modes);
        Transfers ordinary(randomLiquid(500, modes)), gappy(randomLiquid(500, modes));
        for (Transfers* t : {&ordinary, &gappy})
            t->setVelocities(
                [&](int axis, int b, int c) { return linearField(axis, faceMiddle(t->grid(), axis, b, c)); });
        BlockBits<> gaps;
        gaps.resize(gappy.grid().count());
        for (int b = 0; b < gappy.grid().count(); ++b)
            for (int c = 0; c < kBlockCells; ++c) gaps.set(b, c);
        GatherSettings settings;
        settings.modes = modes;
        settings.dt = 0.01;
        settings.keep = 0.9;
        const GatherSums a = ordinary.toParticles(settings);
        settings.gaps = &gaps;
        const GatherSums b = gappy.toParticles(settings);
        EXPECT_NEAR(a.kinetic, b.kinetic, 1e-11 * a.kinetic);
        EXPECT_NEAR(a.modal, b.modal, 1e-11 * a.kinetic);
        EXPECT_NEAR(a.maxSpeedSquared, b.maxSpeedSquared, 1e-11 * a.maxSpeedSquared);
        const LiquidParticles &p = ordinary.liquid.particles, &q = gappy.liquid.particles;
        for (std::size_t s = 0; s < p.count; ++s) {
            EXPECT_LT((p.position(s) - q.position(s)).norm(), 1e-12);
            for (int axis = 0; axis < kAxes; ++axis)
                for (int r = 0; r < p.modeCount; ++r) EXPECT_NEAR(p.mode(axis, r)[s], q.mode(axis, r)[s], 1e-11);
        }
    }
}
