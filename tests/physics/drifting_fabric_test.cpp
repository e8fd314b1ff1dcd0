// What fabric gains from nothing is measured by its own motion: neither how fast all of it flies nor what is held beside it lets it gain more.
#include "sim/fabric/owed_energy.h"
#include "tests/physics/fabric_runs.h"
#include "tests/sim/fabric/grid/grid_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace sim::test {
namespace {

using testing::Noise;

constexpr double kFelt = 2.0e-3;                        // twice what counts as none in a step
constexpr double kRounding = 1.0e-9;                    // erg, of those of 1e4 cm/s
constexpr double kStruckStep = 2.5e-3, kSpacing = 0.1;  // s, cm

FabricPiece weaveOf(const Vec2i& yarns, bool hasBorders, const Vec3& origin)
{
    WovenYarns weave{.yarns = yarns, .spacing = kSpacing, .amplitude = 0.03};
    weave.borders = hasBorders;
    weave.origin = origin;
    FabricPiece piece = testing::pieceOf(wovenYarns(weave), testing::wool(), {0.025, 0.025});
    piece.material.young = 2.0e8;
    piece.material.density = 0.4;
    return piece;
}

/// Loose yarns that fly and a weave whose corner is held.
std::vector<FabricPiece> looseBesideHeld()
{
    std::vector<FabricPiece> pieces = {weaveOf(Vec2i(4, 10), true, Vec3(-3.0, 0.0, 0.0)), weaveOf(Vec2i(6, 10), false, Vec3(3.0, 0.0, 0.0))};
    pieces[0].pins = {pinned({0, 1})};
    return pieces;
}

/// Energy of pieces after the first but for that of their flight as a whole, piece by piece, and of all of the first [erg].
double ownEnergy(const Fabric& fabric, const FabricState& state, const FabricEnergies& energies)
{
    FabricGroups groups(fabric);
    return energies.total() - energies.kinetic + ownKinetic(fabric, groups, fabric.mass, state);
}

/// Sets the loose yarns in wild motion that has no momentum, and then all of them on their way together.
void strike(const Fabric& fabric, double flight, Noise& noise, FabricState& state)
{
    const double edges = 3.0 + 2.0 * noise();
    for (Vec3& v : state.v) v = edges * kSpacing / kStruckStep * noise.vector();
    const FabricGroups groups(fabric);
    const std::vector<Vec3> drift = groups.drifts(fabric.mass, state.v);
    const Vec3 together = flight * noise.vector().normalized();
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const int piece = groups.pieceOf(static_cast<int>(v));
        if (fabric.pinned[v]) state.v[v].setZero();
        else if (groups.freeGroupOf(piece) >= 0) state.v[v] += together - drift[piece];
        else state.v[v] *= 0.1;
    }
}

/// No step of a run, by either solver, leaves more energy of its own than it began with.
template <class Run>
void expectNoGain(Run& run, int steps)
{
    double before = ownEnergy(run.fabric, run.state, run.energies());
    for (int step = 0; step < steps; ++step) {
        run.step(kStruckStep);
        const double now = ownEnergy(run.fabric, run.state, run.energies());
        EXPECT_LT(now, (1.0 + kFelt) * before + kRounding) << "step " << step;
        before = now;
    }
}

TEST(DriftingFabric, GainsNothingOfItsOwnInItsVertices)
{
    for (const double flight : {0.0, 1.0e2, 1.0e4}) {
        Noise noise(5);
        for (int n = 0; n < 12; ++n) {
            FabricSettings settings;
            settings.contact = false;
            settings.newton = n % 3 == 0 ? 8 : 2;
            settings.maxHalvings = n % 4 == 3 ? 0 : 4;
            FabricRun run(looseBesideHeld(), settings);
            run.gravity = Vec3::Zero();
            strike(run.fabric, flight, noise, run.state);
            SCOPED_TRACE("flight " + std::to_string(flight) + ", state " + std::to_string(n));
            expectNoGain(run, 8);
        }
    }
}

TEST(DriftingFabric, GainsNothingOfItsOwnOnTheGrid)
{
    for (const double flight : {0.0, 1.0e2, 1.0e4}) {
        Noise noise(6);
        for (int n = 0; n < 12; ++n) {
            testing::GridRun run(looseBesideHeld(), testing::gridSettings(n % 4 < 2 ? TransferMethod::Apic : TransferMethod::PolyPic));
            strike(run.fabric, flight, noise, run.state);
            SCOPED_TRACE("flight " + std::to_string(flight) + ", state " + std::to_string(n));
            expectNoGain(run, 3);
        }
    }
}

}  // namespace
}  // namespace sim::test
