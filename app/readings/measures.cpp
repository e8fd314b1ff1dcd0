#include "app/readings/measures.h"

#include "app/backends.h"
#include "app/readings/shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace app {

namespace {

using sim::Vec3, sim::kAxes;
using Arguments = std::span<const double>;

std::string along(const char* name, int axis) { return std::string(name) + "xyz"[axis]; }

/// Mean of value(p), weighted by mass.
template <class Value>
auto meanOf(const sim::LiquidParticles& liquid, Value&& value)
{
    double mass = 0.0;
    auto sum = decltype(value(std::size_t{})){0.0 * value(0)};
    for (std::size_t p = 0; p < liquid.count; ++p) {
        sum += liquid.mass[p] * value(p);
        mass += liquid.mass[p];
    }
    return decltype(sum)(sum / mass);
}

double massBetween(const sim::LiquidParticles& liquid, int axis, double from, double to)
{
    double mass = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p)
        if (liquid.x[axis][p] >= from && liquid.x[axis][p] < to) mass += liquid.mass[p];
    return mass;
}

/// Angular momentum about the centre of mass: of the particles, and of how their velocities change around them (m dx/4
/// per mode and cell, transfer/README.md, Conservation) [g cm^2/s].
Vec3 spin(const sim::LiquidParticles& liquid, double dx)
{
    const Vec3 middle = meanOf(liquid, [&](std::size_t p) { return liquid.position(p); });
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < liquid.count; ++p) {
        Vec3 own = (liquid.position(p) - middle).cross(liquid.velocity(p));
        const auto slope = [&](int component, int axis) { return liquid.mode(component, 1 + axis)[p]; };
        for (int a = 0; a < kAxes && liquid.modeCount >= 4; ++a) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            own[a] += 0.25 * dx * (slope(c, b) - slope(b, c));
        }
        sum += liquid.mass[p] * own;
    }
    return sum;
}

/// Mean over the fabric of value(v), weighted by dry mass.
template <class Value>
double meanOf(const sim::Fabric& fabric, Value&& value)
{
    double sum = 0.0, mass = 0.0;
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
        sum += fabric.mass[v] * value(v);
        mass += fabric.mass[v];
    }
    return sum / mass;
}

double largest(const std::vector<Vec3>& velocities)
{
    double square = 0.0;
    for (const Vec3& v : velocities) square = std::max(square, v.squaredNorm());
    return std::sqrt(square);
}

/// Distance between the lowest and the highest of the places for which takes(v) [cm]; 0 if there is none.
template <class Takes>
double extent(const std::vector<Vec3>& places, int axis, Takes&& takes)
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (!takes(v)) continue;
        low = std::min(low, places[v][axis]);
        high = std::max(high, places[v][axis]);
    }
    return std::max(0.0, high - low);
}

}  // namespace

const sim::LiquidParticles& Measures::liquid() const { return simulation_->state().liquid; }

std::size_t Measures::vertex(double number) const
{
    const std::size_t count = simulation_->fabric().vertexCount();
    if (number >= 0.0 && number < static_cast<double>(count)) return static_cast<std::size_t>(number);
    throw sim::FormulaError(fmt::format("there is no vertex {:g}: the fabric has {}", number, count));
}

std::vector<sim::FormulaNames::Function> Measures::names()
{
    Names names;
    addLiquid(names);
    addFabric(names);
    addPoints(names);
    if (flow_) addFlow(names);
    for (int a = 0; a < kAxes; ++a) {
        addLiquidAlong(a, names);
        addFabricAlong(a, names);
    }
    return names;
}

void Measures::addLiquid(Names& names)
{
    const auto energies = [this] { return simulation_->energies(); };
    names.push_back({"liquid_mass", 0, [this](Arguments) { return massBetween(liquid(), 0, -1.0e300, 1.0e300); }});
    names.push_back({"left_mass", 0, [this](Arguments) { return simulation_->state().ledger.leftMass; }});
    names.push_back({"kinetic", 0, [energies](Arguments) { return energies().kinetic + energies().modal; }});
    names.push_back({"potential", 0, [energies](Arguments) { return energies().potential; }});
    names.push_back({"energy", 0, [energies](Arguments) { return energies().total(); }});
    names.push_back({"rms_speed", 0, [this](Arguments) {
                         return std::sqrt(meanOf(liquid(), [this](std::size_t p) { return liquid().velocity(p).squaredNorm(); }));
                     }});
    names.push_back({"speed", 0, [this](Arguments) {
                         double square = 0.0;
                         for (std::size_t p = 0; p < liquid().count; ++p) square = std::max(square, liquid().velocity(p).squaredNorm());
                         return std::sqrt(square);
                     }});
    names.push_back({"pressure", 3, [this](Arguments x) { return pressureAt({x[0], x[1], x[2]}); }});
}

