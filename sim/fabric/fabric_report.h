#pragma once

#include "sim/energy_changes.h"

#include <cstddef>
#include <limits>
#include <optional>

namespace sim {

/// What solving for the fabric took in one step.
struct FabricReport {
    int newton = 0;                                             ///< iterations, of all parts of the step
    int iterations = 0;                                         ///< iterations of the linear solves
    double speedError = 0.0;                                    ///< rms, left by the linear solves, the largest [cm/s]
    double acceptedFraction = 1.0;                              ///< smallest fraction accepted of the moves that Newton asked for, mass-weighted [-]
    int substepSplits = 0;                                      ///< parts that were cut in two
    int truncatedSubsteps = 0;                                  ///< parts accepted although less than the whole move could be taken
    int candidateListBuilds = 0;                                ///< full and partial builds of the list of candidates
    int globalScalings = 0;                                     ///< moves that had to be scaled as a whole
    std::size_t candidates = 0;                                 ///< pairs that may touch, at the end
    std::size_t contacts = 0;                                   ///< pairs that do, at the last look
    std::size_t obstacleContacts = 0;                           ///< vertices and edges that touch obstacles, at the last look
    double deepest = -std::numeric_limits<double>::infinity();  ///< reach of the fabric into an obstacle, mode adaptive only [cm]
    std::optional<EnergyChanges> energyChanges;                 ///< changes of energy where they are booked; what liquid did is all under Drag
};

}  // namespace sim
