// The linear system of the fabric on the grid, and the transfers of its phase (fabric/grid/README.md, Linear system).
#include "tests/sim/fabric/grid/grid_runs.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

constexpr double kStep = 2.0e-4;

std::vector<FabricPiece> allKinds() { return {weave(6, 1.0e3), cloth(6, Vec3(0.1, 0.5, 0.2))}; }

TEST(GridFabricSystem, IsSymmetricAndPositive)
{
    GridParts parts(allKinds(), gridSettings(TransferMethod::PolyPic));
    press(parts.state, 0.2, 1, 0.1);
    parts.assemble(kStep);
    ASSERT_GT(parts.contact.active().size(), parts.contact.size() / 2);
    FaceVector ax, ay;
    for (unsigned seed = 0; seed < 5; ++seed) {
        const FaceVector x = parts.randomVector(2 * seed), y = parts.randomVector(2 * seed + 1);
        ax.resize(parts.system.blocks(), parts.system.edges());
        ay.resize(parts.system.blocks(), parts.system.edges());
        parts.system.multiply(x, ax);
        parts.system.multiply(y, ay);
        const double scale = std::sqrt(GridParts::dot(x, ax) * GridParts::dot(y, ay));
        EXPECT_GT(GridParts::dot(x, ax), 0.0);
        EXPECT_NEAR(GridParts::dot(x, ay), GridParts::dot(y, ax), 1e-12 * scale);
    }
}

/// A p − M p against the change of the impulses when all moves by h p.
double relativeErrorOfSystem(std::vector<FabricPiece> pieces, double pressed)
{
    GridParts parts(pieces, gridSettings(TransferMethod::PolyPic));
    if (pressed > 0.0) press(parts.state, pressed, 1, 0.0);
    const FaceSystem::Begun begun = parts.assemble(kStep);
    const FaceVector p = parts.randomVector(3);
    FaceVector ap, before, after;
    ap.resize(parts.system.blocks(), parts.system.edges());
    parts.system.multiply(p, ap);

    const FabricState start = parts.state;
    FabricMotion motion;
    parts.system.findMotion(begun, p.faces, motion);
    const auto& [g, u] = motion;
    const auto impulsesAt = [&](double step, FaceVector& out) {
        parts.state = start;
        for (std::size_t v = 0; v < u.size(); ++v) parts.state.x[v] += step * kStep * u[v];
        for (std::size_t e = 0; e < parts.system.edges(); ++e) parts.state.theta[e] += step * kStep * p.twist[e];
        const std::size_t edges = parts.system.edges();
        for (std::size_t d = 0; d < start.gridSolver.across.size(); ++d)
            parts.state.gridSolver.across[d] += step * kStep * (g[d < 2 * edges ? d / 2 : d - edges] * start.gridSolver.across[d]);
        parts.stiffness.rods().transportFrames(parts.state);
        parts.assembleForces(kStep);
        parts.system.impulses(out);
    };
    constexpr double kMove = 1.0e-2;
    impulsesAt(kMove, after);
    impulsesAt(-kMove, before);
    double error = 0.0, size = 0.0;
    const double* mass = parts.system.mass().block(0);
    for (std::size_t i = 0; i < p.faces.size(); ++i) {
        if (!(mass[i] > 0.0)) continue;
        const double expected = (before.faces.block(0)[i] - after.faces.block(0)[i]) / (2.0 * kMove);
        const double found = ap.faces.block(0)[i] - mass[i] * p.faces.block(0)[i];
        error += (found - expected) * (found - expected);
        size += expected * expected;
    }
    for (std::size_t e = 0; e < parts.system.edges(); ++e) {
        const double expected = (before.twist[e] - after.twist[e]) / (2.0 * kMove);
        const double found = ap.twist[e] - parts.fabric.edges.twistInertia[e] * p.twist[e];
        error += (found - expected) * (found - expected);
        size += expected * expected;
    }
    return std::sqrt(error / size);
}

TEST(GridFabricSystem, IsTheSlopeOfTheForcesAtRest)
{
    EXPECT_LT(relativeErrorOfSystem({weave(6)}, 0.0), 1e-5);
    EXPECT_LT(relativeErrorOfSystem({cloth(6)}, 0.0), 1e-5);
}

/// What stretches and bends is weak here, so that contact shows. Its Hessian leaves out the stress's own turning, of
/// relative size 1e-3.
TEST(GridFabricSystem, HasTheSlopeOfContact)
{
    for (FabricPiece piece : {weave(6), cloth(6)}) {
        piece.material.young *= 1.0e-6;
        piece.material.contactStiffness *= 1.0e8;
        EXPECT_LT(relativeErrorOfSystem({piece}, 1.0e-3), 1e-2);
    }
}

/// u(face) on all faces that have mass after a round trip through the vertices.
template <class F>
double errorAfterRoundTrip(const std::vector<FabricPiece>& pieces, int modes, F&& u)
{
    GridParts parts(pieces, gridSettings(modes == 4 ? TransferMethod::Apic : TransferMethod::PolyPic, modes));
    parts.toFaces();
    const BlockGrid& grid = parts.particles.grid();
    const auto forEachFace = [&](auto&& f) {
        test::forEachFaceOf(grid, [&](int axis, int b, int c) {
            if (parts.particles.faces().sums.block(b, FaceFields::kMass + axis)[c] > 0.0)
                f(u(axis, Vec3(test::faceMiddle(grid, axis, b, c))), parts.particles.velocity().block(b, axis)[c]);
        });
    };
    forEachFace([](double wanted, double& v) { v = wanted; });
    parts.particles.toVertices(kStep, parts.state);
    parts.toFaces();
    double worst = 0.0;
    forEachFace([&](double wanted, double& v) { worst = std::max(worst, std::abs(v - wanted)); });
    return worst;
}

double affine(int axis, const Vec3& x) { return 1.0 + axis + (0.3 + axis) * x[0] - 0.7 * x[1] + (0.2 * axis - 1.0) * x[2]; }

TEST(GridFabricTransfer, AffineFieldsComeBack)
{
    for (int modes : {4, 8, 27}) EXPECT_LT(errorAfterRoundTrip(allKinds(), modes, affine), 1e-12) << modes << " modes";
}

TEST(GridFabricTransfer, MultilinearFieldsComeBackWithEightModes)
{
    const auto field = [](int axis, const Vec3& x) {
        return affine(axis, x) + 2.0 * x[0] * x[1] - (1.0 + axis) * x[0] * x[2] + 3.0 * x[1] * x[2] + 1.5 * x[0] * x[1] * x[2];
    };
    for (int modes : {8, 27}) EXPECT_LT(errorAfterRoundTrip(allKinds(), modes, field), 1e-12) << modes << " modes";
    EXPECT_GT(errorAfterRoundTrip(allKinds(), 4, field), 1e-3);
}

/// A sheet is surface everywhere: the quadratic modes would feed on faces that carry next to nothing.
TEST(GridFabricTransfer, HasNoMoreModesThanTheLiquidAtItsSurface)
{
    for (const auto& [asked, kept] : {std::pair(1, 1), std::pair(8, 8), std::pair(11, 8), std::pair(27, 8)}) {
        GridParts parts(allKinds(), gridSettings(TransferMethod::PolyPic, asked));
        parts.toFaces();
        EXPECT_EQ(parts.state.gridSolver.modes.size(), 3 * kept * parts.state.x.size()) << asked;
    }
}

}  // namespace
}  // namespace sim::testing
