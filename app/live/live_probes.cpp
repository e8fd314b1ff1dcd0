#include "app/live/live_probes.h"

#include <algorithm>
#include <utility>

namespace app {

namespace {

constexpr std::size_t kMostReadings = 10'000;  ///< readings that wait to be taken, of a window that is not drawn

std::vector<ProbeTitle> titlesOf(const Probes& probes)
{
    std::vector<ProbeTitle> titles;
    for (const Probe& probe : probes.all) titles.push_back({probe.name, probe.unit, probe.points.size()});
    return titles;
}

}  // namespace

void LiveProbes::begin(const LoadedScene& setup, const SimulationHandle& simulation)
{
    const std::optional<Probes> probes = readProbes(setup);
    reader_.reset();
    {
        const std::lock_guard lock(mutex_);
        waiting_ = {.titles = probes ? std::make_shared<const std::vector<ProbeTitle>>(titlesOf(*probes)) : nullptr,
                    .dropAfter = -std::numeric_limits<double>::infinity(),
                    .readings = {}};
    }
    if (!probes) return;
    reader_.emplace(*probes, setup.scene.settings.time.start);
    add(reader_->initial(simulation));
}

void LiveProbes::goBack(const LoadedScene& setup, double time)
{
    if (!reader_) return;
    const Probes probes = reader_->probes();
    reader_.emplace(probes, setup.scene.settings.time.start, time, IntervalTotals());
    const std::lock_guard lock(mutex_);
    waiting_.dropAfter = std::min(waiting_.dropAfter, time);
    std::erase_if(waiting_.readings, [&](const ProbeReading& reading) { return reading.time > time; });
}

void LiveProbes::step(const SimulationHandle& simulation, bool isReflected)
{
    if (!reader_) return;
    if (auto reading = reader_->step(simulation, isReflected)) add(std::move(*reading));
}

void LiveProbes::add(ProbeReading reading)
{
    const std::lock_guard lock(mutex_);
    if (waiting_.readings.size() < kMostReadings) waiting_.readings.push_back(std::move(reading));
}

LiveReadings LiveProbes::take()
{
    const std::lock_guard lock(mutex_);
    LiveReadings taken = std::move(waiting_);
    waiting_ = {.titles = taken.titles, .dropAfter = std::numeric_limits<double>::infinity(), .readings = {}};
    return taken;
}

}  // namespace app
