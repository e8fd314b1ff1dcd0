#include "app/lab/precision/reference_run.h"

#include "app/system/atomic_files.h"
#include "app/system/progress.h"
#include "app/system/thread_limit.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <iterator>
#include <sstream>

namespace app {

namespace {

using AllReadings = std::vector<std::vector<Sample>>;

std::string headerOf(const std::string& settings) { return "error,at,value," + settings; }

std::string textOf(const AllReadings& all, const std::string& settings)
{
    std::string text = headerOf(settings) + '\n';
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const Sample& reading : all[i]) fmt::format_to(std::back_inserter(text), "{},{:.12g},{:.12g}\n", i, reading.at, reading.value);
    return text;
}

/// Nothing where the file is missing, or of another run.
AllReadings readFile(const std::filesystem::path& file, const std::string& settings, std::size_t count)
{
    if (!std::filesystem::exists(file)) return {};
    std::istringstream in(readWhole(file));
    std::string line;
    std::getline(in, line);
    if (line != headerOf(settings)) return {};
    AllReadings all(count);
    while (std::getline(in, line)) {
        char* at = nullptr;
        const unsigned long number = std::strtoul(line.c_str(), &at, 10);
        char* end = at;
        Sample reading;
        if (*at == ',') reading.at = std::strtod(at + 1, &end);
        if (end == at || *end != ',' || number >= count)
            throw sim::InputError(fmt::format("{}: is not what bench precision left: remove it", file.string()));
        reading.value = std::strtod(end + 1, nullptr);
        all[number].push_back(reading);
    }
    return all;
}

}  // namespace

AllReadings convergedReadings(const std::filesystem::path& file, const LoadedScene& setup, int threads, const Backends& backends,
                              const std::function<bool()>& stopWanted)
{
    const std::string settings = settingsOf(setup);
    AllReadings all = readFile(file, settings, readPrecision(setup)->errors.size());
    if (!all.empty()) return all;
    const auto begin = std::chrono::steady_clock::now();
    all = withThreads(threads, [&] { return readErrors(setup, backends, stopWanted); });
    writeWhole(file, textOf(all, settings));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    fmt::print("{:<14} converged run in {}\n", setup.scene.name, formatDuration(took.count()));
    return all;
}

}  // namespace app
