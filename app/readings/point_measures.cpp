#include "app/parts.h"
#include "app/readings/measures.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace app {

namespace {

using sim::Vec3;

/// 1 at 0, falling to 0 at 1 and beyond.
double hat(double distance) { return std::max(0.0, 1.0 - std::abs(distance)); }

}  // namespace

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

/// Of the vertex next to a point [-].
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
double Measures::fluxThrough(const Hoop& hoop) const
{
    const sim::LiquidParticles& all = liquid();
    const double dx = simulation_->state().grid.dx;
    double flux = 0.0;
    for (std::size_t p = 0; p < all.count; ++p) {
        const Vec3 away = all.position(p) - hoop.center;
        const double above = away.dot(hoop.normal);
        if (std::abs(above) >= dx || (away - above * hoop.normal).norm() > hoop.radius) continue;
        flux += all.mass[p] * all.velocity(p).dot(hoop.normal) * hat(above / dx) / dx;
    }
    return flux;
}

void Measures::addPoints(Names& names)
{
    for (int a = 0; a < sim::kAxes; ++a)
        names.push_back({fmt::format("velocity_{}", "xyz"[a]), 3, [this, a](std::span<const double> x) {
                             return velocityAt(a, {x[0], x[1], x[2]});
                         }});
    names.push_back({"saturation_at", 3, [this](std::span<const double> x) { return saturationAt({x[0], x[1], x[2]}); }});
}

sim::FormulaNames::OfName Measures::flux()
{
    return {"flux", [this](const std::string& name) {
                const auto hoop = hoops_.find(name);
                if (hoop == hoops_.end()) throw sim::FormulaError(fmt::format("there is no hoop \"{}\"", name));
                return simulation_ ? fluxThrough(hoop->second) : 0.0;
            }};
}

}  // namespace app
