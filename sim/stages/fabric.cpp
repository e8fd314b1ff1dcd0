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
    if (!c.plan.meetsFabric) return;
    const StageScope scope(c.clock, Stage::Mixture);
    const std::optional<FabricFaces> faces = c.work.fabric->faces();
    // To reflect some faces of a liquid only would make momentum; those with fabric are not reflected (liquid/README.md, Reflection).
    c.plan.reflects = false;
    c.plan.isMixed =
        c.work.coupling->mixture.findSharedFaces(c.cut(), c.gravityOnFabric(), c.dt, c.state.fabric, faces ? &*faces : nullptr, c.work.grid);
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
    if (c.plan.isMixed) {
        c.clock.start(Stage::Mixture);
        if (work.fabric->faces()) loads.onFaces = &onFaces.emplace(work.coupling->mixture.faceLoads(work.grid));
        else loads.onVertices = &work.coupling->mixture.loads(work.grid);
    }
    c.report.fabric = work.fabric->advance(c.state.time, c.dt, c.gravityOnFabric(), state, c.clock, loads);
    if (work.backup) c.report.fabric.deepest = work.fabric->deepestInObstacles(state);
}

void separateMixture(StepContext& c)
{
    if (!c.plan.isMixed) return;
    const StageScope scope(c.clock, Stage::Mixture);
    Mixture& mixture = c.work.coupling->mixture;
    if (const std::optional<FabricFaces> faces = c.work.fabric->faces()) mixture.recoverPhaseVelocities(*faces, c.work.grid);
    else mixture.recoverPhaseVelocities(c.state.fabric, c.work.grid);
}

void bookSolution(StepContext& c)
{
    const Vec3 gravity = c.gravityOnFabric();
    if (c.work.fabric) c.work.momentum.fabricMoved(c.dt, gravity, c.state);
    c.energy.solved(c.plan.isMixed, c.dt, gravity, c.report.fabric);
}

void removeDisplaced(StepContext& c)
{
    if (!c.plan.isMixed) return;
    const StageScope scope(c.clock, Stage::Mixture);
    c.work.coupling->mixture.removeDisplacedMass(c.work.grid);
}

}  // namespace sim
