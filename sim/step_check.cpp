#include "sim/step_check.h"

#include "sim/core/parallel.h"
#include "sim/liquid/surface_tension.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sim {

namespace {

constexpr double kLostLiquid = 1.0e-9;  ///< share of all liquid that may be lost: a thousand times what rounding does in the longest runs [-]
constexpr double kSurprise = 2.0;       ///< ratio by which speeds may turn out higher than the step was chosen for [-]
constexpr double kEnergyGain = 0.05;    ///< share of the energy that may be gained: three times what the splash scenes gain at their starts [-]
constexpr double kQuiet = 0.01;         ///< energy counts from where it moves everything this far in a step [cells]
constexpr double kDepth = 0.25;         ///< how far the middle of fabric may get into an obstacle, or by its own radius [cells]

/// Energy of motion and elasticity [erg].
double activeEnergy(const Energies& e) { return e.kinetic + e.modal + e.fabric.kinetic + e.fabric.internal(); }

struct Fastest {
    std::size_t index = 0;
    double speed = -1.0;  ///< [cm/s]
};

/// The first one whose speed is not finite, or else the fastest.
template <class SpeedOf>
Fastest fastest(std::size_t count, SpeedOf&& speedOf)
{
    Fastest found;
    for (std::size_t i = 0; i < count; ++i) {
        const double speed = speedOf(i);
        if (!std::isfinite(speed)) return {i, speed};
        if (speed > found.speed) found = {i, speed};
    }
    return found;
}

std::string placeAndSpeed(const Vec3& x, double speed)
{
    return fmt::format("at ({:.4g}, {:.4g}, {:.4g}) cm with {:.3g} cm/s", x.x(), x.y(), x.z(), speed);
}

/// Corners of a box around all blocks of the liquid and all vertices; the origin where there is neither [cm].
std::array<Vec3, 8> cornersAround(const State& state)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& x : state.fabric.x) box.extend(x);
    for (int b = 0; b < state.grid.count(); ++b) {
        const Vec3 corner = state.grid.lowerCorner(b);
        box.extend(corner).extend(corner + Vec3::Constant(kBlockEdge * state.grid.dx));
    }
    std::array<Vec3, 8> corners;
    corners.fill(Vec3::Zero());
    if (box.isEmpty()) return corners;
    for (int c = 0; c < 8; ++c) corners[c] = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
    return corners;
}

}  // namespace

StepCheck::StepCheck(const Scene& scene, const Fabric& fabric)
    : scene_(scene), fabric_(fabric), fabricMass_(std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0))
{
    if (!fabric.radius.empty()) radius_ = std::ranges::max(fabric.radius);
}

void StepCheck::start(const Energies& energies, StepHistory& memory)
{
    memory.energies.fill(activeEnergy(energies));
    memory.internal = energies.fabric.internal();
    memory.deepest = StepHistory().deepest;
}

void StepCheck::accept(const StepReport& report, StepHistory& memory)
{
    memory.energies[memory.next] = activeEnergy(report.energies);
    memory.next = (memory.next + 1) % static_cast<int>(memory.energies.size());
    memory.internal = report.energies.fabric.internal();
    memory.deepest = report.fabric.deepest;
}

std::string StepCheck::fastestParticle(const State& state) const
{
    const LiquidParticles& liquid = state.liquid;
    if (liquid.count == 0) return "no particle";
    const Fastest f = fastest(liquid.count, [&](std::size_t p) { return (liquid.velocity(p) + 0.0 * liquid.position(p)).norm(); });
    return fmt::format("particle {} {}", liquid.id[f.index], placeAndSpeed(liquid.position(f.index), f.speed));
}

/// "vertex 12 of sheet": as a scene counts them.
std::string StepCheck::nameOf(std::size_t vertex) const
{
    std::size_t begin = 0;
    for (const FabricPiece& piece : scene_.fabrics) {
        if (vertex < begin + piece.points.size()) return fmt::format("vertex {} of {}", piece.called(static_cast<int>(vertex - begin)), piece.name);
        begin += piece.points.size();
    }
    return fmt::format("vertex {}", vertex);
}

std::string StepCheck::fastestVertex(const State& state) const
{
    const FabricState& fabric = state.fabric;
    if (fabric.x.empty()) return "no vertex";
    const Fastest f = fastest(fabric.x.size(), [&](std::size_t v) { return (fabric.v[v] + 0.0 * fabric.x[v]).norm(); });
    return fmt::format("{} {}", nameOf(f.index), placeAndSpeed(fabric.x[f.index], f.speed));
}

/// What makes explosions less likely.
std::string StepCheck::remedyFor(bool isFabrics) const
{
    const Settings& settings = scene_.settings;
    if (settings.time.mode != TimeMode::Adaptive) return "time.mode: adaptive, or a smaller time.dt";
    if (isFabrics) return "softer or heavier fabric, or slower motions";
    return settings.transfer.xi != XiMap::Translation ? "transfer.xi: translation" : "fewer transfer.modes, or a smaller time.cfl";
}

