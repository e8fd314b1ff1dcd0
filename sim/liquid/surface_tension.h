#pragma once

#include "sim/liquid/curvature.h"
#include "sim/liquid/pressure.h"

namespace sim {

/// What surface tension keeps from step to step.
struct SurfaceTensionWorkspace {
    Curvature curvature;
    BlockArray<double, 3> step;  ///< step of the pressure across each lower face, upwards: ±σ κ between liquid and air, else 0 [dyn/cm²]
};

/// Token that the steps are known, until the next findSurfaceSteps in the same workspace.
class SurfaceSteps {
 public:
    const BlockArray<double, 3>& step() const { return work_->step; }

 private:
    friend SurfaceSteps findSurfaceSteps(const CutGrid& cut, const LiquidSettings& settings, const SurfaceCells& cells,
                                         SurfaceTensionWorkspace& work);
    explicit SurfaceSteps(const SurfaceTensionWorkspace& work) : work_(&work) {}

    const SurfaceTensionWorkspace* work_;
};

/// The step of the pressure, σ κ, across every face between liquid and air (liquid/README.md, Surface tension).
SurfaceSteps findSurfaceSteps(const CutGrid& cut, const LiquidSettings& settings, const SurfaceCells& cells, SurfaceTensionWorkspace& work);

/// Air presses with σ κ instead of nothing (ghost fluid: Kang, Fedkiw and Liu 2000). This is the part of the pressure's
/// gradient that is known before the solve: u −= dt β step / dx. The projection that follows then finds the pressure
/// that holds against it, σ κ in a drop at rest, and does on each of these faces what one with that value in the air
/// would do.
///
/// On faces that fabric is on it acts on both phases as the pressure does, so that the forces on a closed surface add up
/// to nothing there, too: by coefficients that Mixture::eliminateDrag has changed. What reflection reflects knows nothing of it, as of weight:
/// its pressure is 0 in the air, and tension is in the velocities that it starts from.
/// @param share  of the step for which tension acts [-]
void applySurfaceSteps(const CutGrid& cut, const PressureFaces& faces, double share, const SurfaceSteps& steps, LiquidGrid& liquid);

/// Does surface tension move this liquid? Without air it has no surface.
inline bool feelsSurfaceTension(const LiquidSettings& settings)
{
    return settings.surfaceTensionForce && settings.surfaceTension > 0.0 && !settings.full;
}

/// Largest stable step of surface tension, which is explicit: √(ρ h³ / (4 π σ)) (Brackbill, Kothe and Zemach 1992, with
/// air of no density) [s].
double capillaryTimeStep(const LiquidSettings& settings, double cell);

}  // namespace sim
