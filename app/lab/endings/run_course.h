#pragma once

#include <filesystem>
#include <string>

namespace app {

/// What the logs of a run tell about its energy and its speeds.
struct RunCourse {
    int steps = 0;
    double time = 0.0;  ///< sum of the lengths of the steps [s]
    /// Largest rise of the energy over its start, less work done from outside, over the largest kinetic energy [-]; of what rests over that which its
    /// weight would give it in a step, for each step has to find anew what holds it.
    double energyGain = 0.0;
    double largestSpeed = 0.0;     ///< largest speed of a particle of the liquid [cm/s]
    double commonSpeed = 0.0;      ///< speed of all liquid, had it the largest kinetic energy [cm/s]; 0 without liquid
    double prescribedSpeed = 0.0;  ///< speed of the fastest of solids, pins, sources and openings at any time of the run [cm/s]
    double suctionSpeed = 0.0;     ///< speed to which suction of dry fabric could take liquid [cm/s]
};

/// A run is sound if its energy is never above that of the start plus the work of sources, suction, surface tension, obstacles, moving solids
/// and pins by more than this share of its largest kinetic energy (what obstacles took counts as far as the energy fell with it).
inline constexpr double kAllowedGain = 0.01;
/// A run is sound if no particle is faster than so many times the speed of all liquid, had it all that kinetic energy, nor than so many times the
/// fastest solid or source, nor than suction could make it.
inline constexpr double kAllowedSpeed = 10.0;

/// Course of a run by steps.jsonl, energy_ledger.csv and resolved.yaml in its folder.
RunCourse courseOf(const std::filesystem::path& folder);

/// Which of the two a run breaks, and by how much; empty if none.
std::string whyUnsound(const RunCourse& course);

}  // namespace app
