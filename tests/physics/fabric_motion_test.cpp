#include "tests/physics/fabric_runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

// What moving fabric keeps, loses and repeats (fabric/vertex/README.md, The step in vertices).

namespace sim::test {
namespace {

using testing::pieceOf;

/// One edge that swings along itself, damped: the exact recursion of backward Euler (fabric/rods/README.md, Damping).
TEST(YarnEdge, DampsAsBackwardEulerOfAKelvinVoigtSpring)
{
    constexpr double kLength = 0.5, h = 1.0e-4;
    FabricPiece piece = pieceOf(strand(Vec3::Zero(), Vec3(kLength, 0.0, 0.0), 1), testing::wool(), {0.05, 0.05});
    piece.material.dampingViscosity = 2.0e2;
    FabricSettings settings = withoutContact();
    settings.tolerance = 1.0e-12;
    FabricRun run(piece, settings);
    run.gravity.setZero();
    run.state.v = {Vec3(-1.0, 0.0, 0.0), Vec3(1.0, 0.0, 0.0)};
    const FabricMaterial& m = piece.material;
    const double area = kPi * 0.05 * 0.05, stiffness = m.packing() * m.young * area / kLength;
    const double viscous = 3.0 * m.dampingViscosity * area * m.packing() / kLength, mass = 0.5 * run.fabric.mass[0];
    double u = 0.0, v = 2.0, worst = 0.0;  // lengthening and its rate; mass: of the two against each other
    const double energy = 0.5 * mass * v * v;
    run.solver.bookEnergy();
    for (int i = 0; i < 200; ++i) {
        EnergyChanges changes = *run.step(h).energyChanges;
        const double before = v;
        v = (v - h * stiffness * u / mass) / (1.0 + h * viscous / mass + h * h * stiffness / mass);
        u += h * v;
        EXPECT_NEAR(changes[EnergyChange::Damping], -h * viscous * v * v, 1.0e-9 * energy) << "step " << i;
        EXPECT_NEAR(changes[EnergyChange::Implicit], -0.5 * mass * std::pow(v - before, 2) - 0.5 * stiffness * h * h * v * v, 1.0e-9 * energy);
        worst = std::max(worst, std::abs(run.state.x[1].x() - run.state.x[0].x() - kLength - u));
        EXPECT_NEAR(run.state.v[1].x() - run.state.v[0].x(), v, 2.0e-10) << "step " << i;
    }
    EXPECT_LT(worst, 1.0e-13);  // round-off of positions of about 1
    RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
}

/// A weave and a sheet of cloth, both with a random motion, that fly into each other.
struct Collision {
    std::vector<FabricPiece> pieces;

    explicit Collision(double speed = 100.0)
    {
        WovenYarns yarns;
        yarns.yarns = Vec2i(8, 8);
        yarns.spacing = 0.144;
        yarns.amplitude = 0.072;
        pieces.push_back(pieceOf(wovenYarns(yarns), testing::wool(), {0.048, 0.048}));
        ClothGrid grid;
        grid.nodes = Vec2i(10, 9);
        grid.spacing = {0.12, 0.12};
        grid.origin = Vec3(-0.05, 0.22, 0.1);
        pieces.push_back(pieceOf(clothGrid(grid), testing::wool(), {0.02, 0.02}));
        pieces[1].velocity = Vec3(10.0, -speed, 5.0);
    }
};

void stir(FabricRun& run, double speed)
{
    testing::Noise noise(11);
    for (Vec3& v : run.state.v) v += speed * noise.vector();
}

TEST(FlyingFabric, KeepsItsMomentumThroughContact)
{
    FabricSettings settings;
    settings.tolerance = 1.0e-13;
    FabricRun run(Collision().pieces, settings);
    run.gravity.setZero();
    stir(run, 5.0);
    double scale = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < run.state.v.size(); ++i) scale += run.fabric.mass[i] * run.state.v[i].norm();
    const Vec3 spin = run.angularMomentum();
    std::size_t contacts = 0;
    int globalScalings = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3 before = run.momentum();
        // A fifth of the usual step: with it conjugate gradients come as far as this within their 300 iterations.
        const FabricReport report = run.step(2.0e-4);
        contacts = std::max(contacts, report.contacts);
        globalScalings += report.globalScalings;
        worst = std::max(worst, (run.momentum() - before).norm() / scale);
    }
    EXPECT_GT(contacts, 20u);
    EXPECT_EQ(globalScalings, 0);
    EXPECT_LT(worst, 1.0e-12);
    RecordProperty("worst", std::to_string(worst * 1.0e15) + "e-15");
    RecordProperty("angular", std::to_string((run.angularMomentum() - spin).norm() / spin.norm()));
}

