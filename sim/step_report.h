#pragma once

#include "sim/core/types.h"
#include "sim/energy_changes.h"
#include "sim/stage.h"

#include <limits>
#include <optional>
#include <string_view>

namespace sim {

/// What an iterative solve did.
struct SolveReport {
    int iterations = 0;
    double residual = 0.0;  ///< largest, relative to the largest right-hand side [-]
    bool converged = true;
};

/// What solving for the fabric took in one step.
struct FabricReport {
    int newton = 0;                    ///< iterations, of all parts of the step
    int iterations = 0;                ///< of the linear solves
    double speedError = 0.0;           ///< rms, left by the linear solves, the largest [cm/s]
    double takenFraction = 1.0;        ///< of the moves that Newton asked for, mass-weighted, the smallest that was accepted [-]
    int halvings = 0;                  ///< parts that were cut in two
    int shortened = 0;                 ///< parts accepted although less than the whole move could be taken
    int listBuilds = 0;                ///< of the list of candidates, full and partial
    int scalings = 0;                  ///< moves that had to be scaled as a whole
    std::size_t candidates = 0;        ///< pairs that may touch, at the end
    std::size_t contacts = 0;          ///< pairs that do, at the last look
    std::size_t obstacleContacts = 0;  ///< vertices and edges that touch obstacles, at the last look
    double deepest = -std::numeric_limits<double>::infinity();  ///< reach of the fabric into an obstacle, mode adaptive only [cm]
    std::optional<EnergyChanges> energyChanges;                 ///< where they are booked; what liquid did is all under Drag
};

/// Liquid that has entered and left so far; particles and fabric hold the rest.
struct Ledger {
    double emittedMass = 0.0;          ///< by sources, and in fabric that was wet at the start [g]
    double leftMass = 0.0;             ///< deleted outside the domain [g]
    Vec3 leftMomentum = Vec3::Zero();  ///< [g cm/s]
};

/// Energies of the fabric (fabric/README.md, Energy from nothing) [erg].
struct FabricEnergies {
    double kinetic = 0.0, potential = 0.0;
    double stretching = 0.0, bending = 0.0, twisting = 0.0;  ///< of yarns
    double membrane = 0.0, shellBending = 0.0;               ///< of cloth
    double contact = 0.0;                                    ///< FabricState::stored
    double elastic() const { return stretching + bending + twisting + membrane + shellBending; }
    double internal() const { return elastic() + contact; }
    double total() const { return kinetic + potential + internal(); }
};

/// Energies of the liquid (liquid/README.md, Energy) and the fabric [erg].
struct Energies {
    double kinetic = 0.0;    ///< of the particles' velocities, ½ m v²
    double modal = 0.0;      ///< of the higher modes around them
    double potential = 0.0;  ///< −m g·x
    FabricEnergies fabric;
    double total() const { return kinetic + modal + potential + fabric.total(); }
};

/// What one step did.
struct StepReport : StageTimes {
    double dt = 0.0;        ///< [s]
    double cfl = 0.0;       ///< cflNumber (time_step.h), at the beginning of the step [-]
    double maxSpeed = 0.0;  ///< of the particles at the end of the step; where it reflects, along their paths [cm/s]
    SolveReport viscosity;  ///< if it was solved for
    SolveReport withheld;   ///< of the pressure that viscosity does not feel, if it was
    SolveReport pressure;
    SolveReport reflection;
    SolveReport volume;  ///< of the correction of the volume, if it ran
    FabricReport fabric;
    std::size_t particles = 0, blocks = 0, liquidCells = 0;
    int takenBack = 0;                             ///< attempts that turned out bad before this one, each longer than the next
    bool isReflected = false;                      ///< the first of two steps: particles hold velocities that the flow never has
    Energies energies;                             ///< at the end of the step, of what the particles hold; see potentialLag
    std::optional<EnergyChanges> energyChanges;    ///< where they are booked
    double liquidMass = 0.0;                       ///< of all particles, at the end of the step [g]
    double absorbedMass = 0.0;                     ///< of liquid in the fabric, likewise [g]
    double emittedKinetic = 0.0;                   ///< of liquid that came from sources in this step [erg]
    double inflowWork = 0.0;                       ///< of the pressure on liquid that sources pressed into liquid in this step [erg]
    double capturedMass = 0.0, drippedMass = 0.0;  ///< taken up and let go by the fabric in this step [g]
    Vec3 toPins = Vec3::Zero();                    ///< momentum that pins held back in this step (Forces::pins) [g cm/s]
    std::string_view failure;                      ///< empty, or why the state can't be trusted …
    Stage failedStage = Stage::GridToParticles;    ///< … and since when
};

}  // namespace sim
