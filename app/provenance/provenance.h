#pragma once

#include "app/scene/loaded_scene.h"

#include <string>

namespace app {

/// "Drench 0.1.0 (1d5edce9…)": what makes results, as short as pictures and geometry say it.
std::string programName();

/// The processor as it calls itself; "unknown" where it does not.
std::string processorName();

/// Text of JSON that tells on what a run is made, and from what: program, compiler, machine, libraries, command line, start, the scene as
/// written and resolved.
/// @param drawnBy  what draws the pictures, with its version; empty without pictures
/// @param before   the same text of the run that is gone on with, or whose states are used; empty for one from the start
std::string provenanceOf(const LoadedScene& setup, int threads, const std::string& drawnBy, const std::string& before);

}  // namespace app