/// The solver remembers those of the last state: any other is found anew.
TEST(FlyingFabric, EnergiesAreThoseOfTheStateThatIsAskedAbout)
{
    FabricRun run(Collision().pieces, {});
    std::vector<FabricState> states = {run.state};
    for (int i = 0; i < 5; ++i) {
        run.step(2.0e-3);
        states.push_back(run.state);
        FabricState twisted = run.state;
        twisted.theta[i] += 0.3;
        states.push_back(twisted);
        twisted.v[i] *= 2.0;
        states.push_back(twisted);
    }
    for (const std::size_t n : {3u, 3u, 4u, 5u, 0u, 4u, 9u, 1u, 2u}) {
        const FabricEnergies found = run.solver.energies(states[n], run.gravity);
        const FabricEnergies fresh = VertexSolver(run.fabric, {}, {}).energies(states[n], run.gravity);
        EXPECT_EQ(found.total(), fresh.total()) << n;
        EXPECT_EQ(found.elastic(), fresh.elastic()) << n;
    }
    EXPECT_NE(run.solver.energies(states[1], run.gravity).twisting, run.solver.energies(states[2], run.gravity).twisting);
}

/// What the budget names is what the energy changes by (sim/README.md, Energy), up to how well the steps are solved.
TEST(FlyingFabric, EnergyGoesWhereTheBudgetSays)
{
    std::vector<FabricPiece> pieces = Collision().pieces;
    for (FabricPiece& piece : pieces) piece.material.dampingViscosity = 1.0e3;
    Motion lift;
    lift.addTranslation(0.0, 1.0, Vec3(0.0, 20.0, 0.0), 0.0, 0.0);
    pieces[1].pins = {pinned({0, 9}, true, lift)};
    FabricSettings settings;
    settings.tolerance = 1.0e-6;
    FabricRun run(pieces, settings);
    run.solver.bookEnergy();
    const double start = run.energies().total(), kinetic = run.energies().kinetic;
    EnergyChanges all;
    for (int i = 0; i < 100; ++i) all += *run.step(2.0e-4).energyChanges;
    const double unbooked = run.energies().total() - start - std::accumulate(all.of.begin(), all.of.end(), 0.0);
    EXPECT_LT(std::abs(unbooked), 5.0e-3 * kinetic);  // two Newton iterations: 1.4e-3; six: 8e-6
    for (EnergyChange loss : {EnergyChange::Implicit, EnergyChange::Damping, EnergyChange::Friction}) EXPECT_LT(all[loss], -0.01 * kinetic);
    EXPECT_GT(all[EnergyChange::Pins], 0.01 * kinetic);
}

TEST(FlyingFabric, FallsExactlyAsAPointWould)
{
    ClothGrid grid;
    grid.nodes = Vec2i(12, 12);
    grid.spacing = {0.1, 0.1};
    FabricPiece piece = pieceOf(clothGrid(grid), testing::wool(), {0.02, 0.02});
    piece.velocity = Vec3(0.0, -300.0, 0.0);
    FabricRun run(piece, FabricSettings{});
    Vec3 x = Vec3::Zero(), v = piece.velocity;
    for (int i = 0; i < 100; ++i) {
        run.step(1.0e-3);
        v += 1.0e-3 * run.gravity;
        x += 1.0e-3 * v;
    }
    double worst = 0.0;
    for (std::size_t i = 0; i < run.state.x.size(); ++i) worst = std::max(worst, (run.state.x[i] - run.fabric.rest[i] - x).norm());
    // Solves leave errors of 4 roundings of a place in a step, 4 eps |x| = 3e-14 cm; were they all of one sign, n^2 / 2 of them would add up in n steps.
    EXPECT_LT(worst, 1.5e-10);
    RecordProperty("worst", std::to_string(worst * 1e15) + "e-15");
}

