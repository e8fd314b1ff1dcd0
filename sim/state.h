#pragma once

#include "sim/fabric/fabric.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/ledger.h"
#include "sim/particles/liquid_particles.h"

#include <array>
#include <limits>
#include <vector>

namespace sim {

/// Of a source that flows.
struct SourceMemory {
    double owed = 0.0;     ///< that it was asked for and has not given; negative: given in advance [cm^3]
    double toPress = 0.0;  ///< of it, what is to be pressed into the liquid around [cm^3]
    double crowded = 0.0;  ///< pressed in, for which the projection has not made room yet [cm^3]
    double freely = 0.0;   ///< that it gave of late where there was room, fading as it moves on by a few pitches [cm^3]
    double covered = 0.0;  ///< share of its inlet that is covered by liquid that does not move along [-]
    double laidAt = -std::numeric_limits<double>::infinity();  ///< when particles were last laid, or would have been [s]
    double isShut = 0.0;  ///< 1 where it has nowhere to go: the liquid around it fills all that is open to it; else 0
};

/// What steps that were taken tell those to come: how long they may be, and what is to be expected of them.
struct StepMemory {
    double maxSpeed = 0.0;                                     ///< of the liquid, as the last step found it [cm/s]
    double longest = std::numeric_limits<double>::infinity();  ///< that a step may be after one was taken back [s]
    /// Of motion and elasticity at the ends of the last steps [erg]: what contact took in them it may give back.
    std::array<double, 8> energies{};
    int next = 0;                                              ///< element of them to be overwritten
    double internal = 0.0;                                     ///< of fabric, at the end of the last step [erg]
    double deepest = std::numeric_limits<double>::infinity();  ///< that fabric was in an obstacle then; before the first step it may be anywhere [cm]
    std::vector<SourceMemory> sources;                         ///< as many as the scene has, once any was looked at
};

/// All that evolves but the liquid's particles, which are most of it.
struct StateBesideLiquid {
    double time = 0.0;                    ///< [s]
    std::int64_t step = 0;                ///< steps taken
    double lastDt = 0.0;                  ///< length of the last step, since whose gather the particles have moved; 0 before the first [s]
    bool reflected = false;               ///< the last step was the first of two: particles hold reflected velocities
    std::uint32_t nextId = 0;             ///< id of the next particle to be born
    BlockGrid grid;                       ///< the blocks of the last step …
    BlockArray<double> pressure;          ///< … and the pressure in them, from where the next solve starts [dyn/cm^2]
    BlockArray<double> pressureOfStrain;  ///< the part of it that the strain correction called for; empty before there was one [dyn/cm^2]
    FabricState fabric;
    std::vector<double> emittedVolume;  ///< by each source so far [cm^3]
    double unrelaxed = 0.0;             ///< time since the particles were last relaxed [s]
    double uncorrected = 0.0;           ///< time since the liquid's volume was last corrected [s]
    Ledger ledger;
    StepMemory memory;
};

/// Everything that evolves: a checkpoint is exactly this. What can be computed from it anew lives in Workspace (workspace.h).
struct State : StateBesideLiquid {
    LiquidParticles liquid;
};

/// Is there liquid, or are there blocks of the grid that liquid has just left?
inline bool hasLiquid(const State& state) { return state.liquid.count > 0 || state.grid.count() > 0; }

}  // namespace sim
