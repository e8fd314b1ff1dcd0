#pragma once

#include "app/study/run_study.h"

#include <cstddef>
#include <functional>

namespace app {

/// Where and how the runs of a study are done.
struct StudyWork {
    int jobs = 1;          ///< side by side
    bool all = false;      ///< whether runs that are done are made again too
    bool onSlurm = false;  ///< whether runs are jobs of Slurm
    bool wait = true;      ///< whether to wait for the runs
};

/// How a study stands.
struct StudyEnd {
    std::size_t left = 0;    ///< runs that did not get to their end
    bool isOver = true;      ///< nothing goes on by itself
    bool isStopped = false;  ///< whether the user stopped it
};

/// Do what is not done yet, and tell how each ends.
StudyEnd doStudy(const Study& study, const StudyPlaces& places, const StudyWork& work, const std::function<bool()>& stopWanted);

/// 0 where all is done, or left to Slurm as was asked for; else 1, and the user is told why.
int exitCodeOf(const Study& study, const StudyEnd& end);

}  // namespace app
