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

namespace sim {

/// Liquid and fabric on the faces that both reach: drag, and the pressure that keeps the mixture's volume (coupling/README.md, Mixture). The fabric's
/// own forces are solved for in vertex space; what the liquid adds to them, and they to it, cancels to round-off.
class Mixture {
 public:
    /// @param around  found before each call of findSharedFaces; goes by it where drag is by the fabric's own fraction
    Mixture(const Fabric& fabric, const LiquidAround& around, const Settings& settings, SortedVertices& vertices);

    /// The faces that both phases are on, with their drag over a step of dt [s]; to be called when the vertices are sorted and the liquid's
    /// predicted velocities are known. The volume of the fabric and of what it holds then counts as filled. False if there are none: nothing
    /// else is to be called then.
    /// @param faces  the fabric's velocities, of a solver that has its unknowns on faces; else null
    bool findSharedFaces(const CutGrid& cut, const Vec3& gravity, double dt, const FabricState& state, const FabricFaces* faces, LiquidGrid& liquid);
    /// Before the pressure: velocities of these faces become the mixture's, and coefficients those that its pressure acts with.
    /// @param coefficient  of each face of the liquid's grid, ω dt β / dx² (PressureWorkspace)
    void eliminateDrag(const ObstacleField& obstacles, LiquidGrid& liquid, BlockArray<double, 3>& coefficient);
    /// After the pressure: what it and drag do to the fabric, by vertices or by faces.
    const LiquidLoads& loads(const LiquidGrid& liquid);
    FaceLoads faceLoads(const LiquidGrid& liquid);
    /// After the fabric: the liquid's own velocities on these faces, given those of the vertices, or of the fabric's faces, at the end of
    /// the step.
    void recoverPhaseVelocities(const FabricState& state, LiquidGrid& liquid);
    void recoverPhaseVelocities(const FabricFaces& faces, LiquidGrid& liquid);

    /// The mass of the liquid's faces is that of the liquid alone again, where room that fabric takes up counted as full.
    void removeDisplacedMass(LiquidGrid& liquid) const;
    /// Before the fabric's loads are told: masses of these faces become those with which both phases together answer to a push, and changes what
    /// pressure and surface tension did to the mixture [cm/s]; a further change of the mixture's velocity acts on both.
    void toMassesOfBoth(LiquidGrid& liquid, BlockArray<double, 3>& change) const;
    void fromMassesOfBoth(LiquidGrid& liquid) const;

    /// After recoverPhaseVelocities: call f(liquid's block, axis, cell, impulse) with what drag, suction and the fabric's part of the pressure
    /// took from the liquid of each shared face [g cm/s], blocks in parallel.
    template <class F>
    void forEachImpulseTaken(F&& f) const
    {
        forEachShared([&](int b, int m, int a, int c) { f(m, a, c, impulseTaken(b, a, c)); });
    }

    /// Set what the liquid has on these faces to 0.
    void clearShared(BlockArray<double, 3>& values) const;
    void clearShared(BlockBits<3>& faces) const;

    /// Momentum of the liquid on the shared faces [g cm/s].
    Vec3 liquidMomentum(const LiquidGrid& liquid) const;
    /// Where the energy of the liquid on shared faces went in this step, by the impulses on each and the velocities they act at; and its
    /// part of what acted between both: with the work of all that liquid did to the fabric these are pressure, suction and drag.
    /// @param before  the liquid's velocities when nothing but gravity had acted
    EnergyChanges energyChanges(const LiquidGrid& liquid, const BlockArray<double, 3>& before) const;
    /// Work on liquid and fabric of a pressure that changes the mixture's velocities by so much [erg].
    double workOf(const BlockArray<double, 3>& change, const LiquidGrid& liquid) const;
    /// Kinetic energy of the liquid on the shared faces at these velocities [erg].
    double kinetic(const BlockArray<double, 3>& velocity) const;
    /// Are both phases on the lower face of a cell?
    bool isShared(int axis, const Vec3i& cell) const;

 private:
    using Faces = BlockArray<double, 3>;
    bool matchBlocks(const BlockGrid& grid);
    void findRelative(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid);
    void addSuction(const CutGrid& cut, const FabricState& state, const LiquidGrid& liquid);
    void mix(const Vec3& gravity, const ObstacleField& obstacles, const LiquidGrid& liquid);
    void addDisplacedMass(LiquidGrid& liquid) const;
    void applyPressure(const LiquidGrid& liquid);
    void recoverPhaseVelocities(LiquidGrid& liquid) const;
    double dragOn(int block, int axis, int cell, double liquidVolume, double room) const;
    bool reacts() const { return settings_.capillary && settings_.capillaryReaction; }
    double speedAt(int block, int axis, int cell) const;
    double impulseTaken(int block, int axis, int cell) const;
    void react();
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
    double dt_ = 0.0;  ///< of the step under way [s]
    SortedVertices& vertices_;
    FabricOnFaces onFaces_;
    std::vector<int> liquidBlock_;  ///< of each block of the fabric's grid; BlockGrid::kNone where there is no liquid

    // Of each face of the fabric's grid; liquidMass_ is 0 where it is not shared.
    Faces liquidMass_;              ///< [g]
    Faces relative_;                ///< velocity of the liquid past the fabric [cm/s]
    Faces liquidVolume_;            ///< on which pressure pushes the liquid [cm^3]
    Faces drag_;                    ///< D = dt c V, with the volume V that drag acts on (dragOn) [g]
    Faces predicted_;               ///< u_f*, later ũ_f: after the pressure [cm/s]
    Faces mixed_, mobility_;        ///< of the mixture before the pressure [cm/s]; β [cm^3/g]
    Faces suctionImpulse_;          ///< on the liquid [g cm/s] …
    Faces reaction_;                ///< … and on the fabric, of all its faces
    std::vector<Vec3> reactionOf_;  ///< the same of each vertex
    Faces onFabric_;                ///< D', of which the fabric feels D' (ũ_f − u_s) [g]
    Faces dragImpulse_;             ///< what drag gives the fabric before its own speed counts: D' ũ_f [g cm/s]
    Faces pressureImpulse_;         ///< of the pressure, per volume: dt ∇p [g/(cm^2 s)]
    LiquidLoads loads_;
};

}  // namespace sim
