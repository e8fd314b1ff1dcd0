#pragma once

#include "app/import/xml_element.h"

#include <string>
#include <vector>

namespace app {

/// What a user should know of an import: what the scene has, what was decided, what was left out.
struct ImportReport {
    std::vector<std::string> counts;      ///< "vertices 19604, of them 12 held"
    std::vector<std::string> recognised;  ///< "weave: woven_yarns, …, deviation 1.8e-15 cm"
    std::vector<std::string> decisions;
    std::vector<std::string> warnings;  ///< what the file says and the scene does not have
    std::vector<std::string> ignored;   ///< names of the file that were not read, by reason
    std::string readBack;               ///< what reading the written scene showed
};

/// The names of a file that nobody asked for, put into lines by why that is so.
std::vector<std::string> ignoredNames(const XmlFile& file, const NamesRead& names);

/// The report as text, a heading over each part.
std::string reportText(const ImportReport& report, const std::string& from, const std::string& to);

}  // namespace app
