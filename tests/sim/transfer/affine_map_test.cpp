// P2G by the affine maps (transfer/README.md, Maps); what they conserve is in conservation_test.cpp.
#include "sim/liquid/energy.h"
#include "sim/simulation.h"
#include "sim/transfer/scatter_bounded.h"
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

using namespace sim;
using namespace sim::test;

namespace {

constexpr double kCell = 0.288;

/// Particles that have flown freely for dt with the velocities C (x − center); returns P2G's largest error against the
/// field which that gives, C (I + dt C)⁻¹ (x − center), relative to its largest value on the faces.
double ballisticError(int modes, XiMap map, double dt)
{
    Transfers t(randomLiquid(600, modes, {5, 5, 5}, {-2, 6, 3}, kCell));
    t.liquid.moveModesHome();
    Mat3 gradient;
    gradient << 1.0, -2.0, 0.5, 3.0, -0.5, 1.5, -1.0, 2.5, 0.7;
    gradient *= 0.2 / (dt * gradient.norm());
    const Vec3 center(0.2, 2.0, 1.7);
    LiquidParticles& p = t.liquid.particles;
    for (std::size_t s = 0; s < p.count; ++s) {
        const Vec3 v = gradient * (p.position(s) - center);
        for (int a = 0; a < kAxes; ++a) {
            for (int r = 0; r < p.modeCount; ++r) p.mode(a, r)[s] = r == 0 ? v[a] : r < 4 ? kCell * gradient(a, r - 1) : 0.0;
            p.x[a][s] += dt * v[a];
        }
    }
    t.liquid.sort();
    t.toFaces(map, dt);
    const Mat3 later = gradient * (Mat3::Identity() + dt * gradient).inverse();
    double largest = 0.0;
    const double error = t.largestError([&](int axis, const Vec3& x) {
        const double u = (later * (x - center))[axis];
        largest = std::max(largest, std::abs(u));
        return u;
    });
    return error / largest;
}

}  // namespace

TEST(AffineMap, CarriesALinearFieldExactly)
{
    for (int modes : {4, 8, 11, 27}) {
        EXPECT_LT(ballisticError(modes, XiMap::Affine, 0.01), 1e-10) << modes << " modes";
        EXPECT_GT(ballisticError(modes, XiMap::Translation, 0.01), 1e-2) << modes << " modes";
    }
}

// The definition (transfer/README.md, Maps), face by face.
TEST(AffineMap, EvaluatesThePolynomialWhereTheMaterialWas)
{
    for (int modes : {4, 8, 11, 27}) {
        const double dt = 0.05;
        Transfers t(randomLiquid(2000, modes));
        const LiquidParticles& p = t.liquid.particles;
        t.toFaces(XiMap::Affine, dt);
        FaceFields expected;
        expected.sums.resize(t.grid().count());
        std::fill_n(expected.sums.block(0), expected.sums.size(), 0.0);
        for (std::size_t s = 0; s < p.count; ++s) {
            std::array<Modes, kAxes> c{};
            Mat3 gradient;
            for (int a = 0; a < kAxes; ++a) {
                for (int r = 0; r < p.modeCount; ++r) c[a][r] = p.mode(a, r)[t.liquid.order.source[s]];
                gradient.row(a) << c[a][1], c[a][2], c[a][3];
            }
            const Mat3 motion = Mat3::Identity() + dt / t.grid().dx * gradient;
            const Mat3 toOld = motion.determinant() < 0.1 ? Mat3::Identity() : Mat3(motion.inverse());
            for (int a = 0; a < kAxes; ++a) {
                const Stencil stencil(t.grid(), a, p.position(s));
                for (int n = 0; n < 27; ++n) {
                    const Vec3i node(n % 3, n / 3 % 3, n / 9);
                    const CellRef face = faceOfCell(t.grid(), stencil.first + node);
                    const Vec3 z(stencil.basis[0].z[node.x()], stencil.basis[1].z[node.y()], stencil.basis[2].z[node.z()]);
                    const double share = p.mass[s] * stencil.weight(node);
                    expected.sums.block(face.block, FaceFields::kMass + a)[face.cell] += share;
                    expected.sums.block(face.block, FaceFields::kMomentum + a)[face.cell] += share * evaluateModes(Vec3(toOld * z), c[a]);
                }
            }
        }
        for (std::size_t i = 0; i < expected.sums.size(); ++i)
            ASSERT_NEAR(t.faces.sums.block(0)[i], expected.sums.block(0)[i], 1e-11) << modes << " modes";
    }
}

TEST(AffineMap, IsTranslationWhereTheMotionFoldsTheLiquid)
{
    Transfers t(randomLiquid(500, 8)), plain(randomLiquid(500, 8));
    LiquidParticles& p = t.liquid.particles;
    const double dt = 0.1;
    for (LiquidParticles* liquid : {&p, &plain.liquid.particles})
        for (std::size_t s = 0; s < p.count; ++s)
            for (int a = 0; a < kAxes; ++a)
                for (int b = 0; b < kAxes; ++b) liquid->mode(a, 1 + b)[s] = a == b && a < 1 ? -2.0 * t.grid().dx / dt : 0.0;
    t.toFaces(XiMap::Affine, dt);
    plain.toFaces();
    for (std::size_t i = 0; i < t.faces.sums.size(); ++i) ASSERT_NEAR(t.faces.sums.block(0)[i], plain.faces.sums.block(0)[i], 1e-11);
}

