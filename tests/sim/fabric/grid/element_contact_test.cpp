// Contact of the elements of fabric on the grid: stresses where a step ends, and their forces (fabric/grid/README.md, Contact law).
#include "sim/fabric/grid/element_contact.h"
#include "sim/fabric/grid/contact_law.h"
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

constexpr double kStep = 1.0e-6;

TEST(GridContactLaw, PressedSheetHasThePublishedPressure)
{
    FabricPiece piece = pieceOf(clothGrid({{3, 3}, {0.144, 0.144}}), wool(), {0.017, 0.017});
    const Fabric fabric = fabricOf(piece);
    FabricState state = restState(fabric);
    ElementContact contact(fabric);
    state.gridSolver.across = contact.unstrained(state);
    const double r33 = 0.8;
    for (Vec3& d : state.gridSolver.across) d *= r33;
    contact.assemble(state);
    const ContactModuli m(piece.material);
    const double volume = 0.5 * 0.144 * 0.144 * 0.034;
    for (std::size_t e = 0; e < contact.size(); ++e) {
        const Vec3 n = state.gridSolver.across[e] / r33;
        const double pressure = -n.dot(gradientOf(contact, e).onGrid * n) / (volume * r33);
        EXPECT_NEAR(pressure, piece.material.packing() * m.normal() * 0.2 * 0.2, 1e-9 * pressure);
    }
}

/// A sheet and a yarn, squeezed to a share of their thickness across, and where a step would take them with u = G x and
/// the mesh at rest.
struct Pressed {
    Pressed(FabricMaterial material, double share, const Mat3& gradient)
        : pieces{pieceOf(clothGrid({{3, 3}, {0.144, 0.144}}), material, {0.017, 0.017}),
                 pieceOf(strand(Vec3(1.0, 0.0, 0.0), Vec3(1.5, 0.0, 0.0), 3), material, {0.05, 0.05})},
          fabric(assembleFabric(pieces)),
          state(restState(fabric)),
          contact(fabric)
    {
        state.gridSolver.across = contact.unstrained(state);
        for (Vec3& d : state.gridSolver.across) d *= share;
        motion.gradient.assign(contact.size(), gradient);
        motion.velocity.assign(state.x.size(), Vec3::Zero());
    }
    void assemble(double h, double negligible = 0.0)
    {
        const PredictedMotion prediction{motion, h, kCell, negligible};
        contact.assemble(state, &prediction);
    }
    /// ∂E/∂d where the step is expected to end, by the stiffness.
    std::array<Vec3, 2> lastStress(std::size_t e, double h) const
    {
        const ElementContact::Local& at = contact.local(e);
        std::array<Vec3, 2> last = contact.stress(e).stress;
        const Mat3 step = h * motion.gradient[e];
        last[0] += at.stiffness[0] * (step * at.d[0]) + at.stiffness[1] * (step * at.d[1]);
        last[1] += at.stiffness[1].transpose() * (step * at.d[0]) + at.stiffness[2] * (step * at.d[1]);
        return last;
    }
    std::vector<FabricPiece> pieces;
    Fabric fabric;
    FabricState state;
    ElementContact contact;
    FabricMotion motion;
};

/// Surfaces that slide past each other along x, in the plane of the sheet and along the yarn.
TEST(GridContactLaw, ShearIsHeldByFrictionAlone)
{
    constexpr double h = 1.0e-3, kShare = 0.99;
    const Mat3 sliding = 200.0 * (Vec3::UnitX() * Vec3::UnitY().transpose() + Vec3::UnitX() * Vec3::UnitZ().transpose());
    for (double angle : {0.0, 0.4}) {
        FabricMaterial material = wool();
        material.frictionAngle = angle;
        Pressed pressed(material, kShare, sliding);
        pressed.assemble(h);
        const ContactModuli m(material);
        for (std::size_t e = 0; e < pressed.contact.size(); ++e) {
            const double volume =
                pressed.contact.isEdge(e) ? material.packing() * kPi * 0.05 * 0.05 * 0.5 / 3.0 : material.packing() * 0.5 * 0.144 * 0.144 * 0.034;
            const std::array<Vec3, 2> last = pressed.lastStress(e, h);
            const double along = std::hypot(last[0][0], last[1][0]) / volume;
            const double log = std::log(kShare);
            const double bound = pressed.contact.isEdge(e) ? m.coulomb * 0.5 * std::sqrt(2.0) * std::abs(2.0 * (m.shear + m.lame) * log / kShare)
                                                           : m.coulomb * m.normal() * (1.0 - kShare) * (1.0 - kShare);
            EXPECT_NEAR(along, bound, 1e-9 * m.normal()) << "element " << e;
        }
    }
}

/// Yarns that part keep no stress that would hold them together.
TEST(GridContactLaw, PartingTakesStressNoFurtherThanToZero)
{
    constexpr double h = 1.0e-3, kShare = 0.999;
    Pressed pressed(wool(), kShare, 100.0 * Mat3::Identity());
    pressed.assemble(h);
    for (std::size_t e = 0; e < pressed.contact.size(); ++e) {
        if (!pressed.contact.isEdge(e)) continue;
        const double start = pressed.contact.stress(e).stress[0].norm();
        EXPECT_GT(start, 0.0);
        EXPECT_LT(pressed.lastStress(e, h)[0].norm(), 0.1 * start);
    }
}

