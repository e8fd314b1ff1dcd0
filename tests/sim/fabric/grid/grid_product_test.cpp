// The fast products of the fabric on the grid against plain loops over all faces and elements.
#include "tests/sim/fabric/grid/grid_runs.h"
#include "tests/sim/fixtures.h"
#include "tests/sim/transfer/transfers.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

constexpr double kStep = 2.0e-4;

/// No more iterations than these, however large the error is still.
FaceTolerance within(double speed, int iterations) { return {speed, iterations, speed, iterations}; }

double spline(double r)
{
    r = std::abs(r);
    return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0.0;
}

/// The pieces of the system's matrix, one number at a time.
struct PlainSystem {
    explicit PlainSystem(GridParts& p) : parts(p), grid(p.particles.grid())
    {
        test::forEachFaceOf(grid, [&](int axis, int b, int c) {
            if (massOf(axis, b, c) > 0.0) faces.push_back({axis, b, c, Vec3(test::faceMiddle(grid, axis, b, c))});
        });
    }
    double massOf(int axis, int b, int c) const { return parts.system.mass().block(b, axis)[c]; }
    /// f(face, weight, weight · (face − x)) for the faces with mass around x.
    void forEachWeight(const Vec3& x, auto&& f) const
    {
        for (const Face& face : faces) {
            const Vec3 r = (face.x - x) / grid.dx;
            if (r.cwiseAbs().maxCoeff() >= 1.5) continue;
            const double w = spline(r[0]) * spline(r[1]) * spline(r[2]);
            f(face, w, Vec3(4.0 * w / grid.dx * r));
        }
    }
    Vec3 at(const FaceVector& u, const Vec3& x) const
    {
        Vec3 sum = Vec3::Zero();
        forEachWeight(x, [&](const Face& f, double w, const Vec3&) { sum[f.axis] += w * of(u, f); });
        return sum;
    }
    /// f(face, weight · (face − x)) for the faces around x that elements feel.
    void forEachSlope(const Vec3& x, auto&& f) const
    {
        const double mean = std::accumulate(parts.fabric.mass.begin(), parts.fabric.mass.end(), 0.0) / static_cast<double>(parts.fabric.mass.size());
        forEachWeight(x, [&](const Face& face, double, const Vec3& z) {
            if (massOf(face.axis, face.block, face.cell) > 1.0e-9 * mean) f(face, z);
        });
    }
    /// ∇u, and that of a 1 on the faces that elements feel.
    std::array<Mat3, 2> gradientsAt(const FaceVector& u, const Vec3& x) const
    {
        std::array<Mat3, 2> sum = {Mat3::Zero(), Mat3::Zero()};
        forEachSlope(x, [&](const Face& f, const Vec3& z) {
            sum[0].row(f.axis) += of(u, f) * z.transpose();
            sum[1].row(f.axis) += z.transpose();
        });
        return sum;
    }
    /// A p.
    FaceVector times(const FaceVector& p) const
    {
        const std::size_t vertices = parts.state.x.size();
        AlignedArray<double> in(parts.stiffness.unknowns().size), out(in.size());
        std::vector<Vec3> u, force;
        for (std::size_t v = 0; v < vertices; ++v) {
            u.push_back(at(p, parts.state.x[v]));
            parts.stiffness.set(in, static_cast<int>(v), u[v]);
        }
        for (std::size_t e = 0; e < parts.system.edges(); ++e) in[parts.stiffness.unknowns().twistSlot[e]] = p.twist[e];
        parts.stiffness.multiply(in, out);
        for (std::size_t v = 0; v < vertices; ++v) force.push_back(parts.stiffness.at(out, static_cast<int>(v)));

        FaceVector q;
        q.resize(parts.system.blocks(), parts.system.edges());
        for (const Face& f : faces) of(q, f) = massOf(f.axis, f.block, f.cell) * of(p, f);
        for (int e : parts.contact.active()) addContact(e, p, u, force, q);
        for (std::size_t v = 0; v < vertices; ++v)
            forEachWeight(parts.state.x[v], [&](const Face& f, double w, const Vec3&) { of(q, f) += kStep * kStep * w * force[v][f.axis]; });
        for (std::size_t e = 0; e < parts.system.edges(); ++e)
            q.twist[e] = parts.fabric.edges.twistInertia[e] * p.twist[e] + kStep * kStep * out[parts.stiffness.unknowns().twistSlot[e]];
        return q;
    }
    void addContact(int e, const FaceVector& p, const std::vector<Vec3>& u, std::vector<Vec3>& force, FaceVector& q) const
    {
        const Vec3 x = parts.contact.position(e, parts.state.x);
        const auto [gathered, missing] = gradientsAt(p, x);
        const Vec3 mean = parts.contact.mean(e, u);
        std::array<Vec3, 3> corners = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 3; ++k)
            if (parts.contact.corners(e)[k] >= 0) corners[k] = u[parts.contact.corners(e)[k]];
        const PlainPush push = changeOf(parts.contact, e, gathered - mean.asDiagonal() * missing, corners);
        forEachSlope(x, [&](const Face& f, const Vec3& z) { of(q, f) += kStep * kStep * push.onGrid.row(f.axis).dot(z); });
        const Vec3 onMean = -push.onGrid.cwiseProduct(missing).rowwise().sum();
        for (int k = 0; k < 3; ++k)
            if (parts.contact.corners(e)[k] >= 0) force[parts.contact.corners(e)[k]] += push.nodalResponse[k] + parts.contact.shares(e)[k] * onMean;
    }

    struct Face {
        int axis, block, cell;
        Vec3 x;
    };
    static double& of(FaceVector& u, const Face& f) { return u.faces.block(f.block, f.axis)[f.cell]; }
    static double of(const FaceVector& u, const Face& f) { return u.faces.block(f.block, f.axis)[f.cell]; }

    GridParts& parts;
    const BlockGrid& grid;
    std::vector<Face> faces;
};