TEST(AffineMap, SameBitsForAnyThreadCount)
{
    const auto sums = [](int threads) {
        return onThreads(threads, [] {
            Transfers t(randomLiquid(5000, 8));
            t.toFaces(XiMap::AffineConservative, 0.03);
            return std::vector<double>(t.faces.sums.block(0), t.faces.sums.block(0) + t.faces.sums.size());
        });
    };
    const auto one = sums(1);
    for (int threads : {2, 8}) EXPECT_EQ(sums(threads), one) << threads << " threads";
}

namespace {

/// Two drops that meet, after three steps.
State afterThreeSteps(TransferMethod method, int modes, XiMap xi)
{
    Scene scene;
    scene.settings.cell = 0.288;
    scene.settings.time.dt = 2.0e-3;
    scene.settings.transfer.method = method;
    scene.settings.transfer.modes = modes;
    scene.settings.transfer.xi = xi;
    for (double side : {-1.0, 1.0}) {
        SourceSettings drop;
        drop.shape = Shape::ball({0.7 * side, 0.0, 0.0}, 0.8);
        drop.emissions.emplace_back().velocity = {-20.0 * side, 5.0 * side, 0.0};
        scene.sources.push_back(drop);
    }
    Simulation simulation(scene);
    for (int n = 1; n <= 3; ++n) {
        const StepReport report = simulation.step(2.0e-3 * n);
        EXPECT_EQ(simulation.state().lastDt, report.dt);
    }
    return simulation.state();
}

}  // namespace

TEST(AffineMap, IsWhatTheStepUsesWhereItMatters)
{
    const auto after = [](TransferMethod method, int modes, XiMap xi) { return afterThreeSteps(method, modes, xi); };
    const auto distance = [](const State& a, const State& b) {
        std::vector<Vec3> place(a.nextId);
        for (std::size_t p = 0; p < a.liquid.count; ++p) place[a.liquid.id[p]] = a.liquid.position(p);
        double largest = 0.0;
        for (std::size_t p = 0; p < b.liquid.count; ++p) largest = std::max(largest, (b.liquid.position(p) - place[b.liquid.id[p]]).norm());
        return largest;
    };
    // Of about 0.1 cm that they have moved; round-off would be 1e-15.
    const State translation = after(TransferMethod::PolyPic, 8, XiMap::Translation);
    EXPECT_GT(distance(after(TransferMethod::PolyPic, 8, XiMap::Affine), translation), 1e-5);
    EXPECT_GT(distance(after(TransferMethod::PolyPic, 8, XiMap::AffineConservative), translation), 1e-5);
    const State apic = after(TransferMethod::Apic, 4, XiMap::Translation);
    EXPECT_GT(distance(after(TransferMethod::Apic, 4, XiMap::Affine), apic), 1e-5);
    EXPECT_EQ(stateHash(after(TransferMethod::Apic, 4, XiMap::AffineConservative)), stateHash(apic));
    for (TransferMethod method : {TransferMethod::Pic, TransferMethod::Flip})
        EXPECT_EQ(stateHash(after(method, 8, XiMap::Affine)), stateHash(after(method, 8, XiMap::Translation)));
}

TEST(AffineMap, TheLastStepIsPartOfTheState)
{
    State a, b;
    b.lastDt = 1.0e-3;
    EXPECT_NE(stateHash(a), stateHash(b));
}

/// However steep the gradients and however few the particles, the faces get no more energy than the particles have.
TEST(AffineMap, GivesTheFacesNoEnergyBeyondTheParticles)
{
    int cut = 0, whole = 0;
    for (unsigned seed = 0; seed < 40; ++seed)
        for (const int modes : {4, 8, 11, 27})
            for (const XiMap map : {XiMap::Affine, XiMap::AffineConservative}) {
                const double steepness = std::pow(10.0, -3.0 + 0.1 * seed);  // dt |C| of random modes
                SortedLiquid liquid = randomLiquid(seed % 3 == 0 ? 3 : 400, modes, {6, 5, 7}, {-2, 6, 3}, kCell, seed);
                const double dt = steepness * kCell;
                const LiquidEnergies own = liquidEnergies(liquid.particles, liquid.grid, Vec3::Zero(), &liquid.order);
                BoundedScratch scratch;
                FaceFields faces;
                const double share =
                    particlesToFacesBounded({liquid.particles, liquid.order, liquid.grid}, map, dt, own.kinetic + own.modal, scratch, faces);
                (share < 1.0 ? cut : whole) += 1;
                double energy = 0.0;
                Vec3 momentum = Vec3::Zero(), expected = Vec3::Zero();
                forEachFaceOf(liquid.grid, [&](int a, int b, int c) {
                    const double m = faces.sums.block(b, FaceFields::kMass + a)[c], p = faces.sums.block(b, FaceFields::kMomentum + a)[c];
                    if (m > 0.0) energy += 0.5 * p * p / m;
                    momentum[a] += p;
                    expected[a] += scratch.translated.block(b, a)[c];
                });
                EXPECT_LE(energy, (own.kinetic + own.modal) * (1.0 + 1.0e-12)) << seed << ": " << modes << " modes";
                if (map == XiMap::AffineConservative) {
                    EXPECT_LT((momentum - expected).norm(), 1.0e-11 * static_cast<double>(liquid.particles.count));
                }
            }
    EXPECT_GT(cut, 40);
    EXPECT_GT(whole, 40);
}
