#pragma once

#include "sim/liquid/push_out.h"
#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/step_report.h"
#include "sim/workspace.h"

#include <span>

namespace sim {

/// Books what each part of a step does to the energy of liquid and fabric, as the difference before and after it on the carrier it works
/// on, particles or faces (sim/README.md, Energy). Does nothing, and measures nothing, unless the workspace asks for it.
class EnergyBudget {
 public:
    EnergyBudget(const State& state, const Settings& settings, const Workspace& work, StepReport& report);

    /// Particles have come, gone, and been sorted: their modes are where they were.
    void sorted();
    /// The liquid's momenta are on the faces, gravity not yet.
    void toGrid();
    /// Gravity, or viscosity, has acted on the faces.
    void onFaces(EnergyChange change);
    /// Viscosity has acted on the faces; through it solids that move and inlets did this work [erg].
    void viscosity(double bySolids, double byOpenings);
    /// Keeps the velocities on faces, before weight is levelled or surface tension acts. Faces that fabric is on have the mixture's velocities by
    /// then, which are not looked at.
    void remember();
    /// Weight has been moved between faces that only liquid is on.
    void levelled();
    /// Surface tension has acted on faces that only liquid is on, but not yet the pressure that holds against it. Its work on faces that liquid and
    /// fabric share is part of the pressure's.
    void surfaceTension(const std::optional<Mixture::SharedFaces>& shared);
    /// The strain correction has acted on faces that only liquid is on, since remember().
    void strainCorrected();
    /// Sources that press liquid into liquid, or openings, have done this work on it [erg].
    void pressedIn(double work);
    /// Openings hold liquid whose weight had done this work on faces [erg]: it is theirs, too.
    void heldByOpenings(double work);
    /// The step was reflected: particles get the pressure's impulse against it, too, and with it the work of solids, sources and openings.
    /// @param byOpenings  work of the latter [erg]
    void reflected(double dt, double byOpenings);
    /// Back on the particles, which moved for dt [s].
    void toParticles(double dt, const PushOutTotals& pushed);
    /// Books the energy difference since the previous call under this change.
    void after(EnergyChange change);
    /// Fabric has taken liquid up, or moved some within itself: where pores lift it that is suction's work; pins bring what comes to their vertices to
    /// their speed; other velocities mix.
    /// @param pinImpulse  momentum that pins held back of each vertex [g cm/s]
    void taken(EnergyChange change, std::span<const Vec3> pinImpulse);
    /// Liquid and fabric have been solved for, over dt [s].
    /// @param gravity  that acted on the fabric: meanGravity [cm/s^2]
    void solved(const std::optional<Mixture::SeparatedPhases>& separated, double dt, const Vec3& gravity, const FabricReport& fabric);
    /// Faces behind walls have got their velocities.
    /// @param read       velocities that the particles get [cm/s]
    /// @param fall       what weight made of velocities [cm/s]
    /// @param flipRatio  share of their own velocities that the particles keep: what walls replace on faces does not reach it [-]
    void walls(const BlockArray<double, 3>& read, const Vec3& fall, double flipRatio);
    /// What solids got of the liquid on its faces is known, and so what those that move did to it: impulse times velocity on each face. That is exact
    /// where the parts booked before, by pressure, viscosity and walls, are not; the pressure's row has what they lack.
    void bookSolidsWork();
    /// The step is over.
    void finished();

 private:
    struct Energy {
        double liquidKinetic = 0.0, potential = 0.0, fabric = 0.0;  ///< fabric: all of its own
        Vec3 fabricMoment = Vec3::Zero();                           ///< Σ m x of the fabric [g cm]
        double sum() const { return liquidKinetic + potential + fabric; }
    };
    Energy currentEnergy() const;
    Vec3 fabricMoment() const;
    double particlesKinetic() const;
    double facesKinetic() const;
    /// Work of surface tension [erg]: its impulse on each face times the velocity after the projection. That velocity is divergence-free, so that a
    /// uniform pressure does none.
    double workOfSurfaceTension() const;
    /// Work of moving solids against the liquid's pressure over dt [erg]: the pressure times what flows out of cells through closed parts of faces.
    double workAgainst(const BlockArray<double>& pressure, double dt) const;
    /// Work of moving solids on the faces behind them, which get their velocity [erg]: impulse times velocity.
    double workOnFollowers(const BlockArray<double, 3>& read, const Vec3& fall, double flipRatio) const;
    /// What walls have changed of the energy of closed faces [erg].
    double gainOfClosed() const;
    void book(EnergyChange change, double energy) { (*changes_)[change] += energy; }

    const State& state_;
    const Settings& settings_;
    const Workspace& work_;
    const StepReport& report_;
    std::optional<EnergyChanges>& changes_;
    bool isSorted_ = false, isOnFaces_ = false;
    BlockArray<double, 3> mass_, fallen_;  ///< mass of the liquid on the faces [g]; velocity after gravity and viscosity [cm/s]
    BlockArray<double, 3> remembered_;     ///< velocities before they were levelled or pulled [cm/s]
    BlockArray<double, 3> pulled_;         ///< change of velocity by surface tension on faces that only liquid is on; empty without it [cm/s]
    BlockArray<double, 3> pulledMixture_;  ///< change of velocity by surface tension on all faces, if some are shared; else empty [cm/s]
    Energy last_;
    double strained_ = 0.0;   ///< what the strain correction gave on faces [erg]
    double strain_ = 0.0;     ///< energy of stretching at the beginning of the step [erg]
    double pressedIn_ = 0.0;  ///< work that the projection did for sources [erg]
    double lag_ = 0.0;        ///< staggeredPotentialOffset at the beginning of the step [erg]
};

}  // namespace sim