/// Momentum of the liquid, and of the fabric with what it has absorbed [g cm/s].
double Measures::momentum(int axis) const
{
    double sum = 0.0;
    const double sinceMidstep = simulation_->state().memory.sinceMidstep[axis];
    for (std::size_t p = 0; p < liquid().count; ++p) sum += liquid().mass[p] * (liquid().velocity(p)[axis] + sinceMidstep);
    const sim::FabricState& fabric = simulation_->state().fabric;
    for (std::size_t v = 0; v < fabric.v.size(); ++v) sum += (simulation_->fabric().mass[v] + fabric.absorbed[v]) * fabric.v[v][axis];
    return sum;
}

void Measures::addLiquidAlong(int a, Names& names)
{
    names.push_back({along("momentum_", a), 0, [this, a](Arguments) { return momentum(a); }});
    names.push_back(
        {along("liquid_", a), 0, [this, a](Arguments) { return meanOf(liquid(), [this, a](std::size_t p) { return liquid().x[a][p]; }); }});
    names.push_back({along("liquid_v", a), 0, [this, a](Arguments) {
                         const double ofParticles = meanOf(liquid(), [this, a](std::size_t p) { return liquid().velocity(p)[a]; });
                         return ofParticles + simulation_->state().memory.sinceMidstep[a];
                     }});
    names.push_back({along("spin_", a), 0, [this, a](Arguments) { return spin(liquid(), simulation_->state().grid.dx)[a]; }});
    names.push_back({along("wave_", a), 1,
                     [this, a](Arguments k) { return meanOf(liquid(), [this, a, k](std::size_t p) { return std::cos(k[0] * liquid().x[a][p]); }); }});
    names.push_back({along("mass_", a), 2, [this, a](Arguments between) { return massBetween(liquid(), a, between[0], between[1]); }});
    names.push_back({along("front_", a), 1, [this, a](Arguments height) { return front(a, height[0]); }});
}

void Measures::addFlow(Names& names)
{
    names.push_back({"flow_error", 0, [this](Arguments) { return flowError(); }});
    names.push_back({"flow_part", 0, [this](Arguments) { return flowPart(); }});
}

void Measures::addFabric(Names& names)
{
    const auto state = [this]() -> const sim::FabricState& { return simulation_->state().fabric; };
    names.push_back({"fabric_mass", 0, [this](Arguments) {
                         const auto& mass = simulation_->fabric().mass;
                         return std::accumulate(mass.begin(), mass.end(), 0.0);
                     }});
    names.push_back({"absorbed", 0, [state](Arguments) { return std::accumulate(state().absorbed.begin(), state().absorbed.end(), 0.0); }});
    names.push_back({"saturation", 1, [this, state](Arguments n) {
                         const std::size_t v = vertex(n[0]);
                         return state().absorbed[v] / (density_ * sim::poreVolume(simulation_->fabric(), v));
                     }});
    names.push_back({"fabric_speed", 0, [state](Arguments) { return largest(state().v); }});
    names.push_back({"fabric_kinetic", 0, [this](Arguments) { return simulation_->energies().fabric.kinetic; }});
    names.push_back({"elastic", 0, [this](Arguments) { return simulation_->energies().fabric.elastic(); }});
}

void Measures::addFabricAlong(int a, Names& names)
{
    const auto state = [this]() -> const sim::FabricState& { return simulation_->state().fabric; };
    const auto all = [](std::size_t) { return true; };
    names.push_back({along("fabric_", a), 0,
                     [this, state, a](Arguments) { return meanOf(simulation_->fabric(), [&](std::size_t v) { return state().x[v][a]; }); }});
    names.push_back({along("fabric_v", a), 0,
                     [this, state, a](Arguments) { return meanOf(simulation_->fabric(), [&](std::size_t v) { return state().v[v][a]; }); }});
    names.push_back({along("vertex_", a), 1, [this, state, a](Arguments n) { return state().x[vertex(n[0])][a]; }});
    names.push_back({along("vertex_v", a), 1, [this, state, a](Arguments n) { return state().v[vertex(n[0])][a]; }});
    names.push_back({along("spread_", a), 0, [state, all, a](Arguments) { return extent(state().x, a, all); }});
    names.push_back({along("wet_", a), 1, [this, state, a](Arguments s) {
                         const sim::Fabric& fabric = simulation_->fabric();
                         const auto isWet = [&](std::size_t v) { return state().absorbed[v] >= s[0] * density_ * sim::poreVolume(fabric, v); };
                         return extent(state().x, a, isWet);
                     }});
}

