#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/pins.h"

namespace sim {

/// What pins and solids got in the solve; the state is still that of before.
void GridFabricSolver::reportSprings(double h, const FabricState& state, std::span<const ObstacleContact> touching)
{
    if (fabric_.pins.vertex.empty() && touching.empty()) return;
    const AlignedArray<double>& u = system_.vertexVelocities(velocity_);
    const auto placeOf = [&](int v) -> Vec3 { return state.x[v] + h * stiffness_.at(u, v); };
    const auto onPin = [&](std::size_t i, const Vec3& impulse) {
        forces_->pins[fabric_.pins.motion[i]] += Impulse::at(placeOf(fabric_.pins.vertex[i]), impulse);
    };
    const auto onEdge = [&](int edge, double impulse) {
        if (const auto pin = pinOfEdge(fabric_, edge)) forces_->pins[fabric_.pins.motion[*pin]].angular += impulse * state.tangent[edge];
    };
    const auto onObstacle = [&](std::size_t i, const Vec3& impulse) {
        const ObstacleContact& contact = touching[i];
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        const Vec3 place = share[0] * placeOf(v[0]) + share[1] * placeOf(v[1]) + share[2] * placeOf(v[2]);
        forces_->touch(fabric_.pieceOf(v[0]), obstacles_.inScene(contact.between[1]), Impulse::at(place, impulse));
    };
    stiffness_.forEachReaction(h, u, onPin, onEdge, onObstacle);
}

/// What solids made of the moves that velocities follow.
void GridFabricSolver::reportSolidLimiter(double h, const FabricState& state) const
{
    for (std::size_t v = 0; v < move_.size(); ++v) {
        if (move_[v] == wanted_[v]) continue;
        const Vec3 place = state.x[v] + move_[v], onObstacle = mass_[v] / h * (wanted_[v] - move_[v]);
        forces_->touch(fabric_.pieceOf(static_cast<int>(v)), obstacles_.inScene(obstacles_.nearest(place)), Impulse::at(place, onObstacle));
    }
}

/// Vertices share what the liquid does to a face by their masses on it.
void GridFabricSolver::reportLiquid(const FabricState& state, const FaceLoads& loads)
{
    const auto& sums = particles_.faces().sums;
    BlockArray<double, 3>& perMass = acceleration_;
    perMass.resize(system_.blocks());
    parallelFor(system_.blocks(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n), loaded = loads.grid.find(particles_.grid().coords(b));
        for (int a = 0; a < kAxes; ++a) {
            double* to = perMass.block(b, a);
            if (loaded == BlockGrid::kNone) {
                std::fill_n(to, kBlockCells, 0.0);
                continue;
            }
            const double *mass = sums.block(b, FaceFields::kMass + a), *impulse = loads.impulse.block(loaded, a), *drag = loads.drag.block(loaded, a),
                         *velocity = velocity_.faces.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) to[c] = mass[c] > 0.0 ? (impulse[c] - drag[c] * velocity[c]) / mass[c] : 0.0;
        }
    });
    byLiquid_.resize(state.x.size());
    system_.gatherVertices(perMass, byLiquid_);
    for (std::size_t v = 0; v < byLiquid_.size(); ++v)
        forces_->fabrics[fabric_.pieceOf(static_cast<int>(v))].liquid += Impulse::at(state.x[v], mass_[v] * byLiquid_[v]);
}

}  // namespace sim
