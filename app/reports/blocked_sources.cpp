#include "app/reports/blocked_sources.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace app {

BlockedSources::BlockedSources(const sim::Scene& scene)
{
    for (const sim::SourceSettings& source : scene.sources) sources_.push_back({source.where, source.name});
}

std::vector<std::string> BlockedSources::newlyBlocked(const sim::State& state)
{
    std::vector<std::string> lines;
    const std::vector<sim::SourceMemory>& memory = state.memory.sources;
    for (std::size_t s = 0; s < std::min(memory.size(), sources_.size()); ++s) {
        Source& source = sources_[s];
        if (memory[s].isShut == 0.0 || source.isTold) continue;
        source.isTold = true;
        lines.push_back(
            fmt::format("{}: liquid.sources.{}: stops at {:.4g} s after {:.4g} cm^3: what it flows into is closed and full; it goes on "
                        "as soon as there is room",
                        source.where, source.name, state.time, state.emittedVolume[s]));
    }
    return lines;
}

void BlockedSources::look(const sim::State& state)
{
    for (const std::string& line : newlyBlocked(state)) spdlog::warn("{}", line);
}

}  // namespace app