std::vector<sim::FormulaNames::OfName> Measures::shadows()
{
    std::vector<sim::FormulaNames::OfName> names;
    for (int a = 0; a < kAxes; ++a) names.push_back({along("shadow_", a), [this, a](const std::string& name) { return shadowOf(name, a); }});
    return names;
}

double Measures::shadowOf(const std::string& name, int axis) const
{
    const auto found = std::ranges::find(forceNames_.fabrics, name);
    if (found == forceNames_.fabrics.end()) throw sim::FormulaError(fmt::format("there is no fabric \"{}\"", name));
    if (!simulation_) return 0.0;
    const sim::Fabric::Faces& faces = simulation_->fabric().faces;
    std::vector<sim::Vec3i> own;
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (faces.material[f] == found - forceNames_.fabrics.begin()) own.push_back(faces.vertices[f]);
    return shadowArea(simulation_->state().fabric.x, own, axis);
}

Vec3 Measures::flowAt(const Vec3& x) const
{
    const std::array at = {x[0], x[1], x[2], simulation_->state().time};
    return {(*flow_)[0](at), (*flow_)[1](at), (*flow_)[2](at)};
}

/// Σ m term(u, its component of the flow) over the faces that carry liquid.
template <class Term>
double Measures::sumOverFaces(Term&& term) const
{
    const sim::BlockGrid& grid = simulation_->state().grid;
    const sim::LiquidGrid& of = simulation_->liquidGrid();
    double sum = 0.0;
    for (int b = 0; b < grid.count(); ++b)
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < sim::kBlockCells; ++c) {
                if (!of.wet.test(b, c, a) || !of.faces.valid.test(b, c, a)) continue;
                const Vec3 inBlock(c & 7, (c >> 3) & 7, c >> 6);
                const Vec3 x = grid.lowerCorner(b) + grid.dx * (inBlock + Vec3::Constant(0.5) - 0.5 * Vec3::Unit(a));
                sum += of.faces.sums.block(b, sim::FaceFields::kMass + a)[c] * term(of.faces.velocity.block(b, a)[c], flowAt(x)[a]);
            }
    return sum;
}

double Measures::flowError() const
{
    if (simulation_->state().step == 0) return valueBeforeSteps();
    const double error = sumOverFaces([](double u, double flow) { return (u - flow) * (u - flow); });
    return std::sqrt(error / sumOverFaces([](double, double flow) { return flow * flow; }));
}

double Measures::flowPart() const
{
    if (simulation_->state().step == 0) return valueBeforeSteps();
    return sumOverFaces([](double u, double flow) { return u * flow; }) / sumOverFaces([](double, double flow) { return flow * flow; });
}

/// Pressure at the centre of the cell with x in it [dyn/cm^2].
double Measures::pressureAt(const Vec3& x) const
{
    const sim::State& state = simulation_->state();
    if (state.step == 0) return valueBeforeSteps();
    const Eigen::Vector3i cell = ((x - state.grid.origin) / state.grid.dx).array().floor().cast<int>();
    const Eigen::Vector3i block(cell.x() >> 3, cell.y() >> 3, cell.z() >> 3);
    const int number = state.grid.find(block);
    if (number == sim::BlockGrid::kNone) return 0.0;
    return state.pressure.block(number)[sim::cellInBlock(cell.x() & 7, cell.y() & 7, cell.z() & 7)];
}

double Measures::front(int axis, double where) const
{
    const sim::State& state = simulation_->state();
    const sim::BlockGrid& grid = state.grid;
    if (state.step == 0) return valueBeforeSteps();
    const int fixed = axis == 1 ? 0 : 1, other = 3 - axis - fixed;
    const int layer = static_cast<int>(std::floor((where - grid.origin[fixed]) / grid.dx));
    std::map<int, std::set<int>> rows;
    for (int b = 0; b < grid.count(); ++b)
        for (int c = 0; c < sim::kBlockCells; ++c) {
            const Eigen::Vector3i cell = 8 * grid.coords(b) + Eigen::Vector3i(c & 7, (c >> 3) & 7, c >> 6);
            if (cell[fixed] == layer && simulation_->liquidGrid().inside.test(b, c)) rows[cell[other]].insert(cell[axis]);
        }
    int last = std::numeric_limits<int>::min();
    for (const auto& [row, cells] : rows) {
        int end = *cells.begin();
        while (cells.contains(end + 1)) ++end;
        last = std::max(last, end);
    }
    return rows.empty() ? std::numeric_limits<double>::quiet_NaN() : grid.origin[axis] + grid.dx * (last + 0.5);
}

}  // namespace app