/// However far motions go beyond what was expected, and beyond what a linear answer is good for.
TEST(GridContactLaw, StoresNoMoreThanTheSolvedStressesTook)
{
    constexpr double h = 1.0e-3;
    Noise noise(31);
    const auto gradient = [&](double strain) -> Mat3 { return strain / h * Mat3::NullaryExpr([&] { return noise(); }); };
    for (int n = 0; n < 100; ++n) {
        Pressed pressed(wool(), 0.7 + 0.3 * std::abs(noise()), gradient(0.3));
        pressed.assemble(h, n % 4 == 0 ? 1.0e30 : 0.0);  // of which all are left out
        for (Mat3& g : pressed.motion.gradient) g += gradient(n % 2 == 0 ? 0.01 : 1.0);
        std::vector<double> most;
        for (std::size_t e = 0; e < pressed.contact.size(); ++e) {
            const std::array<Vec3, 2> last = pressed.lastStress(e, h);
            const ElementContact::Local& at = pressed.contact.local(e);
            const double work = h * (last[0].dot(pressed.motion.gradient[e] * at.d[0]) + last[1].dot(pressed.motion.gradient[e] * at.d[1]));
            most.push_back(std::max(0.0, pressed.contact.stress(e).energy + work));
            if (!pressed.contact.stress(e).isActive) most.back() = pressed.contact.stress(e).energy;
        }
        const double told = pressed.contact.advectDirections({pressed.motion, h, kCell, 0.0}, 0.0, pressed.state);
        pressed.contact.assemble(pressed.state);
        EXPECT_NEAR(pressed.contact.energy(), told, 1.0e-12 * told);
        for (std::size_t e = 0; e < pressed.contact.size(); ++e)
            EXPECT_LE(pressed.contact.stress(e).energy, most[e] * (1.0 + 1.0e-9)) << "state " << n << ", element " << e;
    }
}

TEST(GridContactLaw, WhatWouldNotBeFeltIsLeftOut)
{
    constexpr double h = 1.0e-3;
    Pressed pressed(wool(), 1.0 - 1.0e-6, Mat3::Zero());
    pressed.assemble(h);
    EXPECT_EQ(pressed.contact.active().size(), pressed.contact.size());
    double largest = 0.0;
    for (std::size_t e = 0; e < pressed.contact.size(); ++e) {
        const double thickness = pressed.contact.isEdge(e) ? 0.25 * kPi * 0.1 * 0.1 : 0.034;
        const double mass = wool().envelopeDensity() * thickness * (pressed.contact.isEdge(e) ? 0.5 / 3.0 : 0.5 * 0.144 * 0.144);
        const std::array<Vec3, 2>& stress = pressed.contact.stress(e).stress;
        largest = std::max(largest, 4.0 * std::hypot(stress[0].norm(), stress[1].norm()) / (mass * kCell));
    }
    pressed.assemble(h, 1.01 * largest);
    EXPECT_TRUE(pressed.contact.active().empty());
    pressed.assemble(h, 0.99 * largest);
    EXPECT_FALSE(pressed.contact.active().empty());
}

/// Moves of the corners and of the directions by a gradient.
TEST(GridContactLaw, ForcesOnGridAndMeshAreTheSlopesOfTheEnergy)
{
    std::vector<FabricPiece> pieces = {pieceOf(clothGrid({{3, 3}, {0.144, 0.13}}), wool(), {0.017, 0.017}),
                                       pieceOf(strand(Vec3(1.0, 0.0, 0.0), Vec3(1.5, 0.2, 0.3), 3), wool(), {0.05, 0.04})};
    const Fabric fabric = assembleFabric(pieces);
    FabricState rest = restState(fabric);
    ElementContact contact(fabric);
    rest.gridSolver.across = contact.unstrained(rest);
    Noise noise(6);
    for (Vec3& x : rest.x) x += 0.02 * noise.vector();
    for (Vec3& d : rest.gridSolver.across) d = 0.8 * (d + 0.1 * noise.vector());
    contact.assemble(rest);
    ASSERT_EQ(contact.active().size(), contact.size());
    std::vector<Vec3> move;
    for (std::size_t v = 0; v < rest.x.size(); ++v) move.push_back(noise.vector());
    Mat3 g;
    for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = noise();
    double slope = 0.0;
    for (std::size_t e = 0; e < contact.size(); ++e) {
        const PlainPush push = gradientOf(contact, e);
        slope += push.onGrid.cwiseProduct(g).sum();
        for (int k = 0; k < 3; ++k)
            if (contact.corners(e)[k] >= 0) slope += push.nodalResponse[k].dot(move[contact.corners(e)[k]]);
    }
    const auto energyAt = [&](double step) {
        FabricState moved = rest;
        for (std::size_t v = 0; v < move.size(); ++v) moved.x[v] += step * move[v];
        for (Vec3& d : moved.gridSolver.across) d += step * (g * d);
        contact.assemble(moved);
        return contact.energy();
    };
    EXPECT_NEAR((energyAt(kStep) - energyAt(-kStep)) / (2.0 * kStep), slope, 1e-6 * std::abs(slope));
}

}  // namespace
}  // namespace sim::testing
