#pragma once

#include "sim/core/parallel.h"
#include "sim/coupling/fabric_on_faces.h"
#include "sim/coupling/porous_law.h"
#include "sim/coupling/suction.h"
#include "sim/energy_changes.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/grid/obstacle_field.h"
#include "sim/liquid/liquid_grid.h"
#include "sim/settings.h"

#include <optional>
#include <span>

namespace sim {

/// Does drag go by the fabric's own fraction, on what of it the liquid around touches?
inline bool isDragByFabric(const CouplingSettings& coupling)
{
    return coupling.drag != DragLaw::Off && coupling.dragFraction == DragFraction::Fabric;
}

/// Liquid and fabric on the faces that both reach: drag, and the pressure that keeps the mixture's volume (coupling/README.md, Mixture). The fabric's
/// own forces are solved for in vertex space; what the liquid adds to them, and they to it, cancels to round-off.
///
/// The order of a step is in the types: what a function needs of those before it, it takes as an argument that only they return. All of them hold
/// until the next findSharedFaces.
class Mixture {
 public:
    /// There are faces that both phases are on.
    class SharedFaces {
        friend Mixture;
        SharedFaces() = default;
    };
    /// The liquid's velocities there are the mixture's.
    class EliminatedDrag : public SharedFaces {
        friend Mixture;
        EliminatedDrag() = default;
    };
    /// The pressure's impulses on both phases are known.
    class AppliedPressure : public EliminatedDrag {
        friend Mixture;
        AppliedPressure() = default;
    };
    /// The liquid's velocities there are its own again, and the fabric's are those at the end of the step.
    class SeparatedPhases : public AppliedPressure {
        friend Mixture;
        SeparatedPhases() = default;
    };
    Mixture(const Fabric& fabric, const Settings& settings);

    /// The fabric where it meets the liquid; all of it stays until the phases are separated.
    struct MetFabric {
        SortedVertices& vertices;
        const FabricState& state;
        std::span<const double> distance;  ///< distance of the liquid from each vertex where drag goes by it (isDragByFabric), else empty [cells]
        const FabricFaces* faces;          ///< velocities, of a solver that has its unknowns on faces; else null
    };
    /// Finds the faces that both phases are on, with their drag over a step of dt [s], of a liquid whose predicted velocities are known. The
    /// volume of the fabric and of what it holds then counts as filled. Nothing if there are none.
    std::optional<SharedFaces> findSharedFaces(const CutGrid& cut, const Vec3& gravity, double dt, const MetFabric& fabric, LiquidGrid& liquid);
    /// Velocities of these faces become the mixture's, and coefficients those that its pressure acts with.
    /// @param coefficient  of each face of the liquid's grid, ω dt β / dx² (PressureWorkspace)
    EliminatedDrag eliminateDrag(const SharedFaces&, const ObstacleField& obstacles, LiquidGrid& liquid, BlockArray<double, 3>& coefficient);
    /// Impulses of the pressure on both phases, from the mixture's velocities after its projection.
    AppliedPressure applyPressure(const EliminatedDrag&, const LiquidGrid& liquid);
    /// Loads of pressure, drag and suction on the vertices of the fabric, or on its faces.
    const LiquidLoads& vertexLoads(const AppliedPressure&);
    FaceLoads faceLoads(const AppliedPressure&);
    /// The liquid's own velocities on these faces, given those of the vertices, or of the fabric's faces, at the end of the step.
    SeparatedPhases recoverPhaseVelocities(const AppliedPressure&, const FabricState& state, LiquidGrid& liquid);
    SeparatedPhases recoverPhaseVelocities(const AppliedPressure&, const FabricFaces& faces, LiquidGrid& liquid);

    /// Makes the mass of the liquid's faces that of the liquid alone again, where room that fabric takes up counted as full.
    void removeDisplacedMass(const SharedFaces&, LiquidGrid& liquid) const;
    /// Masses of these faces become those with which both phases together respond to an impulse, and changes what pressure and surface tension did
    /// to the mixture [cm/s]; a further change of the mixture's velocity before applyPressure acts on both.
    void toMassesOfBoth(const EliminatedDrag&, LiquidGrid& liquid, BlockArray<double, 3>& change) const;
    void fromMassesOfBoth(const EliminatedDrag&, LiquidGrid& liquid) const;

    /// Calls f(liquid's block, axis, cell, impulse) with what drag, suction and the fabric's part of the pressure took from the liquid of each
    /// shared face [g cm/s], blocks in parallel.
    template <class F>
    void forEachImpulseTaken(const SeparatedPhases&, F&& f) const
    {
        forEachShared([&](int b, int m, int a, int c) { f(m, a, c, impulseTaken(b, a, c)); });
    }

    /// Sets what the liquid has on these faces to 0.
    void clearShared(const SharedFaces&, BlockArray<double, 3>& values) const;
    void clearShared(const SharedFaces&, BlockBits<3>& faces) const;

