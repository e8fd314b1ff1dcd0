// Contact of fabric on the grid: energies, stresses, return mapping (fabric/grid/README.md, Contact law).
#include "sim/fabric/grid/contact_law.h"
#include "sim/fabric/grid/element_contact.h"
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace sim::testing {
namespace {

double yarnEnergy(const ContactModuli& m, const yarn::Strain& r) { return yarn::energy(m, r, yarn::sectionOf(r)); }
yarn::Strain yarnStress(const ContactModuli& m, const yarn::Strain& r) { return yarn::stress(m, r, yarn::sectionOf(r)); }

constexpr double kStep = 1.0e-6;

FabricMaterial material()
{
    FabricMaterial m = wool();
    m.contactStiffness = 1.0;
    m.young = 1.0;
    m.poisson = 0.3;
    return m;
}

yarn::Strain squeezed(Noise& noise)
{
    yarn::Strain r;
    r << 0.2 * noise(), 0.2 * noise(), 0.75 + 0.2 * noise(), 0.2 * noise(), 0.0, 0.75 + 0.2 * noise();
    return r;
}

TEST(GridContactLaw, StressesAreTheSlopesOfTheEnergy)
{
    const ContactModuli m(material());
    Noise noise(1);
    for (int n = 0; n < 200; ++n) {
        const Vec3 r(0.3 * noise(), 0.3 * noise(), 0.5 + 0.45 * noise());
        const yarn::Strain s = squeezed(noise);
        for (int i = 0; i < 3; ++i) {
            const Vec3 by = kStep * Vec3::Unit(i);
            EXPECT_NEAR((sheet::energy(m, r + by) - sheet::energy(m, r - by)) / (2.0 * kStep), sheet::stress(m, r)[i], 1e-8);
        }
        for (int i = 0; i < 6; ++i) {
            yarn::Strain by = yarn::Strain::Zero();
            by(i % 3, i / 3) = kStep;
            EXPECT_NEAR((yarnEnergy(m, s + by) - yarnEnergy(m, s - by)) / (2.0 * kStep), yarnStress(m, s)(i % 3, i / 3), 1e-7);
        }
    }
}

/// The chain rule for the energy as a function of all directions.
TEST(GridContactLaw, ChainRuleThroughQrGivesTheSameStress)
{
    const ContactModuli m(material());
    Noise noise(2);
    for (int n = 0; n < 50; ++n) {
        Mat3 d;
        d << 1.1, 0.1 * noise(), 0.1 * noise(), 0.1 * noise(), 0.8, 0.1 * noise(), 0.1 * noise(), 0.1 * noise(), 0.8;
        const Mat3 q = yarn::frameOf(d.col(0), d.col(1)), r = q.transpose() * d;
        const auto energyOf = [&](const Mat3& x) {
            const Mat3 frame = yarn::frameOf(x.col(0), x.col(1));
            return yarnEnergy(m, (frame.transpose() * x).rightCols<2>());
        };
        Mat3 p = Mat3::Zero();
        p.rightCols<2>() = yarnStress(m, r.rightCols<2>());
        p(2, 1) = 0.0;
        const Mat3 k = p * r.transpose();
        Mat3 tau = k.triangularView<Eigen::Upper>();
        tau = Mat3(tau + tau.transpose()) - Mat3(k.diagonal().asDiagonal());
        const Mat3 expected = q * tau * r.transpose().inverse();
        for (int i = 0; i < 9; ++i) {
            Mat3 by = Mat3::Zero();
            by(i % 3, i / 3) = kStep;
            EXPECT_NEAR((energyOf(d + by) - energyOf(d - by)) / (2.0 * kStep), expected(i % 3, i / 3), 1e-7);
        }
    }
}

TEST(GridContactLaw, YarnStiffnessIsThePositivePartOfTheSlopeOfTheStress)
{
    const ContactModuli m(material());
    Noise noise(3);
    for (int n = 0; n < 200; ++n) {
        const yarn::Strain r = squeezed(noise);
        yarn::SectionStiffness k, slope;
        ASSERT_TRUE(yarn::stiffness(m, yarn::sectionOf(r), k));
        for (int i = 0; i < 4; ++i) {
            yarn::Strain by = yarn::Strain::Zero();
            by(1 + i % 2, i / 2) = kStep;
            const yarn::Strain change = (yarnStress(m, r + by) - yarnStress(m, r - by)) / (2.0 * kStep);
            slope.col(i) << change(1, 0), change(2, 0), change(1, 1), change(2, 1);
        }
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(0.5 * (slope + slope.transpose()));
        const Eigen::Matrix4d positive = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
        EXPECT_LT((k - positive).cwiseAbs().maxCoeff(), 1e-5);
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(k).eigenvalues().minCoeff(), -1e-12);
    }
}

TEST(GridContactLaw, SheetStiffnessIsTheSlopeOfTheStress)
{
    const ContactModuli m(material());
    Noise noise(4);
    for (int n = 0; n < 100; ++n) {
        const Vec3 r(0.3 * noise(), 0.3 * noise(), 0.5 + 0.45 * noise()), k = sheet::stiffness(m, r, r);
        for (int i = 0; i < 3; ++i) {
            const Vec3 by = kStep * Vec3::Unit(i);
            const Vec3 slope = (sheet::stress(m, r + by) - sheet::stress(m, r - by)) / (2.0 * kStep);
            EXPECT_NEAR((slope - k[i] * Vec3::Unit(i)).norm(), 0.0, 1e-8);
            EXPECT_GE(k[i], 0.0);
        }
    }
}

/// What comes to touch, or is pressed harder, meets at the end the stress that it has there.
TEST(GridContactLaw, SheetStiffnessLeadsToTheStressAtTheEnd)
{
    const ContactModuli m(material());
    Noise noise(14);
    for (int n = 0; n < 100; ++n) {
        const Vec3 r(0.0, 0.0, n % 2 == 0 ? 1.0 : 0.75 + 0.2 * noise()), last = r - (0.3 + 0.2 * noise()) * Vec3::UnitZ();
        const double change = sheet::stiffness(m, r, last)[2] * (last - r)[2];
        EXPECT_NEAR(sheet::stress(m, r)[2] + change, sheet::stress(m, last)[2], 1e-12 * m.normal());
    }
}

TEST(GridContactLaw, FrictionIsBoundedByThePressure)
{
    const ContactModuli m(material());
    Noise noise(5);
    for (int n = 0; n < 500; ++n) {
        const Vec3 r = sheet::returnMapping(m, {noise(), noise(), 1.2 * noise()}), t = sheet::stress(m, r);
        EXPECT_LE(t.head<2>().norm(), m.coulomb * -t[2] * (1.0 + 1e-12));
        yarn::Strain s;
        s << noise(), noise(), 0.8 + 0.5 * noise(), 0.3 * noise(), 0.3 * noise(), 0.8 + 0.5 * noise();
        const yarn::Strain kept = yarn::returnMapping(m, s);
        const yarn::Section section(kept.bottomRows<2>());
        const Eigen::Vector2d log = section.sigma.array().log();
        if (log.sum() > -1e-12) continue;
        const Eigen::Vector2d p = ((2.0 * m.shear * log.array() + m.lame * log.sum()) / section.sigma.array()).matrix();
        EXPECT_LE(m.shear * kept.row(0).norm(), m.coulomb * 0.5 * p.norm() * (1.0 + 1e-9));
        const double deviator = std::abs(log[0] - log[1]) / std::sqrt(2.0);
        EXPECT_LE(deviator, -(m.lame + m.shear) / m.shear * log.sum() * m.cone + 1e-12);
    }
}

TEST(GridContactLaw, SlidingSectionsStillAnswerToPressure)
{
    const ContactModuli m(material());
    Noise noise(7);
    for (double across : {0.0, 0.3, 1.0}) {
        const yarn::Strain r = squeezed(noise);
        const yarn::Section section = yarn::sectionOf(r);
        yarn::SectionStiffness whole, left;
        ASSERT_TRUE(yarn::stiffness(m, section, whole));
        left = whole;
        yarn::scaleDeviatoric(section, across, left);
        const Eigen::Vector4d scaling(r(1, 0), r(2, 0), r(1, 1), r(2, 1));
        EXPECT_LT((left * scaling - whole * scaling).norm(), 1e-12 * (whole * scaling).norm());
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(left).eigenvalues().minCoeff(), -1e-12);
        Eigen::Vector4d change(noise(), noise(), noise(), noise());
        change -= change.dot(whole * scaling) / scaling.dot(whole * scaling) * scaling;  // no work with scaling
        const double expected = across * change.dot(whole * change);
        EXPECT_NEAR(change.dot(left * change), expected, 1e-12 * change.dot(whole * change));
    }
}

