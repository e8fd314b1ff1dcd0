#include "app/backends.h"
#include "app/frames/sample_pressure.h"
#include "app/readings/measures.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace app {

namespace {

using sim::FormulaError, sim::Vec3;

/// Calls f(x) at places that lie evenly on a disc: each stands for the same area (Vogel 1979, A better way to construct the sunflower head).
template <class F>
void forEachPlace(const ControlSurface& disc, int count, F&& f)
{
    const Vec3 u = disc.normal.unitOrthogonal(), v = disc.normal.cross(u);
    constexpr double kGoldenAngle = std::numbers::pi * (3.0 - 2.2360679774997896964);  // 5 under the root
    for (int i = 0; i < count; ++i) {
        const double r = disc.radius * std::sqrt((i + 0.5) / count), angle = i * kGoldenAngle;
        f(Vec3(disc.center + r * (std::cos(angle) * u + std::sin(angle) * v)));
    }
}

/// Mean pressure on a disc in the last step [dyn/cm^2].
double pressureOn(const ControlSurface& disc, const SimulationHandle& simulation)
{
    constexpr int kPlaces = 32;
    const sim::State& state = simulation.state();
    double sum = 0.0;
    forEachPlace(disc, kPlaces, [&](const Vec3& x) { sum += smoothPressure(state, x); });
    return sum / kPlaces;
}

}  // namespace

void Measures::sumPressures()
{
    if (discs_.empty()) return;
    PressureTotals& totals = interval_.pressures;
    totals.sums.resize(discs_.size(), 0.0);
    const double dt = simulation_->state().lastDt;
    totals.time += dt;
    std::size_t n = 0;
    for (const std::string& name : discs_) totals.sums[n++] += dt * pressureOn(controlSurfaces_.at(name).at(simulation_->state().time), *simulation_);
}

double Measures::meanPressureOn(const std::string& name)
{
    const auto surface = controlSurfaces_.find(name);
    if (surface == controlSurfaces_.end()) throw FormulaError(fmt::format("there is no control surface \"{}\"", name));
    if (!std::isfinite(surface->second.radius))
        throw FormulaError(fmt::format("the control surface \"{}\" has no radius: a pressure is the mean over a disc", name));
    discs_.insert(name);
    const PressureTotals& totals = interval_.pressures;
    const auto number = static_cast<std::size_t>(std::distance(discs_.begin(), discs_.find(name)));
    return totals.time > 0.0 && number < totals.sums.size() ? totals.sums[number] / totals.time : valueBeforeSteps();
}

sim::FormulaNames::OfName Measures::pressures()
{
    return {"pressure_on", [this](const std::string& name) { return meanPressureOn(name); }};
}

}  // namespace app
