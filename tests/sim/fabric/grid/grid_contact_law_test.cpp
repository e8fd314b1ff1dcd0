// Contact of fabric on the grid: energies, stresses, return mapping (fabric/grid/README.md, Contact law).
#include "sim/fabric/grid/contact_law.h"
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

}  // namespace
}  // namespace sim::testing
