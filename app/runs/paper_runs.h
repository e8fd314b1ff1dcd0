#pragma once

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
};

/// In the order of the paper's table.
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
    std::vector<ComparedRun> runs;  ///< that got to their end
};

/// The paper's table (Markdown): duration, time step, mean seconds per step, minutes, peak memory, mean numbers of particles (those of
/// liquid and the vertices), of liquid ones, and of elements.
std::string paperTable(const std::vector<PaperResult>& results);

/// table.md, energy_dam_break.png and energy_splash.png with their scripts, and with pictures sheet.png: a row per scene.
void makePaper(const std::vector<PaperResult>& results, const Backends& backends, bool withFrames, const std::filesystem::path& folder);

}  // namespace app
