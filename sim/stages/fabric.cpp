#include "sim/stages/stages.h"

#include <optional>

namespace sim {

void fabricToGrid(StepContext& c)
{
    if (!c.work.fabric) return;
    const StageScope scope(c.clock);
    c.work.fabric->prepare(c.state.fabric, c.clock);
}

void findMixture(StepContext& c)
{
    if (!c.plan.overlapsFabric()) return;
    const StageScope scope(c.clock, Stage::Mixture);
    const std::optional<FabricFaces> faces = c.work.fabric->faces();
    // To reflect some faces of a liquid only would make momentum; those with fabric are not reflected (liquid/README.md, Reflection).
    c.plan.reflects = false;
    std::span<const double> distance;
    if (isDragByFabric(c.settings().coupling)) distance = c.plan.aroundFabric->distances();
    const Mixture::MetFabric fabric{*c.plan.vertices, c.state.fabric, distance, faces ? &*faces : nullptr};
    c.plan.sharedFaces = c.work.coupling->mixture.findSharedFaces(c.cut(), c.gravityOnFabric(), c.dt, fabric, c.work.grid);
}

void advanceFabric(StepContext& c)
{
    Workspace& work = c.work;
    FabricState& state = c.state.fabric;
    if (!work.fabric) return;
    const StageScope scope(c.clock);
    if (work.coupling) work.coupling->velocityBefore = state.v;
    FabricLoads loads;
    std::optional<FaceLoads> onFaces;
    if (c.plan.eliminatedDrag) {
        c.clock.start(Stage::Mixture);
        Mixture& mixture = work.coupling->mixture;
        c.plan.appliedPressure = mixture.applyPressure(*c.plan.eliminatedDrag, work.grid);
        if (work.fabric->faces()) loads.onFaces = &onFaces.emplace(mixture.faceLoads(*c.plan.appliedPressure));
        else loads.onVertices = &mixture.vertexLoads(*c.plan.appliedPressure);
    }
    c.report.fabric = work.fabric->advance(c.state.time, c.dt, c.gravityOnFabric(), state, c.clock, loads);
    if (work.backup) c.report.fabric.deepest = work.fabric->deepestInObstacles(state);
}

void separateMixture(StepContext& c)
{
    if (!c.plan.appliedPressure) return;
    const StageScope scope(c.clock, Stage::Mixture);
    Mixture& mixture = c.work.coupling->mixture;
    const Mixture::AppliedPressure& pressed = *c.plan.appliedPressure;
    const std::optional<FabricFaces> faces = c.work.fabric->faces();
    c.plan.separatedPhases =
        faces ? mixture.recoverPhaseVelocities(pressed, *faces, c.work.grid) : mixture.recoverPhaseVelocities(pressed, c.state.fabric, c.work.grid);
}

void bookSolution(StepContext& c)
{
    const Vec3 gravity = c.gravityOnFabric();
    if (c.work.fabric) c.work.momentum.fabricMoved(c.dt, gravity, c.state);
    c.energy.solved(c.plan.separatedPhases, c.dt, gravity, c.report.fabric);
}

void removeDisplaced(StepContext& c)
{
    if (!c.plan.sharedFaces) return;
    const StageScope scope(c.clock, Stage::Mixture);
    c.work.coupling->mixture.removeDisplacedMass(*c.plan.sharedFaces, c.work.grid);
}

}  // namespace sim
