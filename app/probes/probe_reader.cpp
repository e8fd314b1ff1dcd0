#include "app/probes/probe_reader.h"

#include "app/backends.h"

#include <spdlog/spdlog.h>

#include <array>
#include <cmath>

namespace app {

namespace {

/// A time that is a whole number of intervals but for rounding is the last of them.
std::int64_t readingsUpTo(double time, double every) { return std::llround(std::floor(time / every + 1.0e-9)); }

}  // namespace

ProbeReader::ProbeReader(const Probes& probes, double start, double time, const IntervalTotals& sinceReading)
    : probes_(probes), start_(start), next_(readingsUpTo(time - start, probes.every) + 1)
{
    probes_.measures->setInterval(sinceReading);
}

ProbeReading ProbeReader::initial(const SimulationHandle& simulation)
{
    probes_.measures->look(simulation);
    return read(simulation);
}

std::optional<ProbeReading> ProbeReader::step(const SimulationHandle& simulation, bool isReflected)
{
    probes_.measures->setSimulation(simulation);
    probes_.measures->afterStep();
    if (isReflected || readingsUpTo(simulation.state().time - start_, probes_.every) < next_) return std::nullopt;
    return read(simulation);
}

std::optional<double> ProbeReader::valueOf(const Probe& probe, std::span<const double> at)
try {
    return probe.read(at);
} catch (const NoStepYet&) {
    return std::nullopt;  // as every reading of it is at the start, which needs no word
} catch (const sim::FormulaError& error) {
    if (valueless_.insert(probe.name).second)
        spdlog::warn("output.probes: {} has no value at {:.6g} s and is left empty there: {}", probe.name, at[0], error.what());
    return std::nullopt;
}

ProbeReading ProbeReader::read(const SimulationHandle& simulation)
{
    ProbeReading reading{.time = simulation.state().time, .values = {}};
    for (const Probe& probe : probes_.all) {
        if (probe.points.empty()) reading.values.push_back(valueOf(probe, std::array{reading.time}));
        for (const sim::Vec3& x : probe.points) reading.values.push_back(valueOf(probe, std::array{reading.time, x[0], x[1], x[2]}));
    }
    probes_.measures->startInterval();
    next_ = readingsUpTo(reading.time - start_, probes_.every) + 1;
    return reading;
}

}  // namespace app
