#pragma once

#include "sim/state.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// The one list of what evolves: a state's hash goes over it, but for the memory of steps, and checkpoints are written and read by it.
//
// A visitor of fields has
//   static constexpr bool kFills         does it give fields their values, or look at them?
//   number(name, unit, x)                a bool, an integer or a double
//   list(name, unit, v)                  a vector of any length, of numbers or of fixed vectors
//   rows(name, unit, count, size, row)   `count` rows, known to be so many, of `size` numbers each, which begin at row(r)

namespace sim {

template <class V, class Liquid>
void visitLiquid(V& v, Liquid& liquid)
{
    std::size_t count = liquid.count, modes = static_cast<std::size_t>(liquid.modeCount);
    v.number("liquid/count", "-", count);
    v.number("liquid/mode_count", "-", modes);
    if constexpr (V::kFills) {
        liquid.modeCount = static_cast<int>(modes);
        liquid.resize(count);
    }
    v.rows("liquid/position", "cm", kAxes, count, [&](std::size_t axis) { return liquid.x[axis].data(); });
    v.rows("liquid/mass", "g", 1, count, [&](std::size_t) { return liquid.mass.data(); });
    v.rows("liquid/id", "-", 1, count, [&](std::size_t) { return liquid.id.data(); });
    v.rows("liquid/velocity_modes", "cm/s", kAxes * modes, count,
           [&](std::size_t row) { return liquid.mode(static_cast<int>(row / modes), static_cast<int>(row % modes)); });
}

template <class V, class Grid>
void visitGrid(V& v, const std::string& name, Grid& grid)
{
    std::vector<Vec3i> coords = grid.coords();
    v.number(name + "/cell", "cm", grid.dx);
    v.rows(name + "/origin", "cm", 1, kAxes, [&](std::size_t) { return grid.origin.data(); });
    v.list(name + "/blocks", "blocks", coords);
    if constexpr (V::kFills) grid.setBlocks(coords);
}

/// Numbers of each cell of each block of a grid that was visited before.
template <class V, class Array>
void visitCells(V& v, const std::string& name, std::string_view unit, const BlockGrid& grid, std::size_t kinds, Array& array)
{
    if constexpr (V::kFills)
        if (grid.count() > 0) array.resize(grid.count());
    v.rows(name, unit, static_cast<std::size_t>(grid.count()), kinds * kBlockCells, [&](std::size_t b) { return array.block(static_cast<int>(b)); });
}

template <class V, class Held>
void visitFriction(V& v, const std::string& name, Held& grips)
{
    v.list(name + "/between", "-", grips.between);
    v.list(name + "/force", "dyn", grips.force);
}

template <class V, class Fabric>
void visitFabric(V& v, Fabric& fabric)
{
    v.list("fabric/position", "cm", fabric.x);
    v.list("fabric/velocity", "cm/s", fabric.v);
    v.list("fabric/absorbed", "g", fabric.absorbed);
    v.list("fabric/twist_angle", "rad", fabric.theta);
    v.list("fabric/twist_rate", "1/s", fabric.omega);
    v.list("fabric/tangent", "-", fabric.tangent);
    v.list("fabric/frame", "-", fabric.reference);
    v.list("fabric/frame_twist", "rad", fabric.referenceTwist);
    v.list("fabric/acceleration", "cm/s^2", fabric.acceleration);
    v.list("fabric/held", "-", fabric.held);
    visitFriction(v, "fabric/friction_on_obstacles", fabric.onObstacles);
    v.number("fabric/energy_of_pressed_fabric", "erg", fabric.stored.pressed);
    v.number("fabric/energy_of_friction", "erg", fabric.stored.gripped);
    v.number("fabric/energy_at_obstacles", "erg", fabric.stored.solids);
    v.number("fabric/energy_of_bridges", "erg", fabric.stored.bridges);
    v.number("fabric/spring_step", "s", fabric.springStep);
    v.number("fabric/accepted_fraction", "-", fabric.vertexSolver.lastFraction);
    v.number("fabric/owed_energy", "erg", fabric.vertexSolver.owed);
    v.list("fabric/force", "dyn", fabric.vertexSolver.force);
    v.list("fabric/mean_force", "dyn", fabric.vertexSolver.meanForce);
    v.list("fabric/mean_contact_force", "dyn", fabric.vertexSolver.meanContactForce);
    v.list("fabric/torque", "dyn cm", fabric.vertexSolver.torque);
    v.list("fabric/mean_torque", "dyn cm", fabric.vertexSolver.meanTorque);
    v.number("fabric/last_step", "s", fabric.vertexSolver.lastStep);
    v.number("fabric/recoverable_energy", "erg", fabric.vertexSolver.recoverable);
    v.number("fabric/most_kinetic_energy", "erg", fabric.mostKinetic);
    visitFriction(v, "fabric/friction_on_fabric", fabric.vertexSolver.onFabric);
    v.list("fabric/across", "-", fabric.gridSolver.across);
    v.list("fabric/velocity_modes", "cm/s", fabric.gridSolver.modes);
    v.number("fabric/since_gather", "s", fabric.gridSolver.sinceGather);
    visitGrid(v, "fabric/grid", fabric.gridSolver.faceBlocks);
    visitCells(v, "fabric/grid/face_change", "cm/s", fabric.gridSolver.faceBlocks, kAxes, fabric.gridSolver.faceChange);
}

template <class V, class Memory>
void visitMemory(V& v, Memory& memory)
{
    v.number("memory/fastest", "cm/s", memory.maxSpeed);
    v.rows("memory/since_midstep", "cm/s", 1, kAxes, [&](std::size_t) { return memory.sinceMidstep.data(); });
    v.number("memory/longest_step", "s", memory.longest);
    v.rows("memory/energies", "erg", 1, memory.energies.size(), [&](std::size_t) { return memory.energies.data(); });
    v.number("memory/next_energy", "-", memory.next);
    v.number("memory/internal", "erg", memory.internal);
    v.number("memory/deepest", "cm", memory.deepest);
    std::size_t sources = memory.sources.size();
    v.number("memory/sources/count", "-", sources);
    if constexpr (V::kFills) memory.sources.resize(sources);
    v.rows("memory/sources/owed_press_crowded_freely_covered_at_shut", "cm^3, s", sources, 7,
           [&](std::size_t source) { return &memory.sources[source].owed; });
    std::size_t openings = memory.openings.size();
    v.number("memory/openings/count", "-", openings);
    if constexpr (V::kFills) memory.openings.resize(openings);
    v.rows("memory/openings/moved_mean_known", "cm, cm/s", openings, 3, [&](std::size_t opening) { return &memory.openings[opening].moved; });
}

/// Liquid, fabric and what belongs to them, always in this order.
template <class V, class S>
void visitMatter(V& v, S& state)
{
    v.number("time", "s", state.time);
    v.number("step", "-", state.step);
    v.number("last_dt", "s", state.lastDt);
    v.number("reflected", "-", state.reflected);
    visitLiquid(v, state.liquid);
    v.number("next_id", "-", state.nextId);
    visitGrid(v, "grid", state.grid);
    visitCells(v, "grid/pressure", "dyn/cm^2", state.grid, 1, state.pressure);
    std::size_t hasStrain = state.grid.count() > 0 && state.pressureOfStrain.size() > 0 ? 1 : 0;
    v.number("grid/has_pressure_of_strain", "-", hasStrain);
    if (hasStrain > 0) visitCells(v, "grid/pressure_of_strain", "dyn/cm^2", state.grid, 1, state.pressureOfStrain);
    if (state.reflected) visitCells(v, "grid/pressure_of_reflection", "dyn/cm^2", state.grid, 1, state.pressureOfReflection);
    visitFabric(v, state.fabric);
    v.list("emitted_volume", "cm^3", state.emittedVolume);
    v.number("unrelaxed", "s", state.unrelaxed);
    v.number("uncorrected", "s", state.uncorrected);
    v.number("ledger/emitted_mass", "g", state.ledger.emittedMass);
    v.number("ledger/left_mass", "g", state.ledger.leftMass);
    v.rows("ledger/left_momentum", "g cm/s", 1, kAxes, [&](std::size_t) { return state.ledger.leftMomentum.data(); });
}

/// All fields of a state.
template <class V, class S>
void visitState(V& v, S& state)
{
    visitMatter(v, state);
    visitMemory(v, state.memory);
}

}  // namespace sim
