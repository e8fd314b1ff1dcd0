#pragma once

#include "sim/core/check.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// What a text may ask of this machine. Scenes of one's own may ask for much; readers of texts from anywhere allow less.
struct ReadingBounds {
    std::filesystem::path folder = {};  ///< the files it names must lie below; empty: anywhere
    std::size_t values = 500'000;       ///< words, lists and maps, aliases copied out
    int vertices = 5'000'000;           ///< bound of the vertices of all fabrics
    std::size_t maxBoxes = 100'000;     ///< into which a source is cut to measure its volume
};

class KeyList;

/// One scene file, or one override of the command line, as messages name it.
struct TextSource {
    std::string name;             ///< "scenes/drop.yaml", or "--set time.dt=1e-3"
    bool numbered = true;         ///< messages add the line
    bool isSi = false;            ///< unit system of its bare numbers: cgs, or si
    std::string directory = ".";  ///< what the file names in it are relative to
    ReadingBounds bounds = {};
    std::function<void(const KeyList&)> listener = {};  ///< hears of every map that is read what keys it may have
};

/// Where in the user's text a value stands. Survives merging, so that every complaint can name a line.
struct SourceLocation {
    std::shared_ptr<const TextSource> source;
    int line = 0;

    /// "drop.yaml:14", or the override as it was given.
    std::string text() const;
};

/// Throws InputError where the file does not lie below the folder that the bounds of the location's text name.
void requireAllowed(const std::filesystem::path& file, const SourceLocation& location);

/// Throws InputError "location: message", as one line.
[[noreturn]] void fail(const SourceLocation& location, const std::string& message);
[[noreturn]] void fail(const std::string& where, const std::string& message);

/// The text in quotation marks for a message: control characters shown as '?', long ones cut.
std::string inQuotes(std::string_view text, std::size_t shown = 48);
/// A path in quotation marks for a message, in full.
std::string fileInQuotes(const std::string& path);

/// " (did you mean "viscosity"?)", or " (there is density, viscosity)" where nothing is near; a handful at most.
std::string suggestion(std::string_view text, const std::vector<std::string>& known);

/// "time" and "dt" → "time.dt".
std::string joinPath(const std::string& path, const std::string& key);

/// "a, b, c", cut after `limit` names.
std::string listed(const std::vector<std::string>& names, std::size_t limit = 30);

}  // namespace sim
