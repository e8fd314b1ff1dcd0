#pragma once

#include "sim/forces.h"
#include "sim/liquid/liquid_on_solids.h"
#include "sim/scene/scene.h"
#include "sim/state.h"

#include <span>
#include <vector>

namespace sim {

/// Books who gives whom momentum in a step: solids, fabrics, pins and liquid. All that changes what liquid or fabric has is somebody's, so that
/// the sums close (MomentumBalance). Some of it is of no force that the step reckons with: what iterations leave of a balance, what gradients of
/// the pressure do on faces that are less full than they count. That is what held the liquid or the fabric has to bear: the solid on which most of
/// the liquid presses, the pins of a fabric, without any the solid that it pushed hardest, without any the other fabrics. Where nothing holds it
/// stays unresolved. Measures nothing where there is neither a solid nor fabric.
class MomentumBudget {
 public:
    void prepare(const Scene& scene, const Fabric& fabric);
    bool isOpen() const { return fabric_ != nullptr; }
    Forces& forces() { return forces_; }
    const Forces& forces() const { return forces_; }

    // The parts of a step, in their order.
    void begin(double dt, const State& state);
    /// Sources gave particles from this number on.
    void entered(const State& state, std::size_t first);
    /// Openings of the domain gave this much to the liquid on the faces [g cm/s].
    void pushedIn(const Vec3& impulse);
    /// Particles outside of the domain are gone.
    void left(const State& state);
    /// Fabric took up liquid, let go of some, or moved some within itself.
    /// @param pinImpulse  of each vertex: what pins held back of it [g cm/s]; empty if nothing
    void exchanged(const State& state, std::span<const Vec3> pinImpulse);
    /// Particles have brought the liquid's momentum to the faces.
    void liquidOnFaces(const FaceFields& faces, int blocks);
    /// The fabric's solver has moved it, and told what it knows of forces.
    void fabricMoved(double dt, const Vec3& gravity, const State& state);
    /// Particles have their velocities from the faces, and were kept out of solids.
    /// @param now     momentum that they had before they were kept out [g cm/s]
    /// @param weight  what weight gave to the faces [g cm/s]
    /// @return  what but weight the liquid got on the faces [g cm/s]; 0 where nothing is measured
    Vec3 liquidMoved(const Vec3& now, const Vec3& weight, const LiquidOnSolids& onSolids, const ChunkSums<Impulse>& pushed);
    /// Unexplained momentum assigned to a solid, and its point of application.
    struct ImposedMomentum {
        Vec3 bySolid = Vec3::Zero(), place = Vec3::Zero();  ///< [g cm/s], [cm]
    };
    const ImposedMomentum& imposedMomentum() const { return imposedMomentum_; }
    void finish();

 private:
    /// What a fabric has.
    struct Piece {
        Impulse momentum;
        double mass = 0.0;                                    ///< mass with what it has absorbed [g]
        Vec3 moment = Vec3::Zero();                           ///< Σ m x [g cm]
        Vec3 byLiquid = Vec3::Zero(), onPins = Vec3::Zero();  ///< what it got and gave in this step before its solver ran [g cm/s]
        Vec3 missing = Vec3::Zero();                          ///< change of its momentum that no force explains [g cm/s]
        Vec3 middle() const { return moment / mass; }
    };
    void look(const FabricState& state);
    Vec3 onPins(std::size_t piece) const;
    bool isHeld(std::size_t piece) const { return !pinsOf_[piece].empty() || forces_.hardest[piece].obstacle != Forces::Touch::kNone; }
    void settleLoose();
    void settleHeld(std::size_t piece, const FabricState& state);

    const Fabric* fabric_ = nullptr;
    bool isLed_ = false;  ///< is all fabric held (fabric.solver: off)? What holds it beside its pins is nobody
    Forces forces_;
    Vec3 liquid_ = Vec3::Zero();            ///< momentum that the liquid should have by what has been booked; until it is on the faces the
                                            ///< change of it since the start of the step [g cm/s]
    Vec3 onFaces_ = Vec3::Zero();           ///< momentum that particles brought to the faces [g cm/s]
    ImposedMomentum imposedMomentum_;       ///< what no force explains of the liquid's in the last step
    Vec3 leftSoFar_ = Vec3::Zero();         ///< Ledger::leftMomentum at the start of the step [g cm/s]
    std::vector<Piece> pieces_;             ///< fabrics as they were when they were last looked at
    std::vector<Impulse> before_;           ///< momenta of the fabrics before that
    std::vector<std::vector<int>> pinsOf_;  ///< groups of pins of each fabric
    std::vector<int> pinned_;               ///< number of vertices of each group
};

}  // namespace sim
