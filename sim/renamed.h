#pragma once

#include <span>
#include <string>
#include <string_view>

// Public words that were called otherwise before: the one table of them, by which readers of scenes, of files of runs and of the command
// line take the old names, too. What is written has the new ones.

namespace sim {

/// The version that reads the old names no more.
inline constexpr std::string_view kOldNamesEnd = "0.2.0";

struct Renamed {
    std::string_view before, now;
    bool isComplement = false;  ///< the value is 1 less the one before
};

/// Keys of scenes, with dots between; all below such a key goes with it.
std::span<const Renamed> renamedKeys();
/// Fields of report.json, steps.jsonl and checkpoints with slashes between, and columns of energy_ledger.csv.
std::span<const Renamed> renamedFields();
/// Options of the command line.
std::span<const Renamed> renamedOptions();

/// What a field or column of a file is called now: "seconds/backup" for "seconds/keep"; its own name where nothing has changed.
std::string currentName(std::string_view field);
/// What a field or column of a file was called before; its own name where nothing has changed.
std::string formerName(std::string_view field);

}  // namespace sim
