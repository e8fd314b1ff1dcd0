#include "sim/fabric/rods/rod_kernel.h"
#include "sim/fabric/rods/rods.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fabric/rods/rod_gradient.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace sim {
namespace {

using testing::gradientOf;

/// Around a circle of tangents at 60 degrees from an axis the frame comes back turned by the solid angle π.
TEST(RodFrames, TransportAroundAClosedPathTurnsBySolidAngle)
{
    constexpr int kSteps = 4000;
    const double cap = kPi / 3.0;
    const auto tangentAt = [&](int i) {
        const double a = 2.0 * kPi * i / kSteps;
        return Vec3T<double>{std::sin(cap) * std::cos(a), std::sin(cap) * std::sin(a), std::cos(cap)};
    };
    const Vec3T<double> start = unitAcross(Vec3T<double>{1.0, 0.3, 0.2}, tangentAt(0));
    Vec3T<double> u = start;
    for (int i = 1; i <= kSteps; ++i) u = unitAcross(transported(u, tangentAt(i - 1), tangentAt(i)), tangentAt(i));
    const double angle = std::abs(std::atan2(dot(tangentAt(0), cross(start, u)), dot(start, u)));
    EXPECT_NEAR(angle, 2.0 * kPi * (1.0 - std::cos(cap)), 1.0e-5);
}

/// Five turns at one end, in steps of 30 degrees, are ten π of twist and not 0.
TEST(RodFrames, TwistCountsFullTurns)
{
    const FabricPiece piece = testing::pieceOf(strand(Vec3::Zero(), Vec3(4.0, 0.0, 0.0), 4), testing::wool(), {0.05, 0.05});
    const Fabric fabric = testing::fabricOf(piece);
    const FabricSettings settings;
    FabricState state = restState(fabric);
    const Rods rods(fabric, state, settings);
    // Turning the last edge's frame rigidly and its θ back leaves the material where it is: reference twist takes it up.
    for (int i = 0; i < 60; ++i) {
        const Eigen::AngleAxisd turn(kPi / 6.0, state.tangent[3]);
        state.reference[3] = turn * state.reference[3];
        rods.transportFrames(state);
    }
    EXPECT_NEAR(state.referenceTwist[3], 10.0 * kPi, 1.0e-9);
}

/// A helix has curvature R/(R² + p²), and none of its twist is in the parallel frame.
TEST(RodFrames, HelixHasItsCurvature)
{
    const double radius = 1.0, pitch = 0.5, exact = radius / (radius * radius + pitch * pitch);
    double previous = 0.0;
    for (int n : {100, 200}) {
        std::vector<Vec3> points;
        for (int i = 0; i <= n; ++i) {
            const double a = 2.0 * kPi * i / n;
            points.emplace_back(radius * std::cos(a), radius * std::sin(a), pitch * a);
        }
        const Fabric fabric = testing::fabricOf(testing::pieceOf(strand(points), testing::wool(), {0.02, 0.02}));
        const FabricState s = restState(fabric);
        RodEdge<double> e, f;
        const int j = n / 2;
        for (auto [edge, i] : {std::pair{&e, j - 1}, std::pair{&f, j}}) {
            edge->length = fabric.edges.restLength[i];
            edge->tangent = toVec3T(s.tangent[i]);
            edge->m1 = toVec3T(s.reference[i]);
            edge->m2 = cross(edge->tangent, edge->m1);
        }
        const RodStrain<double> strain = rodStrain(e, f);
        const double curvature = std::hypot(strain.curvature[0], strain.curvature[1]) / e.length;
        const double error = std::abs(curvature - exact);
        if (previous > 0.0) {
            EXPECT_NEAR(previous / error, 4.0, 0.1);
        }
        previous = error;
        Rods rods(fabric, s, {});
        for (double g : gradientOf(rods, s)) EXPECT_LT(std::abs(g), 1.0e-6);  // dyn; the stiffnesses are 1e4
    }
}

}  // namespace
}  // namespace sim
