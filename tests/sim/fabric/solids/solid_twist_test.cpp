// Yarns that spin about their axes while they meet a solid at rest (fabric/README.md, Solids).
#include "sim/core/units.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>

namespace sim::testing {
namespace {

constexpr double kCell = 0.25;

/// A straight round yarn above a plane, anywhere and turned in any way: it spins, is twisted, slides, and falls onto the plane.
struct SpinningYarn {
    /// @param isRandom  each vertex and each edge moves in a way of its own; else all of the yarn moves alike
    /// @param frame  the whole scene is turned and shifted by this
    SpinningYarn(unsigned seed, FabricSolver kind, bool isRandom, const Eigen::Isometry3d& frame = Eigen::Isometry3d::Identity())
    {
        Noise random(seed);
        const double noise = isRandom ? 1.0 : 0.0;
        const auto between = [&](double low, double high) { return low + 0.5 * (high - low) * (1.0 + random()); };
        radius = between(0.02, 0.05);
        h = std::pow(10.0, between(-4.0, -2.8));
        const int edges = static_cast<int>(between(4.0, 14.0));
        const double length = edges * between(3.0, 6.0) * radius;
        const Eigen::Isometry3d turn(Eigen::AngleAxisd(kPi * random(), random.vector().normalized()));
        const Eigen::Isometry3d place = frame * (Eigen::Translation3d(3.0 * random.vector()) * turn);
        FabricPiece piece = pieceOf(strand(Vec3(-0.5 * length, 0.0, 0.0), Vec3(0.5 * length, 0.0, 0.0), edges + 1), wool(), {radius, radius});
        piece.material.frictionAngle = between(0.1, 1.0);
        friction = std::tan(piece.material.frictionAngle);
        const double height = radius * between(1.36, 1.6), tilt = 0.2 * noise * radius / length * random();
        for (Vec3& x : piece.points) x = place * Vec3(x + Vec3(0.0, height + tilt * x.x(), 0.0));
        fabric = assembleFabric({&piece, 1});
        state = initialState(fabric, {&piece, 1});
        const Vec3 slide(100.0 * random(), -between(0.0, 60.0), 100.0 * random());
        for (Vec3& v : state.v) v = place.linear() * (slide + noise * 5.0 * random.vector());
        const double spin = kTurnOfStep / h * random();
        for (double& w : state.omega) w = spin + 0.3 * noise * kTurnOfStep / h * random();
        for (double& angle : state.theta) angle = 0.1 * noise * random();
        normal = place.linear() * Vec3::UnitY();
        gravity = -between(0.0, 2000.0) * normal;
        for (std::size_t e = 0; e < state.omega.size(); ++e) spins += fabric.edges.twistInertia[e] * std::abs(state.omega[e]);

        solid.shape = Shape::box({0.0, -1.0, 0.0}, {8.0, 1.0, 8.0}).moved(place);
        Settings settings;
        settings.cell = kCell;
        settings.fabric.solver = kind;
        settings.fabric.tolerance = 1.0e-6;
        settings.fabric.newton = 6;
        if (kind == FabricSolver::Grid) solver = std::make_unique<GridFabricSolver>(fabric, settings, std::span(&solid, 1));
        else solver = std::make_unique<VertexSolver>(fabric, settings.fabric, std::span(&solid, 1));
        forces.obstacles.resize(1), forces.fabrics.resize(1), forces.hardest.resize(1);
        solver->reportForces(forces);
    }
    void step()
    {
        StageTimes times;
        StageClock clock(times);
        forces.begin(h);
        contacts += solver->step(time, h, gravity, state, clock).obstacleContacts;
        time += h;
    }
    /// Angular momentum of the edges about their axes [g cm^2/s].
    double spin() const { return std::inner_product(state.omega.begin(), state.omega.end(), fabric.edges.twistInertia.begin(), 0.0); }
    FabricEnergies energies() const { return solver->energies(state, gravity); }
    /// Momentum along the plane, where nothing but friction acts [g cm/s].
    Vec3 slide() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += fabric.mass[v] * state.v[v];
        return sum - sum.dot(normal) * normal;
    }

    /// A step turns the yarn by no more than that, lest what twist and bending do to each other is not resolved [rad].
    static constexpr double kTurnOfStep = 0.1;

