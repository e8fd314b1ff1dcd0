#include "sim/time_step.h"

#include "sim/core/parallel.h"
#include "sim/liquid/energy.h"
#include "sim/workspace.h"

#include <algorithm>
#include <cmath>

namespace sim {

double cflNumber(const Settings& settings, double maxSpeed, double dt)
{
    return dt * (maxSpeed + std::sqrt(settings.cell * settings.gravity.norm())) / settings.cell;
}

double chooseTimeStep(const Settings& settings, const State& state, double maxSpeed)
{
    const TimeSettings& time = settings.time;
    double dt = time.dt;
    if (settings.fabric.solver == FabricSolver::Grid) {
        const std::vector<Vec3>& v = state.fabric.v;
        const double fastest = std::sqrt(parallelMax(v.size(), [&](std::size_t i) { return v[i].squaredNorm(); }));
        if (fastest > 0.0) dt = std::min(dt, time.maxCflFabric * settings.cell / fastest);
    }
    if (!hasLiquid(state)) return dt;
    const double perCfl = 1.0 / cflNumber(settings, maxSpeed, 1.0);
    const double bound = time.mode == TimeMode::Fixed ? time.maxCflLiquid : std::min(time.cfl, time.maxCflLiquid);
    if (feelsSurfaceTension(settings.liquid)) dt = std::min(dt, capillaryTimeStep(settings.liquid, settings.cell));
    return std::min(dt, bound * perCfl);
}

bool mayReflect(const State& state, const TimeSettings& time, const Workspace& work)
{
    return time.reflects() && hasLiquid(state) && !(work.coupling && reachesLiquid(state.grid, state.fabric));
}

double staggeredPotentialOffset(const State& state, const Settings& settings)
{
    if (!settings.time.reflects() || state.reflected) return 0.0;
    return weightWork(state.liquid, settings.gravity, 0.5 * state.lastDt);
}

}  // namespace sim