std::vector<FabricPiece> allKinds() { return {weave(6, 1.0e3), cloth(6, Vec3(0.1, 0.5, 0.2))}; }

/// Some elements pressed, some not; some reach faces without mass.
void assemble(GridParts& parts)
{
    Noise noise(4);
    for (Vec3& x : parts.state.x) x += 0.03 * noise.vector();
    parts.stiffness.rods().transportFrames(parts.state);
    parts.state.gridSolver.across = parts.contact.unstrained(parts.state);
    press(parts.state, 0.05, 1, 0.1);
    parts.assemble(kStep);
}

TEST(GridFabricProduct, EqualsPlainLoops)
{
    GridParts parts(allKinds(), gridSettings(TransferMethod::PolyPic));
    assemble(parts);
    ASSERT_GT(parts.contact.active().size(), parts.contact.size() / 4);
    ASSERT_LT(parts.contact.active().size(), parts.contact.size());
    const PlainSystem plain(parts);
    const FaceVector p = parts.randomVector(5), expected = plain.times(p);
    FaceVector found;
    found.resize(parts.system.blocks(), parts.system.edges());
    parts.system.multiply(p, found);
    const double size = std::sqrt(GridParts::dot(expected, expected));
    for (const PlainSystem::Face& f : plain.faces) ASSERT_NEAR(PlainSystem::of(found, f), PlainSystem::of(expected, f), 1e-12 * size);
    for (std::size_t e = 0; e < parts.system.edges(); ++e) ASSERT_NEAR(found.twist[e], expected.twist[e], 1e-12 * size);
}

TEST(GridFabricProduct, SolutionSatisfiesTheEquations)
{
    GridParts parts(allKinds(), gridSettings(TransferMethod::PolyPic));
    assemble(parts);
    const FaceVector start = parts.randomVector(6);
    FaceVector exact = start, impulses, product;
    constexpr double kExact = 1.0e-10, kTolerance = 1.0e-4;  // cm/s
    parts.system.solve(within(kExact, 1000), exact);
    product.resize(parts.system.blocks(), parts.system.edges());
    parts.system.multiply(exact, product);
    parts.system.impulses(impulses);
    const double* mass = parts.system.mass().block(0);
    const double heaviest = *std::max_element(mass, mass + exact.faces.size());
    for (std::size_t i = 0; i < exact.faces.size(); ++i) {
        if (!(mass[i] > 0.0)) continue;
        const double wanted = mass[i] * start.faces.block(0)[i] + impulses.faces.block(0)[i];
        ASSERT_NEAR(product.faces.block(0)[i], wanted, 10.0 * kExact * heaviest);
    }
    for (std::size_t e = 0; e < parts.system.edges(); ++e) {
        const double wanted = parts.fabric.edges.twistInertia[e] * start.twist[e] + impulses.twist[e];
        ASSERT_NEAR(product.twist[e], wanted, 1e-9 * std::abs(wanted)) << "edge " << e;
    }

    FaceVector v = start;
    const FaceSolveReport report = parts.system.solve(within(kTolerance, 1000), v);
    EXPECT_LE(report.speedError, kTolerance);
    const double error = parts.error(v, exact);
    EXPECT_LE(error, report.speedError);        // it is no less than it says …
    EXPECT_GE(error, 0.2 * report.speedError);  // … and not by far
}