/// Undamped, backward Euler only ever loses energy, and half of it with half the step.
double lossOf(const FabricPiece& piece, double h, double duration, bool& onlyFalls)
{
    FabricSettings settings = withoutContact();
    settings.tolerance = 1.0e-8;
    FabricRun run(piece, settings);
    const Vec3 middle = 0.5 * (run.fabric.rest.front() + run.fabric.rest.back());
    for (std::size_t i = 0; i < run.state.v.size(); ++i) {  // smooth, so that small steps follow it
        const Vec3 x = run.fabric.rest[i] - middle;
        run.state.v[i] = 30.0 * Vec3(std::sin(2.0 * x.z()), std::cos(1.5 * x.x()), 0.3 * x.x());
    }
    const double start = run.energies().total() - run.energies().potential;
    double before = run.energies().total(), first = before;
    const int steps = static_cast<int>(std::lround(duration / h));
    for (int i = 0; i < steps; ++i) {
        run.step(h);
        const double now = run.energies().total();
        if (now > before + 1.0e-9 * start) onlyFalls = false;
        before = now;
    }
    // Gravity's share is known: a falling point loses ½ m g² h t as well, which is no loss of fabric but of the scheme;
    // taken out.
    double mass = 0.0;
    for (double m : run.fabric.mass) mass += m;
    return (first - before - 0.5 * mass * run.gravity.squaredNorm() * h * duration) / start;
}

TEST(FlyingFabric, LosesEnergyOnlyToTheStepAndInProportionToIt)
{
    ClothGrid grid;
    grid.nodes = Vec2i(9, 9);
    grid.spacing = {0.25, 0.25};
    FabricMaterial soft = solidFibre(3.0e4, 0.3);
    for (const FabricPiece& piece :
         {pieceOf(clothGrid(grid), soft, {0.05, 0.05}), pieceOf(strand(Vec3::Zero(), Vec3(2.0, 0.0, 0.5), 12), soft, {0.1, 0.1})}) {
        bool onlyFalls = true;
        std::vector<double> loss;
        for (double h : {4.0e-5, 2.0e-5, 1.0e-5}) loss.push_back(lossOf(piece, h, 0.02, onlyFalls));
        EXPECT_TRUE(onlyFalls);
        EXPECT_NEAR(loss[0] / loss[1], 2.0, 0.2);
        EXPECT_NEAR(loss[1] / loss[2], 2.0, 0.1);
        RecordProperty(piece.faces.empty() ? "yarn" : "cloth",
                       std::to_string(loss[0]) + " " + std::to_string(loss[1]) + " " + std::to_string(loss[2]));
    }
}

bool sameBits(const FabricState& a, const FabricState& b)
{
    const auto same = [](const auto& u, const auto& v) {
        return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof(u[0])) == 0;
    };
    return same(a.x, b.x) && same(a.v, b.v) && same(a.theta, b.theta) && same(a.omega, b.omega) && same(a.tangent, b.tangent) &&
           same(a.reference, b.reference) && same(a.referenceTwist, b.referenceTwist);
}

std::vector<ObstacleSettings> ballBelow()
{
    ObstacleSettings ball;
    ball.name = "ball";
    ball.shape = Shape::ball(Vec3(0.5, -0.7, 0.5), 0.5);
    return {ball};
}

TEST(FlyingFabric, SameBitsForAnyThreadCount)
{
    const auto after = [&] {
        FabricRun run(Collision(300.0).pieces, FabricSettings{}, ballBelow());
        stir(run, 20.0);
        run.steps(15, 1.0e-3);
        return run.state;
    };
    const FabricState one = onThreads(1, after);
    EXPECT_TRUE(sameBits(one, onThreads(2, after)));
    EXPECT_TRUE(sameBits(one, onThreads(8, after)));
}

TEST(FlyingFabric, StateAloneDecidesWhatFollows)
{
    const std::vector<FabricPiece> pieces = Collision(300.0).pieces;
    FabricRun run(pieces, FabricSettings{}, ballBelow());
    stir(run, 20.0);
    for (int start : {3, 8, 14}) {
        while (run.time < (start - 0.5) * 1.0e-3) run.step(1.0e-3);
        FabricRun resumed(pieces, FabricSettings{}, ballBelow());
        resumed.state = run.state;
        resumed.time = run.time;
        for (int i = 0; i < 5; ++i) {
            run.step(1.0e-3);
            resumed.step(1.0e-3);
            ASSERT_TRUE(sameBits(run.state, resumed.state)) << "step " << i << " after " << start;
        }
    }
}

}  // namespace
}  // namespace sim::test
