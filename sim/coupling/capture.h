#pragma once

#include "sim/coupling/liquid_around.h"
#include "sim/coupling/porous_law.h"
#include "sim/settings.h"

#include <span>
#include <vector>

namespace sim {

/// Fabric takes up liquid from the particles around until its pores are full. Both meet in the cells that they reach; each particle gives
/// some of its mass, at its own velocity. Mass and momentum are kept to round-off.
///
/// Law fabric: a vertex in liquid asks for rate · dt of what its pores hold, of which there is as much as there is fabric: how finely that
/// is meshed, and how large cells are, does not enter. Law published: for a share of the liquid in the cells around (coupling/README.md, Uptake).
class Capture {
 public:
    /// @param nominalMass  of a particle [g]
    Capture(const Fabric& fabric, const Settings& settings, double nominalMass);

    /// What fabric has taken up in a call of capture, until the next call.
    struct Uptake {
        double mass = 0.0;                     ///< [g]
        std::span<const Vec3> pinImpulse;      ///< momentum of liquid that pins, whose velocities stay, held back of each vertex [g cm/s]
        std::span<const std::size_t> emptied;  ///< particles that have given all they had, ascending
    };
    /// Absorbs liquid over dt [s] from the cells around. Velocities of pinned vertices stay.
    /// @param liquid  what was found around
    Uptake capture(double dt, const LiquidAround::Found& around, LiquidParticles& liquid, FabricState& state);
    /// Removes the particles that have given all they had; their numbers change.
    static void removeEmptyParticles(const Uptake& uptake, LiquidParticles& liquid);

 private:
    using Around = LiquidAround::Found;
    static double rateOf(const FabricMaterial& material, const Settings& settings);
    double demand(std::size_t v, double dt, const Around& around) const;
    double roomOf(std::size_t v, const FabricState& state) const { return capacity_[v] - state.absorbed[v]; }
    bool findUnsaturatedVertices(const SortedVertices& vertices, const FabricState& state);
    void computeDemand(double dt, const Around& around);
    void findShares(const Around& around);
    double absorb(const Around& around, FabricState& state);
    void removeFromParticles(const Around& around, LiquidParticles& liquid);
    std::size_t nearestWithRoom(const Vec3& x, double dx, const std::array<int, 27>& blocks, const SortedVertices& vertices,
                                const FabricState& state) const;
    double absorbResiduals(const Around& around, LiquidParticles& liquid, FabricState& state);
    void deposit(std::size_t v, double mass, const Vec3& momentum, FabricState& state);
    template <class Body>
    void forEachUnsaturated(const SortedVertices& vertices, int block, Body&& body) const;

    const Fabric& fabric_;
    std::vector<double> capacity_;       ///< mass that the pores of each vertex hold [g]
    std::vector<double> ratePerVertex_;  ///< law fabric: part of its pores that it fills per time; published: of the liquid around [1/s]
    CaptureLaw law_;
    double leastMass_;  ///< mass below which a particle gives all [g]

    // Of the step.
    std::vector<double> wanted_, got_;          ///< mass that each vertex asks for, and what it gets [g]
    std::vector<Vec3> pinImpulse_;              ///< momentum that pins held back of each vertex [g cm/s]
    BlockArray<double> asked_;                  ///< mass that all vertices ask of each cell of their blocks [g]
    BlockArray<double> share_;                  ///< share of the cell's liquid that vertices ask for [-]
    std::vector<std::uint8_t> hasUnsaturated_;  ///< whether each block of the vertices has vertices with room
    std::vector<std::uint8_t> isAsked_;         ///< whether vertices want liquid of each of these blocks' cells, and of an empty one's
    std::vector<std::size_t> emptied_;          ///< particles, ascending
};

}  // namespace sim