/// A solve that starts along a change starts no farther away than without, and at the solution where it is a part of
/// what leads there.
TEST(GridFabricProduct, StartsAsFarAlongAChangeAsHelps)
{
    GridParts parts(allKinds(), gridSettings(TransferMethod::PolyPic));
    assemble(parts);
    const FaceVector start = parts.randomVector(6);
    FaceVector exact = start;
    parts.system.solve(within(1.0e-10, 1000), exact);
    const auto errorAlong = [&](const FaceVector* change, int iterations) {
        FaceVector v = start;
        parts.system.solve(within(0.0, iterations), v, change ? &change->faces : nullptr);
        return parts.error(v, exact);
    };
    const double without = errorAlong(nullptr, 0);
    FaceVector other = parts.randomVector(9);
    const double along = errorAlong(&other, 0);
    EXPECT_LT(along, without);
    for (std::size_t f = 0; f < other.faces.size(); ++f)
        if (!(parts.system.mass().block(0)[f] > 0.0)) other.faces.block(0)[f] = 1.0;  // the fabric has left it
    FaceVector v = start;
    parts.system.solve(within(0.0, 0), v, &other.faces);
    EXPECT_EQ(parts.error(v, exact), along);
    for (std::size_t f = 0; f < v.faces.size(); ++f) {
        const bool hasMass = parts.system.mass().block(0)[f] > 0.0;
        ASSERT_TRUE(hasMass || v.faces.block(0)[f] == 0.0) << "face " << f;
    }
    FaceVector change = exact;
    for (std::size_t f = 0; f < change.faces.size(); ++f) change.faces.block(0)[f] = 0.3 * (exact.faces.block(0)[f] - start.faces.block(0)[f]);
    EXPECT_LT(errorAlong(&change, 0), 1.0e-8 * without);
    for (std::size_t f = 0; f < change.faces.size(); ++f) change.faces.block(0)[f] = 0.0;
    EXPECT_EQ(errorAlong(&change, 5), errorAlong(nullptr, 5));
}

/// Largest eigenvalue of M⁻¹ A by the power method.
double largestEigenvalue(GridParts& parts)
{
    FaceVector p = parts.randomVector(7), q;
    q.resize(parts.system.blocks(), parts.system.edges());
    const double* mass = parts.system.mass().block(0);
    double largest = 0.0;
    for (int i = 0; i < 100; ++i) {
        parts.system.multiply(p, q);
        double inertia = 0.0;
        for (std::size_t f = 0; f < p.faces.size(); ++f) inertia += mass[f] * std::pow(p.faces.block(0)[f], 2);
        largest = GridParts::dot(p, q) / inertia;
        for (std::size_t f = 0; f < p.faces.size(); ++f) p.faces.block(0)[f] = mass[f] > 0.0 ? q.faces.block(0)[f] / (mass[f] * largest) : 0.0;
    }
    return largest;
}

/// The eigenvalues of M⁻¹ A begin at 1, however cloth is crumpled: from 1 to λ conjugate gradients take at least
/// (√λ − 1) / (√λ + 1) of the error in each iteration.
TEST(GridFabricProduct, CrumpledClothIsSolvedAsFastAsItsMassesAllow)
{
    GridParts parts({cloth(12)}, gridSettings(TransferMethod::PolyPic));
    Noise noise(4);
    for (Vec3& x : parts.state.x) x += 0.05 * noise.vector();
    parts.state.gridSolver.across = parts.contact.unstrained(parts.state);
    parts.assemble(kStep);
    const FaceVector start = parts.randomVector(6);
    FaceVector exact = start;
    parts.system.solve(within(1.0e-10, 2000), exact);
    const double first = parts.error(start, exact), root = std::sqrt(largestEigenvalue(parts));
    ASSERT_GT(root, 5.0);

    constexpr double kTolerance = 1.0e-3;  // cm/s
    FaceVector v = start;
    const FaceSolveReport report = parts.system.solve(within(kTolerance, 1000), v);
    const double most = std::log(0.5 * kTolerance / first) / std::log((root - 1.0) / (root + 1.0));
    EXPECT_LE(report.iterations, std::ceil(most));
    EXPECT_LE(report.speedError, kTolerance);
}

/// Yarns whose segments are three cells long press on faces between their vertices, which these reach by next to nothing. However little mass such
/// faces have, the eigenvalues stay where round-off cannot make one of them negative, and a system with others beside is solved.
TEST(GridFabricProduct, FacesOfNextToNoMassDoNoHarm)
{
    constexpr double kTolerance = 1.0e-3, kLongStep = 3.0e-3;  // cm/s, s
    constexpr double kMost = 1.0e13;  // what the stiffness of these yarns' contact is over a billionth of their vertices' mass
    Noise noise(8);
    for (int n = 0; n < 40; ++n) {
        const double reach = std::pow(10.0, -1.0 - 0.2 * n);  // of the vertices, into the face's cell, in cells
        FabricGeometry yarn;
        Vec3 middle = kCell * (Vec3::Constant(0.5) + 0.4 * noise.vector());
        middle[n % 3] = kCell;
        Vec3 along = Vec3::Zero();
        along[n % 3] = (1.5 - reach) * kCell;
        yarn.points = {middle - along, middle + along, middle + 3.0 * along};
        yarn.strands = {{0, 1, 2}};
        FabricPiece piece = pieceOf(yarn, wool(), {0.03, 0.03});
        piece.material.young = 5.0e8;
        piece.material.density = 0.1;
        GridParts parts({piece}, gridSettings(TransferMethod::PolyPic));
        press(parts.state, 0.2, n, 0.1);
        parts.assemble(kLongStep);
        EXPECT_LT(largestEigenvalue(parts), kMost) << "state " << n << ", reach " << reach;
        FaceVector v = parts.randomVector(n);
        const FaceSolveReport report = parts.system.solve(within(kTolerance, 1000), v);
        EXPECT_LE(report.speedError, kTolerance) << "state " << n << ", reach " << reach << ", after " << report.iterations << " iterations";
    }
}

}  // namespace
}  // namespace sim::testing
