#include "app/backends.h"
#include "app/readings/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace app {

namespace {

using sim::Vec3;

/// 1 at 0, falling to 0 at 1 and beyond.
double hat(double distance) { return std::max(0.0, 1.0 - std::abs(distance)); }

/// Densities at equal distances along a line, smoothed by hats of a cell in each direction.
class LineDensity {
 public:
    /// Mass of a particle at height y that counts for the line [g].
    void add(double y, double mass, double dx)
    {
        const double spacing = dx / kPerCell;
        for (auto n = static_cast<std::int64_t>(std::ceil((y - dx) / spacing)); static_cast<double>(n) * spacing <= y + dx; ++n)
            density_[n] += mass * hat((y - static_cast<double>(n) * spacing) / dx) / (dx * dx * dx);
    }

    /// The highest place where the density is half of the densest, or of `most` [g/cm^3] where that is less [cm]; NaN where nothing is even an
    /// eighth as dense as that: single drops of spray.
    double upperEnd(double most, double dx) const
    {
        double densest = 0.0;
        for (const auto& [n, density] : density_) densest = std::max(densest, density);
        if (densest < most / 8.0) return std::numeric_limits<double>::quiet_NaN();
        const double half = 0.5 * std::min(densest, most);
        double above = 0.0;
        for (auto node = density_.rbegin(); node != density_.rend(); above = (node++)->second)
            if (node->second >= half) return (static_cast<double>(node->first) + (node->second - half) / (node->second - above)) * dx / kPerCell;
        return std::numeric_limits<double>::quiet_NaN();
    }

 private:
    static constexpr double kPerCell = 8.0;   ///< places in a cell
    std::map<std::int64_t, double> density_;  ///< [g/cm^3] at n dx / kPerCell
};

}  // namespace

/// Where the liquid ends along an axis on the line through b and c, its coordinates on the other two in their order; NaN where there is none [cm].
/// The density is that of the particles near the line: half of it is at the surface of liquid that fills cells evenly, and the densest of the line
/// stands for liquid that is full because at walls a part of what is near the line is wall.
double Measures::surfaceAt(int axis, double b, double c) const
{
    const sim::LiquidParticles& all = liquid();
    const double dx = simulation_->state().grid.dx;
    const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    LineDensity line;
    for (std::size_t p = 0; p < all.count; ++p) {
        const double share = hat((all.x[first][p] - b) / dx) * hat((all.x[second][p] - c) / dx);
        if (share > 0.0) line.add(all.x[axis][p], share * all.mass[p], dx);
    }
    return line.upperEnd(density_, dx);
}

/// Mean of a component over the liquid within a cell's length of a point; NaN where there is none [cm/s].
double Measures::velocityAt(int axis, const Vec3& x) const
{
    const sim::LiquidParticles& all = liquid();
    const double dx = simulation_->state().grid.dx;
    double mass = 0.0, momentum = 0.0;
    for (std::size_t p = 0; p < all.count; ++p) {
        const Vec3 away = (all.position(p) - x) / dx;
        const double share = all.mass[p] * hat(away[0]) * hat(away[1]) * hat(away[2]);
        if (share == 0.0) continue;
        mass += share;
        momentum += share * all.velocity(p)[axis];
    }
    return mass > 0.0 ? momentum / mass : std::numeric_limits<double>::quiet_NaN();
}

/// Saturation of the vertex next to a point [-].
double Measures::saturationAt(const Vec3& x) const
{
    const std::vector<Vec3>& places = simulation_->state().fabric.x;
    if (places.empty()) throw sim::FormulaError("there is no fabric");
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < places.size(); ++v)
        if ((places[v] - x).squaredNorm() < (places[nearest] - x).squaredNorm()) nearest = v;
    return simulation_->state().fabric.absorbed[nearest] / (density_ * sim::poreVolume(simulation_->fabric(), nearest));
}

/// Mass of liquid that goes through per time: of what is within a cell's length of the plane [g/s].
double Measures::fluxThrough(const ControlSurface& resting) const
{
    const sim::LiquidParticles& all = liquid();
    const sim::State& state = simulation_->state();
    const double dx = state.grid.dx;
    const ControlSurface surface = resting.at(state.time);
    double flux = 0.0;
    for (std::size_t p = 0; p < all.count; ++p) {
        const Vec3 place = all.position(p), away = place - surface.center;
        const double above = away.dot(surface.normal);
        if (std::abs(above) >= dx || (away - above * surface.normal).norm() > surface.radius) continue;
        const Vec3 passing = all.velocity(p) - surface.motion.velocity(state.time, place);
        flux += all.mass[p] * passing.dot(surface.normal) * hat(above / dx) / dx;
    }
    return flux;
}

void Measures::addPoints(Names& names)
{
    for (int a = 0; a < sim::kAxes; ++a)
        names.push_back({fmt::format("velocity_{}", "xyz"[a]), 3, [this, a](std::span<const double> x) {
                             return velocityAt(a, {x[0], x[1], x[2]});
                         }});
    for (int a = 0; a < sim::kAxes; ++a)
        names.push_back({fmt::format("surface_{}", "xyz"[a]), 2, [this, a](std::span<const double> at) { return surfaceAt(a, at[0], at[1]); }});
    names.push_back({"saturation_at", 3, [this](std::span<const double> x) { return saturationAt({x[0], x[1], x[2]}); }});
}

sim::FormulaNames::OfName Measures::flux()
{
    return {"flux", [this](const std::string& name) {
                const auto surface = controlSurfaces_.find(name);
                if (surface == controlSurfaces_.end()) throw sim::FormulaError(fmt::format("there is no control surface \"{}\"", name));
                return simulation_ ? fluxThrough(surface->second) : 0.0;
            }};
}

}  // namespace app
