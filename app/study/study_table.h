#pragma once

#include "app/study/run_study.h"

namespace app {

/// study.csv and study.md in the study's folder: a row for each run, with what it sets and what came out; and a plot for each
/// parameter with numbers, where there is a gnuplot. Returns the text of study.md.
std::string gatherStudy(const Study& study, const StudyPlaces& places);

}  // namespace app
