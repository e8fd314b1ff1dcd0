#pragma once

#include "sim/energies.h"
#include "sim/fabric/fabric_report.h"
#include "sim/solvers/solve_report.h"
#include "sim/stage.h"

#include <optional>
#include <string_view>

namespace sim {

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
    int rejectedSteps = 0;                         ///< attempts that turned out bad before this one, each longer than the next
    bool isReflected = false;                      ///< the first of two steps: particles hold velocities that the flow never has
    Energies energies;                             ///< at the end of the step, of what the particles hold; see potentialLag
    std::optional<EnergyChanges> energyChanges;    ///< where they are booked
    double liquidMass = 0.0;                       ///< of all particles, at the end of the step [g]
    double absorbedMass = 0.0;                     ///< of liquid in the fabric, likewise [g]
    double emittedKinetic = 0.0;                   ///< of liquid that came from sources in this step [erg]
    double inflowWork = 0.0;                       ///< of the pressure on liquid that sources pressed into liquid in this step [erg]
    double capturedMass = 0.0, drippedMass = 0.0;  ///< taken up and let go by the fabric in this step [g]
    Vec3 pinImpulse = Vec3::Zero();                ///< momentum that pins held back in this step (Forces::pins) [g cm/s]
    std::string_view failure;                      ///< empty, or why the state can't be trusted …
    Stage failedStage = Stage::GridToParticles;    ///< … and since when
};

}  // namespace sim