    /// Momentum of the liquid on the shared faces [g cm/s].
    Vec3 liquidMomentum(const SharedFaces&, const LiquidGrid& liquid) const;
    /// Where the energy of the liquid on shared faces went in this step, by the impulses on each and the velocities they act at; and its
    /// part of what acted between both: with the work of all that liquid did to the fabric these are pressure, suction and drag.
    /// @param before  the liquid's velocities when nothing but gravity had acted
    EnergyChanges energyChanges(const SeparatedPhases&, const LiquidGrid& liquid, const BlockArray<double, 3>& before) const;
    /// Work on liquid and fabric of a pressure that changes the mixture's velocities by so much [erg].
    double workOf(const SeparatedPhases&, const BlockArray<double, 3>& change, const LiquidGrid& liquid) const;
    /// Kinetic energy of the liquid on the shared faces at these velocities [erg].
    double kinetic(const SharedFaces&, const BlockArray<double, 3>& velocity) const;
    /// Are both phases on the lower face of a cell?
    bool isShared(const SharedFaces&, int axis, const Vec3i& cell) const;

 private:
    using Faces = BlockArray<double, 3>;
    bool matchBlocks(const BlockGrid& vertices, const BlockGrid& grid);
    void findRelative(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid);
    void addSuction(const CutGrid& cut, const FabricState& state, const LiquidGrid& liquid);
    void mixVelocities(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid);
    void addDisplacedMass(LiquidGrid& liquid) const;
    void removeDisplacedMass(LiquidGrid& liquid) const;
    const Faces& perFabricMass(const Faces& values);
    void recoverLiquidVelocities(LiquidGrid& liquid) const;
    double dragOn(int block, int axis, int cell, double liquidVolume, double room) const;
    bool hasReaction() const { return settings_.capillary && settings_.capillaryReaction; }
    double speedAt(int block, int axis, int cell) const;
    double impulseTaken(int block, int axis, int cell) const;
    void applyReaction();
    /// body(block, liquid's block, axis, cell) for the shared faces, blocks in parallel.
    template <class Body>
    void forEachShared(Body&& body) const
    {
        parallelFor(liquidBlock_.size(), [&](std::size_t n) {
            const int b = static_cast<int>(n), m = liquidBlock_[b];
            if (m == BlockGrid::kNone) return;
            for (int a = 0; a < kAxes; ++a) {
                const double* mass = liquidMass_.block(b, a);
                for (int c = 0; c < kBlockCells; ++c)
                    if (mass[c] > 0.0) body(b, m, a, c);
            }
        });
    }
    template <class Of>
    double sumOver(const BlockArray<double, 3>& velocity, int block, int axis, Of&& of) const;

    PorousLaw law_;
    LiquidSettings liquid_;
    double liquidDensity_;  ///< [g/cm^3]
    CouplingSettings settings_;
    Suction suction_;
    double dt_ = 0.0;                     ///< length of the step under way [s]
    SortedVertices* vertices_ = nullptr;  ///< vertices of the step under way
    FabricOnFaces onFaces_;
    std::vector<int> liquidBlock_;  ///< block of the liquid's grid for each of the fabric's grid; BlockGrid::kNone where there is no liquid

    // Of each face of the fabric's grid; liquidMass_ is 0 where it is not shared.
    Faces liquidMass_;              ///< [g]
    Faces relative_;                ///< velocity of the liquid past the fabric [cm/s]
    Faces liquidVolume_;            ///< volume on which pressure pushes the liquid [cm^3]
    Faces drag_;                    ///< D = dt c V, with the volume V that drag acts on (dragOn) [g]
    Faces predicted_;               ///< u_f*: velocity of the liquid before drag and pressure [cm/s]
    Faces pressed_;                 ///< ũ_f: velocity of the liquid after the pressure, without drag [cm/s]
    Faces mixed_, mobility_;        ///< velocity of the mixture before the pressure [cm/s]; β [cm^3/g]
    Faces suctionImpulse_;          ///< impulse of suction on the liquid [g cm/s]
    Faces reaction_;                ///< impulse of suction on all faces of the fabric [g cm/s]
    std::vector<Vec3> reactionOf_;  ///< impulse of suction on each vertex [g cm/s]
    Faces onFabric_;                ///< D', of which the fabric feels D' (ũ_f − u_s) [g]
    Faces dragImpulse_;             ///< what drag gives the fabric before its own speed counts: D' ũ_f [g cm/s]
    Faces pressureImpulse_;         ///< impulse of the pressure per volume, dt ∇p [g/(cm^2 s)]
    Faces faceImpulse_;             ///< impulse of drag, pressure and reaction on the fabric's faces [g cm/s]
    Faces scratch_;                 ///< buffer of one function at a time
    LiquidLoads loads_;
};

}  // namespace sim
