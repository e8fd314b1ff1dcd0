// The fabric's keep factors as rates: what they take per second is the same for steps of any length.
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>

namespace sim::testing {
namespace {

constexpr double kTime = 6.4e-3, kShortest = 1.0e-4;  // [s]

/// A sheet so soft that it goes on as it is pushed.
FabricPiece softSheet()
{
    FabricPiece piece = cloth(17, Vec3(-8 * 0.144, 0.0, -8 * 0.144));
    piece.material.young = 1.0e-3;
    return piece;
}

/// Part of the velocities u(x) that is in the sheet.
template <class U>
double partOf(const GridRun& run, U&& u)
{
    double product = 0.0, square = 0.0;
    for (std::size_t v = 0; v < run.state.x.size(); ++v) {
        const Vec3 was = u(run.fabric.rest[v]);
        product += run.fabric.mass[v] * was.dot(run.state.v[v]);
        square += run.fabric.mass[v] * was.squaredNorm();
    }
    return product / square;
}

/// Rate at which velocities u(x) decay over kTime, after a step that scatters modes which no factor has acted on yet
/// [1/s].
template <class U>
double decayRate(const FabricTransferSettings& transfer, double h, U&& u)
{
    Settings settings = gridSettings(TransferMethod::Apic);
    settings.fabricTransfer = transfer;
    settings.transfer.dampingDt = kShortest;
    GridRun run({softSheet()}, settings);
    for (std::size_t v = 0; v < run.state.x.size(); ++v) run.state.v[v] = u(run.state.x[v]);
    run.step(h);
    const double start = partOf(run, u);
    const int steps = static_cast<int>(std::lround(kTime / h));
    for (int n = 0; n < steps; ++n) run.step(h);
    return std::log(start / partOf(run, u)) / kTime;
}

/// @param damping  the one in question
template <class U>
void expectRate(double FabricTransferSettings::*damping, U&& u)
{
    FabricTransferSettings undamped, damped;
    undamped.method = damped.method = TransferMethod::Apic;
    damped.*damping = 0.01;
    const auto extra = [&](double h) { return decayRate(damped, h, u) - decayRate(undamped, h, u); };
    const double first = extra(kShortest);
    std::printf("adds %.3e 1/s", first);
    EXPECT_GT(first, 1.0e-3);
    for (const double times : {2.0, 4.0, 8.0}) {
        const double now = extra(times * kShortest);
        std::printf(", %+.1f %%", 100.0 * (now / first - 1.0));
        EXPECT_NEAR(now, first, 0.1 * first) << "steps " << times << " times as long";
    }
    std::printf("\n");
}

TEST(GridFabricDamping, OfRotationDoesNotDependOnTheStep)
{
    expectRate(&FabricTransferSettings::rotationDamping, [](const Vec3& x) { return Vec3(-x.z(), 0.0, x.x()); });
}

TEST(GridFabricDamping, OfStretchDoesNotDependOnTheStep)
{
    expectRate(&FabricTransferSettings::stretchDamping, [](const Vec3& x) { return Vec3(x.x(), 0.0, -x.z()); });
}

TEST(GridFabricDamping, OfVelocityDoesNotDependOnTheStep)
{
    expectRate(&FabricTransferSettings::velocityDamping, [](const Vec3& x) { return Vec3(-x.z(), 0.0, x.x()); });
}

}  // namespace
}  // namespace sim::testing
