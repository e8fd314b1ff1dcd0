#pragma once

#include "app/study/run_study.h"

#include <cstddef>
#include <functional>

namespace app {

/// Where and how the runs of a study are done.
struct StudyWork {
    int jobs = 1;          ///< side by side
    bool all = false;      ///< those that are done, too
    bool onSlurm = false;  ///< as jobs of Slurm
    bool wait = true;      ///< for those
};

/// How a study stands.
struct StudyEnd {
    std::size_t left = 0;    ///< runs that did not get to their end
    bool isOver = true;      ///< nothing goes on by itself
    bool isStopped = false;  ///< by the user
};

/// Do what is not done yet, and tell how each ends.
StudyEnd doStudy(const Study& study, const StudyPlaces& places, const StudyWork& work, const std::function<bool()>& stopWanted);

/// 0 where all is done, or left to Slurm as was asked for; else 1, and the user is told why.
int exitCodeOf(const Study& study, const StudyEnd& end);

}  // namespace app
