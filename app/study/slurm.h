#pragma once

#include "app/study/run_study.h"

namespace app {

/// The batch script of an array of jobs, one for each of these runs, at most `width` of them at a time. Each job does
/// its run as `drench sweep` would here.
std::string slurmScript(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width);

/// Write the script into the study's folder and hand it to Slurm. Waits for all jobs if wanted, as long as nobody asks to stop: the
/// jobs then go on by themselves. False if it did not wait to their end. Throws InputError where there is no Slurm, and
/// std::runtime_error with Slurm's own words where it takes no jobs.
bool runOnSlurm(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width, bool wait,
                const std::function<bool()>& stopWanted);

}  // namespace app
