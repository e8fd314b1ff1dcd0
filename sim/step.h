#pragma once

#include "sim/coupling/coupling.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/led_fabric.h"
#include "sim/fabric/vertex_solver.h"
#include "sim/kept_state.h"
#include "sim/liquid/free_liquid.h"
#include "sim/liquid/walls.h"
#include "sim/liquid/liquid_grid.h"
#include "sim/liquid/gain_at_walls.h"
#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/pressure.h"
#include "sim/liquid/reflection.h"
#include "sim/liquid/surface_tension.h"
#include "sim/liquid/viscosity.h"
#include "sim/liquid/volume.h"
#include "sim/momentum_book.h"
#include "sim/particles/emit.h"
#include "sim/particles/relax.h"
#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/transfer/gather.h"
#include "sim/transfer/scatter_bounded.h"

#include <memory>

namespace sim {

/// What a step needs beside the State: computed anew in every step, or buffers kept so that nothing is allocated.
struct Workspace {
    ParticleOrder order;
    Obstacles obstacles;
    ObstacleField obstacleField;
    LiquidGrid grid;
    ScatterScratch scatter;
    BoundedScratch bounded;  ///< of affine maps
    GatherScratch gather;
    ViscosityWorkspace viscosity;
    PressureWorkspace pressure;
    EmissionWorkspace emission;
    std::vector<InflowCell> inflow;                        ///< of the sources of this step
    WallFaces wallFaces;
    ReflectionWorkspace reflection;
    VolumeWorkspace volume;
    FreeLiquid free;
    SurfaceTensionWorkspace surfaceTension;
    std::array<AlignedArray<double>, kAxes> displacement;  ///< of each particle by relaxation [cm]
    std::array<AlignedArray<double>, kAxes> places;        ///< of the particles before they move, where there are obstacles [cm]
    BlockArray<double> oldPressure;
    RelaxScratch relax;
    double packing = 1.0;                                  ///< mass of a full cell relative to the density of the liquid times its volume [-]
    double relaxReach = 0.0;                               ///< [cm]; 0 = relaxation is off
    std::unique_ptr<KeptState> kept;                       ///< mode adaptive: the state before the step
    GainAtWalls gainAtWalls;
    LiquidOnSolids onSolids;                               ///< by the faces of the liquid …
    ChunkSums<Impulse> pushedSolids;                       ///< … and by particles kept out of solids [g cm/s]
    MomentumBook momentum;
    Stage failedStage = Stage::Emit;                       ///< in which a step ended that threw
    bool booksEnergy = false;                              ///< tell where energy goes: takes as long as a step
    std::unique_ptr<Coupling> coupling;                    ///< where there are liquid and fabric
    std::unique_ptr<VertexSolver> fabric;                  ///< by the scene's solver one of these three, where there is fabric
    std::unique_ptr<GridFabricSolver> gridFabric;
    std::unique_ptr<LedFabric> ledFabric;
};

/// Advance liquid and fabric by dt [s] (sim/README.md, The step). What is not there runs none of its stages.
StepReport step(State& state, const Scene& scene, Workspace& work, double dt);

/// With the integrator reflected, particles hold the velocities that they had halfway through their last step. Energies are those of
/// then: by this much the potential energy was above that of the present places [erg], 0 after a step that reflects. Taken at different
/// times their sum would swing by dt/2 times the power of the weight.
double potentialLag(const State& state, const Settings& settings);

/// Is the next step to reflect, if it is not the second of two? Liquid near fabric is not reflected.
bool mayReflect(const State& state, const TimeSettings& time, const Workspace& work);

/// Largest stable time step from here [s], by the scene's mode and bounds (sim/README.md, Length of a step), not yet fitted to a frame.
double chooseTimeStep(const Settings& settings, const State& state, double maxSpeed);

/// dt (max speed + sqrt(h |g|)) / h (sim/README.md, Length of a step).
double cflNumber(const Settings& settings, double maxSpeed, double dt);

}  // namespace sim
