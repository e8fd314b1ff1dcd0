#include "app/lab/checks/case_files.h"

#include "app/system/data_folder.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace app {

namespace fs = std::filesystem;

std::vector<fs::path> caseFiles(const fs::path& folder, const std::vector<std::string>& names)
{
    const fs::path here = "scenes" / folder, from = fs::is_directory(here) ? here : dataFolder("scenes") / folder;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(from))
        if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    std::ranges::sort(files);
    if (names.empty()) return files;
    std::vector<std::string> known;
    for (const auto& file : files) known.push_back(file.stem().string());
    for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw sim::InputError(fmt::format("{}: there is no case {}: there are {}", folder.filename().string(), name, fmt::join(known, ", ")));
    std::erase_if(files, [&](const auto& file) { return std::ranges::find(names, file.stem().string()) == names.end(); });
    return files;
}

}  // namespace app