    double radius, friction, h, time = 0.0;  ///< [cm, -, s, s]
    double spins = 0.0;                      ///< sum of the edges' angular momenta at the start, whatever their sign [g cm^2/s]
    Fabric fabric;
    FabricState state;
    Vec3 gravity, normal;
    ObstacleSettings solid;
    std::unique_ptr<FabricIntegrator> solver;
    Forces forces;
    std::size_t contacts = 0;
};

constexpr std::array kSolvers = {FabricSolver::Vertex, FabricSolver::Grid};
constexpr unsigned kYarns = 120;
constexpr int kSteps = 20;
constexpr bool kRandom = true, kUniform = false;

/// Contact acts on a yarn's axis, so that all it gives comes through bending, which solver grid looks at once per step.
TEST(YarnsThatSpin, GetNoMoreTwistFromSolidsThanFrictionAtTheirSurfaceGives)
{
    for (const FabricSolver kind : kSolvers) {
        unsigned met = 0;
        for (unsigned seed = 1; seed <= kYarns; ++seed) {
            SpinningYarn run(seed, kind, kRandom);
            for (int i = 0; i < kSteps; ++i) {
                const double before = run.spin();
                run.step();
                const double byFriction = run.radius * run.friction * run.forces.obstacles[0].contact.linear.norm();
                EXPECT_LT(std::abs(run.spin() - before), byFriction + 3.0e-3 * run.spins)
                    << "solver " << int(kind) << " seed " << seed << " step " << i;
            }
            met += run.contacts > 0;
        }
        EXPECT_GT(met, kYarns * 9 / 10);
    }
}

TEST(YarnsThatSpin, SpinNoFasterForASolidAtRest)
{
    for (const FabricSolver kind : kSolvers)
        for (unsigned seed = 1; seed <= kYarns; ++seed) {
            SpinningYarn run(seed, kind, kRandom);
            const double most = std::abs(run.spin()) + (kind == FabricSolver::Vertex ? 5.0e-3 : 0.03) * run.spins;
            for (int i = 0; i < kSteps; ++i) {
                run.step();
                EXPECT_LT(std::abs(run.spin()), most) << "solver " << int(kind) << " seed " << seed << " step " << i;
            }
        }
}

/// Nothing bends a yarn that moves alike all over.
TEST(YarnsThatSpin, KeepTheirTwistWhereSolidsDoNotBendThem)
{
    for (const FabricSolver kind : kSolvers)
        for (unsigned seed = 1; seed <= kYarns; ++seed) {
            SpinningYarn run(seed, kind, kUniform);
            const double before = run.spin();
            for (int i = 0; i < kSteps; ++i) run.step();
            EXPECT_NEAR(run.spin() / before, 1.0, 1.0e-9) << "solver " << int(kind) << " seed " << seed;
        }
}

/// What friction has stopped gives back no more than what its springs hold, however hard the blow was that stopped it.
TEST(YarnsThatSpin, AreNotPushedOnByFriction)
{
    for (const FabricSolver kind : kSolvers)
        for (unsigned seed = 1; seed <= kYarns; ++seed) {
            SpinningYarn run(seed, kind, kUniform);
            const double start = run.slide().norm();
            for (int i = 0; i < kSteps; ++i) {
                const double before = run.slide().norm();
                run.step();
                EXPECT_LT(run.slide().norm() - before, 0.02 * start) << "solver " << int(kind) << " seed " << seed << " step " << i;
            }
        }
}

TEST(YarnsThatSpin, GetNoEnergyFromSolidsAtRest)
{
    for (const FabricSolver kind : kSolvers)
        for (unsigned seed = 1; seed <= kYarns; ++seed) {
            SpinningYarn run(seed, kind, kRandom);
            const double kinetic = run.energies().kinetic;
            for (int i = 0; i < kSteps; ++i) {
                const double before = run.energies().total();
                run.step();
                EXPECT_LT(run.energies().total() - before, 1.0e-3 * kinetic) << "solver " << int(kind) << " seed " << seed << " step " << i;
            }
        }
}

/// Turned and shifted so that it lies alike among the cells.
TEST(YarnsThatSpin, DoSoAlikeInEveryFrame)
{
    Mat3 turn;
    turn << 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    const Eigen::Isometry3d alike = Eigen::Translation3d(kCell * Vec3(8.0, -3.0, 5.0)) * Eigen::Isometry3d(Eigen::Quaterniond(turn)),
                            any = Eigen::Translation3d(1.3, -0.7, 2.1) * Eigen::Isometry3d(Eigen::AngleAxisd(0.8, Vec3(0.3, 0.9, -0.4).normalized()));
    for (const FabricSolver kind : kSolvers)
        for (unsigned seed = 1; seed <= kYarns / 4; ++seed) {
            const Eigen::Isometry3d& frame = kind == FabricSolver::Vertex ? any : alike;
            SpinningYarn run(seed, kind, kRandom), other(seed, kind, kRandom, frame);
            for (int i = 0; i < kSteps; ++i) run.step(), other.step();
            EXPECT_NEAR(run.spin(), other.spin(), 1.0e-6 * run.spins) << "solver " << int(kind) << " seed " << seed;
            for (std::size_t v = 0; v < run.state.x.size(); ++v)
                EXPECT_LT((frame * run.state.x[v] - other.state.x[v]).norm(), 1.0e-4 * run.radius) << "solver " << int(kind) << " seed " << seed;
        }
}

}  // namespace
}  // namespace sim::testing
