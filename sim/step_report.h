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
    double maxSpeed = 0.0;  ///< largest speed of the particles at the end of the step; where it reflects, along their paths [cm/s]
    SolveReport viscosity;  ///< empty if it was not solved for
    SolveReport withheld;   ///< solve of the pressure that viscosity does not feel; empty without
    SolveReport pressure;
    SolveReport reflection;
    SolveReport volume;  ///< solve of the correction of the volume; empty if it did not run
    FabricReport fabric;
    std::size_t particles = 0, blocks = 0, liquidCells = 0;
    int rejectedSteps = 0;                         ///< attempts that turned out bad before this one, each longer than the next
    bool isReflected = false;                      ///< the first of two steps: particles hold velocities that the flow never has
    Energies energies;                             ///< energies at the end of the step, of what the particles hold; see staggeredPotentialOffset
    std::optional<EnergyChanges> energyChanges;    ///< empty unless energies are booked
    double liquidMass = 0.0;                       ///< mass of all particles at the end of the step [g]
    double absorbedMass = 0.0;                     ///< mass of liquid in the fabric at the end of the step [g]
    double emittedKinetic = 0.0;                   ///< kinetic energy of liquid that came from sources and through openings in this step [erg]
    double inflowWork = 0.0;                       ///< work on the liquid of sources that press it into liquid, and of openings, in this step [erg]
    double capturedMass = 0.0, drippedMass = 0.0;  ///< mass that the fabric took up and let go in this step [g]
    Vec3 pinImpulse = Vec3::Zero();                ///< momentum that pins held back in this step (Forces::pins) [g cm/s]
    std::string_view failure;                      ///< reason the state is invalid; empty if valid
    Stage failedStage = Stage::GridToParticles;    ///< stage in which `failure` was found
};

}  // namespace sim
