#pragma once

#include "sim/coupling/coupling.h"
#include "sim/fabric/integrator.h"
#include "sim/liquid/free_liquid.h"
#include "sim/liquid/gain_at_walls.h"
#include "sim/liquid/liquid_grid.h"
#include "sim/liquid/liquid_on_solids.h"
#include "sim/liquid/openings.h"
#include "sim/liquid/pressure.h"
#include "sim/liquid/pressure_beyond.h"
#include "sim/liquid/reflection.h"
#include "sim/liquid/strain_correction.h"
#include "sim/liquid/surface_tension.h"
#include "sim/liquid/viscosity.h"
#include "sim/liquid/volume.h"
#include "sim/liquid/walls.h"
#include "sim/momentum_budget.h"
#include "sim/particles/relax.h"
#include "sim/sources/emit.h"
#include "sim/sources/enter_openings.h"
#include "sim/state_backup.h"
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
    BoundedScratch bounded;  ///< buffers of affine maps
    GatherScratch gather;
    ViscosityWorkspace viscosity;
    PressureWorkspace pressure;
    StrainWorkspace strain;
    EmissionWorkspace emission;
    std::vector<InflowCell> inflow;  ///< cells that the sources of this step press liquid into
    Openings openings;
    PassageWorkspace passage;            ///< what comes in through openings
    std::vector<InflowCell> shutInlets;  ///< buffer of a look at where inlets lead
    WallFaces wallFaces;
    ReflectionWorkspace reflection;
    VolumeWorkspace volume;
    FreeLiquid free;
    PressureBeyond beyond;
    SurfaceTensionWorkspace surfaceTension;
    std::array<AlignedArray<double>, kAxes> displacement;  ///< displacement of each particle by relaxation [cm]
    std::array<AlignedArray<double>, kAxes> places;        ///< particle positions before advection, if there are obstacles [cm]
    BlockArray<double> oldPressure;
    RelaxScratch relax;
    double packing = 1.0;                 ///< mass of a full cell relative to the density of the liquid times its volume [-]
    double relaxReach = 0.0;              ///< [cm]; 0 = relaxation is off
    std::unique_ptr<StateBackup> backup;  ///< mode adaptive: the state before the step
    GainAtWalls gainAtWalls;
    LiquidOnSolids onSolids;          ///< impulses of the liquid on solids, by faces
    ChunkSums<Impulse> pushedSolids;  ///< impulses of particles pushed out of solids, by solid [g cm/s]
    MomentumBudget momentum;
    Stage failedStage = Stage::Emit;           ///< stage of the last step that threw
    bool correctsStrain = false;               ///< the scene's free surfaces are of second order
    bool booksEnergy = false;                  ///< tell where energy goes: takes as long as a step
    std::unique_ptr<Coupling> coupling;        ///< coupling, where there are liquid and fabric
    std::unique_ptr<FabricIntegrator> fabric;  ///< integrator of the scene's fabric.solver, where there is fabric
};

}  // namespace sim
