#pragma once

#include "app/backends.h"
#include "app/system/process_pool.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// One way to compute a scene: what is overridden for it.
struct StabilityMethod {
    std::string name;  ///< "polypic_8 vertex stiffness*0.1"
    std::vector<std::string> sets;
};

/// One run of one method at one time step.
struct StabilityRow {
    std::string method;
    double dt = 0.0, duration = 0.0;  ///< [s]
    bool isStable = false;
    std::string why;            ///< reason where it is not stable, one line without commas
    double energyGain = 0.0;    ///< largest rise of the energy over its start, less work done from outside, over the largest kinetic energy [-]
    double largestSpeed = 0.0;  ///< largest speed of the liquid [cm/s]
    double seconds = 0.0;       ///< wall
};

/// What to map for one scene.
struct StabilityMap {
    std::string scene;              ///< scene file
    std::vector<std::string> sets;  ///< settings of all runs
    std::vector<StabilityMethod> methods;
    std::vector<double> steps;     ///< [s]
    double duration = 0.0;         ///< duration of every run: a whole number of the longest step [s]
    std::filesystem::path folder;  ///< scene's own: map.csv, map.png, and a folder per run
    bool largestOnly = false;      ///< runs each method only from the longest step to the first that is stable
    int width = 1;                 ///< so many runs side by side, each on one thread
    double limitSeconds = 3600.0;
    std::function<bool()> stopWanted = [] { return false; };
};

/// PIC, APIC and PolyPIC of 8, 11, 15 and 27 modes, those of them that are named (none: all), with each fabric solver where the
/// scene has fabric. Throws InputError for a name that there is not.
std::vector<StabilityMethod> stabilityMethods(const LoadedScene& setup, const std::vector<std::string>& names);

/// Methods with one number of the scene made larger or smaller by factors: stiffness, density, viscosity or cell. Throws
/// InputError for another one.
std::vector<StabilityMethod> withParameter(const std::vector<StabilityMethod>& methods, const LoadedScene& setup, const std::string& parameter,
                                           const std::vector<double>& factors);

/// Judge a run by how it ended and its logs in the folder.
StabilityRow judgeStability(const ProcessEnd& end, const std::filesystem::path& folder, StabilityRow row);

/// Run what map.csv does not have yet. Returns all its rows, also those of earlier calls.
std::vector<StabilityRow> runStabilityMap(const StabilityMap& map);

/// Rows as map.csv has them, and back.
std::string stabilityTable(const std::vector<StabilityRow>& rows);
std::vector<StabilityRow> readStabilityTable(const std::filesystem::path& csv);

/// The largest step at which it and every shorter one tried is stable; 0 if there is none [s].
double largestStableStep(const std::vector<StabilityRow>& rows, const std::string& method, double duration);

}  // namespace app