std::optional<StepFailure> StepCheck::violatedInvariant(const State& state, const StepReport& report) const
{
    if (!report.failure.empty()) {
        const bool isFabrics = report.failedStage == Stage::FabricSolve;
        return StepFailure{report.failedStage, fmt::format("{}: {}", report.failure, isFabrics ? fastestVertex(state) : fastestParticle(state)),
                           remedyFor(isFabrics)};
    }
    const Ledger& ledger = state.ledger;
    const double missing = ledger.emittedMass - ledger.leftMass - report.liquidMass - report.absorbedMass;
    if (std::abs(missing) > kLostLiquid * ledger.emittedMass)
        return StepFailure{Stage::Capture, fmt::format("{:.3g} g of {:.6g} g of liquid are not accounted for", missing, ledger.emittedMass),
                           "nothing in the scene: this is a mistake of the program"};
    return std::nullopt;
}

std::optional<StepFailure> StepCheck::rejectionReason(const State& state, const StepReport& report) const
{
    if (auto fault = cflExceeded(state, report)) return fault;
    if (auto fault = penetrationTooDeep(state, report)) return fault;
    return energyGrowth(state, report);
}

std::optional<StepFailure> StepCheck::cflExceeded(const State& state, const StepReport& report) const
{
    const TimeSettings& time = scene_.settings.time;
    const double cells = hasLiquid(state) ? report.dt * report.maxSpeed / scene_.settings.cell : 0.0;
    const double bound = kSurprise * std::min(time.cfl, time.maxCflLiquid);
    if (cells <= bound) return std::nullopt;
    return StepFailure{Stage::GridToParticles,
                       fmt::format("liquid crossed {:.3g} cells in the step, more than {:.3g}: {}", cells, bound, fastestParticle(state)),
                       "slower sources and obstacles, or a larger time.cfl"};
}

/// Fabric that is squeezed into an obstacle little by little gets there in short steps too; one that jumps there does not.
std::optional<StepFailure> StepCheck::penetrationTooDeep(const State& state, const StepReport& report) const
{
    const double depth = report.fabric.deepest - radius_, bound = std::max(radius_, kDepth * scene_.settings.cell);
    if (!(depth > bound && report.fabric.deepest > std::max(state.memory.deepest, 0.0) + bound)) return std::nullopt;
    return StepFailure{Stage::FabricContact, fmt::format("fabric got {:.3g} cm into an obstacle in one step, more than {:.3g}", depth, bound),
                       "slower motions, or a smaller time.dt"};
}

/// Largest speed of pins, and of moving obstacles where there is anything for them to push [cm/s].
double StepCheck::drivingSpeed(const State& state, const StepReport& report) const
{
    double speed = 0.0;
    for (const int v : fabric_.pins.vertex) speed = std::max(speed, state.fabric.v[v].norm());
    const double begin = state.time - report.dt;
    for (const ObstacleSettings& obstacle : scene_.obstacles) {
        if (!obstacle.motion.moves(begin, state.time)) continue;
        // Rigid motion is fastest at a corner of any box.
        for (const Vec3& x : cornersAround(state))
            for (const double t : {begin, state.time}) speed = std::max(speed, obstacle.motion.velocity(t, x).norm());
    }
    return speed;
}

/// Motion and elasticity may have what they had of late, what gravity does along the way, what sources, pins, obstacles and
/// surfaces give, and a little more.
double StepCheck::energyAllowed(const State& state, const StepReport& report) const
{
    const Settings& settings = scene_.settings;
    const Energies& e = report.energies;
    const double mass = report.liquidMass + report.absorbedMass + fabricMass_;
    const double kinetic = e.kinetic + e.modal + e.fabric.kinetic;
    double given = report.dt * settings.gravity.norm() * std::sqrt(2.0 * kinetic * mass);  // Cauchy and Schwarz
    const double speed = drivingSpeed(state, report);
    if (speed > 0.0)
        given += 2.0 * mass * speed * speed + std::max(0.0, e.fabric.internal() - state.memory.internal);  // thrown off at twice the speed
    if (feelsSurfaceTension(settings.liquid))
        given += settings.liquid.surfaceTension * settings.cell * settings.cell * static_cast<double>(report.liquidCells);
    const double quiet = kQuiet * settings.cell / report.dt;
    return (1.0 + kEnergyGain) * std::ranges::max(state.memory.energies) + report.emittedKinetic + std::max(0.0, report.inflowWork) + given +
           0.5 * mass * quiet * quiet;
}

std::optional<StepFailure> StepCheck::energyGrowth(const State& state, const StepReport& report) const
{
    const double energy = activeEnergy(report.energies), allowed = energyAllowed(state, report);
    if (energy <= allowed) return std::nullopt;
    const Energies& e = report.energies;
    const bool isFabrics = e.fabric.kinetic + e.fabric.internal() > e.kinetic + e.modal;
    return StepFailure{isFabrics ? Stage::FabricSolve : Stage::GridToParticles,
                       fmt::format("energy of motion and elasticity came to {:.4g} erg, {:.3g} erg more than there was and was given: {}", energy,
                                   energy - allowed, isFabrics ? fastestVertex(state) : fastestParticle(state)),
                       remedyFor(isFabrics)};
}

}  // namespace sim