TEST(GridContactLaw, SeparationLeavesNoStress)
{
    const ContactModuli m(material());
    EXPECT_EQ(sheet::returnMapping(m, {0.3, -0.2, 1.01}), Vec3::UnitZ());
    EXPECT_EQ(sheet::stress(m, sheet::returnMapping(m, {0.3, -0.2, 1.01})).norm(), 0.0);
    yarn::Strain r;
    r << 0.1, 0.2, 1.3, 0.1, 0.0, 0.9;
    EXPECT_LT(yarnStress(m, yarn::returnMapping(m, r)).norm(), 1e-12);
}

TEST(GridContactLaw, IsotropicCompressionIsKept)
{
    for (double angle : {0.0, 0.5}) {
        FabricMaterial frictional = material();
        frictional.frictionAngle = angle;
        const ContactModuli m(frictional);
        yarn::Strain r;
        r << 0.0, 0.0, 0.8, 0.0, 0.0, 0.8;
        EXPECT_LT((yarn::returnMapping(m, r) - r).norm(), 1e-14);
    }
}

TEST(GridContactLaw, SheetTurnedInsideOutIsPushedBack)
{
    const ContactModuli m(material());
    EXPECT_LT(sheet::stress(m, {0.0, 0.0, -0.3})[2], sheet::stress(m, {0.0, 0.0, 0.3})[2]);
    EXPECT_EQ(sheet::returnMapping(m, {0.0, 0.0, -0.3})[2], kLeastThickness);
}

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
