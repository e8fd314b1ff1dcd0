#pragma once

#include "sim/fabric/fabric.h"
#include "sim/grid/block_grid.h"
#include "sim/opening_settings.h"
#include "sim/particles/ledger.h"
#include "sim/particles/liquid_particles.h"

#include <array>
#include <limits>
#include <vector>

namespace sim {

/// What a flowing source remembers from step to step.
struct SourceMemory {
    double owed = 0.0;     ///< volume demanded and not yet emitted; negative if emitted in advance [cm^3]
    double toPress = 0.0;  ///< part of `owed` that is to be pressed into the liquid around [cm^3]
    double crowded = 0.0;  ///< volume pressed in for which the projection has not made room yet [cm^3]
    double freely = 0.0;   ///< volume emitted recently without pressing, decaying over a few particle spacings [cm^3]
    double covered = 0.0;  ///< share of its inlet that is covered by liquid that does not move along [-]
    double laidAt = -std::numeric_limits<double>::infinity();  ///< time at which particles were last laid, or would have been [s]
    double isShut = 0.0;  ///< 1 where it has nowhere to go: the liquid around it fills all that is open to it; else 0
};

/// What steps that were taken tell those to come: how long they may be, and what is to be expected of them.
struct StepHistory {
    double maxSpeed = 0.0;                                     ///< largest speed of the liquid, as the last step found it [cm/s]
    Vec3 sinceMidstep = Vec3::Zero();                          ///< what the liquid's mean velocity is beyond that of its particles [cm/s]
    double longest = std::numeric_limits<double>::infinity();  ///< largest step allowed after a rejected one [s]
    /// Energies of motion and elasticity at the ends of the last steps [erg]: what contact took in them it may give back.
    std::array<double, 8> energies{};
    int next = 0;           ///< element of `energies` to be overwritten next
    double internal = 0.0;  ///< elastic energy of the fabric at the end of the last step [erg]
    double deepest =
        std::numeric_limits<double>::infinity();  ///< deepest penetration of fabric into an obstacle; infinite before the first step [cm]
    std::vector<SourceMemory> sources;            ///< as many as the scene has, once any was looked at
    std::vector<OpeningMemory> openings;          ///< as many as the scene has
};

/// All that evolves but the liquid's particles, which are most of it.
struct NonParticleState {
    double time = 0.0;                        ///< [s]
    std::int64_t step = 0;                    ///< steps taken
    double lastDt = 0.0;                      ///< length of the last step, since whose gather the particles have moved; 0 before the first [s]
    bool reflected = false;                   ///< the last step was the first of two: particles hold reflected velocities
    std::uint32_t nextId = 0;                 ///< id of the next particle to be born
    BlockGrid grid;                           ///< blocks of the last step
    BlockArray<double> pressure;              ///< pressure in these blocks, from which the next solve starts [dyn/cm^2]
    BlockArray<double> pressureOfStrain;      ///< part of it that the strain correction called for; empty before there was one [dyn/cm^2]
    BlockArray<double> pressureOfReflection;  ///< while `reflected`: what the second of the two steps has no need of any more [dyn/cm^2]
    FabricState fabric;
    std::vector<double> emittedVolume;  ///< volume emitted by each source so far [cm^3]
    double unrelaxed = 0.0;             ///< time since the particles were last relaxed [s]
    double uncorrected = 0.0;           ///< time since the liquid's volume was last corrected [s]
    Ledger ledger;
    StepHistory memory;
};

/// Everything that evolves: a checkpoint is exactly this. What can be computed from it anew lives in Workspace (workspace.h).
struct State : NonParticleState {
    LiquidParticles liquid;
};

/// Is there liquid, or are there blocks of the grid that liquid has just left?
inline bool hasLiquid(const State& state) { return state.liquid.count > 0 || state.grid.count() > 0; }

}  // namespace sim
