#pragma once

#include "app/ensemble/difference.h"
#include "app/runs/compare.h"

#include <string>
#include <vector>

namespace app {

/// One of the scenes that the PolyPIC paper reports on.
struct PaperScene {
    std::string name;                ///< scenes/<name>.yaml
    std::string example;             ///< as the paper's table names it
    bool hasFabric = true;           ///< is in the second of its energy plots
    std::vector<std::string> quick;  ///< overrides that shorten it
    double stepCost = 1.0;           ///< what a step takes, relative to those of the other scenes
};

/// Scenes of the paper, in the order of its table.
const std::vector<PaperScene>& paperScenes();

/// A variant that each of them has, with the paper's parameters, at one time step.
struct PaperVariant {
    std::string name, method;
};
inline const std::vector<PaperVariant> kPaperVariants = {{"paper_apic", "APIC"}, {"paper_polypic", "PolyPIC"}};

/// What was run of one scene.
struct PaperResult {
    PaperScene scene;
    PictureSettings pictures;
    std::vector<ComparedRun> runs;    ///< runs that got to their end
    std::vector<Ensemble> ensembles;  ///< each of those with its repeats; none without repeats
};

/// Runs of a scene with the paper's variants again, with other random numbers for where particles are laid.
/// @param repeats  of each in all, the first among them
std::vector<ComparedRun> repeatsOf(const std::vector<ComparedRun>& runs, int repeats, const Backends& backends, const std::filesystem::path& folder);

/// Each run with those of its repeats that are done. Those of which nothing but the run itself is done are left out.
std::vector<Ensemble> ensemblesOf(const std::vector<ComparedRun>& runs, const std::vector<ComparedRun>& repeats);

/// The paper's table (Markdown): duration, time step, mean seconds per step, minutes, peak memory, mean numbers of particles (those of
/// liquid and the vertices), of liquid ones, and of elements. Of repeats it has means ± standard deviations.
std::string paperTable(const std::vector<PaperResult>& results);

/// What stands above the table: a title, and with repeats what its numbers are.
std::string paperHead(const std::vector<PaperResult>& results);

/// Claims of the paper in which the methods differ, with confidence intervals (Markdown); "" without repeats.
std::string paperClaims(const std::vector<PaperResult>& results);

/// The row of the sheet with a scene's pictures, each with the names of scene and method.
OverviewRow overviewRow(const PaperResult& result);

/// table.md, energy_dam_break.png and energy_splash.png with their scripts, and with pictures sheet.png: a row per scene. With repeats plots have
/// bands, and what differs stands below the table and in each scene's compare.md.
void makePaper(const std::vector<PaperResult>& results, const Backends& backends, bool withFrames, const std::filesystem::path& folder);

}  // namespace app
