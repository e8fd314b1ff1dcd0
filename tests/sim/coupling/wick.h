#pragma once

#include "sim/coupling/wicking.h"
#include "tests/sim/fabric/pieces.h"

#include <functional>
#include <numeric>
#include <vector>

namespace sim::test {

/// Fabric that stands still in air.
struct Wick {
    explicit Wick(const std::vector<FabricPiece>& pieces)
        : fabric(assembleFabric(pieces)), elements(fabric), state(restState(fabric)), before(fabric.vertexCount(), Vec3::Zero())
    {
        settings.coupling.drag = DragLaw::Linear;
    }
    void fill(const std::function<double(const Vec3&)>& saturation)
    {
        for (std::size_t v = 0; v < fabric.vertexCount(); ++v) state.absorbed[v] = saturation(fabric.rest[v]) * poreVolume(fabric, v);
    }
    double saturation(std::size_t v) const { return state.absorbed[v] / poreVolume(fabric, v); }
    double mass() const { return std::accumulate(state.absorbed.begin(), state.absorbed.end(), 0.0); }
    Vec3 momentum() const
    {
        Vec3 sum = Vec3::Zero();
        for (std::size_t v = 0; v < state.v.size(); ++v) sum += (fabric.mass[v] + state.absorbed[v]) * state.v[v];
        return sum;
    }
    void run(double dt, int steps, const Vec3& gravity)
    {
        Wicking wicking(fabric, elements, settings);
        for (int n = 0; n < steps; ++n)
            for (const Vec3& held : wicking.move(dt, gravity, BlockGrid(), BlockArray<double>(), before, state)) pinImpulse += held;
    }

    Fabric fabric;
    PorousElements elements;
    FabricState state;
    std::vector<Vec3> before;
    Settings settings;
    Vec3 pinImpulse = Vec3::Zero();  ///< of all steps [g cm/s]
};

}  // namespace sim::test
