#pragma once

#include "sim/fabric/fabric.h"
#include "sim/fabric/grid/block_points.h"
#include "sim/settings.h"
#include "sim/transfer/gather.h"
#include "sim/transfer/scatter_bounded.h"

#include <span>
#include <vector>

namespace sim {

/// The fabric on the MAC grid: vertices as particles with the liquid's modes and transfers (fabric/grid/README.md, Transfers of the fabric). Elements
/// come along without mass, so that the grid has the faces around them.
class FabricParticles {
 public:
    FabricParticles(const Fabric& fabric, const Settings& settings);

    /// P2G of the vertices with their modes, at the state's positions. The modes of a state that has none become its
    /// velocities; a velocity that was changed since the last gather shifts them.
    /// @param elements  quadrature points [cm]
    void toFaces(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state);
    /// G2P of the faces' velocities to modes and velocities of the vertices, damped as over a step of h [s]. Positions
    /// stay.
    void toVertices(double h, FabricState& state);
    /// What a velocity keeps over a step of h [-].
    double retainedVelocity(double h) const { return retainedOver(transfer_.velocityDamping, h); }

    const BlockGrid& grid() const { return grid_; }
    const ParticleOrder& order() const { return order_; }
    const FaceFields& faces() const { return faces_; }
    BlockArray<double, 3>& velocity() { return faces_.velocity; }
    const BlockPoints& vertices() const { return vertices_; }
    const BlockPoints& elements() const { return elements_; }

 private:
    double retainedOver(double damping, double h) const;
    int rows() const { return particles_.modeCount; }
    double& modeOf(FabricState& state, int axis, int r, std::size_t v) const
    {
        return state.gridSolver.modes[(static_cast<std::size_t>(axis) * rows() + r) * state.x.size() + v];
    }
    void load(std::span<const double> mass, std::span<const Vec3> elements, FabricState& state);
    void damp(double h, std::size_t v, FabricState& state) const;

    FabricTransferSettings transfer_;
    int modes_;         ///< N_r gathered
    double dampingDt_;  ///< [s]
    bool dampingPerStep_, dampModes_;

    Particles particles_;
    BlockGrid grid_;
    ParticleOrder order_;
    FaceFields faces_;
    ScatterScratch scatter_;
    BoundedScratch bounded_;
    GatherScratch gather_;
    BlockPoints vertices_, elements_;
};

}  // namespace sim
