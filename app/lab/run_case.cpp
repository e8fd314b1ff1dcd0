#include "app/lab/run_case.h"

#include "sim/core/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace app {

namespace {

void readAll(const Validation& validation, double time, CaseResult& result)
{
    for (std::size_t i = 0; i < validation.checks.size(); ++i)
        if (const auto reading = readOnce(validation.checks[i], time)) result.readings[i].push_back(*reading);
}

void follow(const SceneSetup& setup, const Parts& parts, const std::function<bool()>& stopWanted, CaseResult& result)
{
    const Validation& validation = *setup.validation;
    const auto simulation = parts.startSimulation(setup);
    validation.measures->look(*simulation);
    const auto& time = setup.scene.settings.time;
    // Readings end on the duration itself but for the rounding of sums.
    constexpr double kRounding = 1.0e-9;
    const auto count = static_cast<std::int64_t>(std::floor(time.duration / validation.every + kRounding));
    readAll(validation, time.start, result);
    for (std::int64_t n = 1; n <= count; ++n) {
        const double until = time.start + static_cast<double>(n) * validation.every;
        while (simulation->state().time < until - kRounding * validation.every) simulation->step(until);
        readAll(validation, simulation->state().time, result);
        if (stopWanted()) throw sim::RunError("stopped by the user");
    }
    result.steps = simulation->state().step;
}

}  // namespace

bool CaseResult::passes() const
{
    return failure.empty() && std::ranges::all_of(findings, &Finding::passes);
}

CaseResult runCase(const std::string& name, const SceneSetup& setup, const Parts& parts,
                   const std::function<bool()>& stopWanted)
{
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<Check>& checks = setup.validation->checks;
    CaseResult result{.name = name, .setup = setup, .readings = std::vector<std::vector<Reading>>(checks.size())};
    try {
        follow(setup, parts, stopWanted, result);
        for (std::size_t i = 0; i < checks.size(); ++i) result.findings.push_back(judge(checks[i], result.readings[i]));
    } catch (const sim::RunError& error) {
        result.failure = error.what();
    } catch (const sim::FormulaError& error) {
        result.failure = error.what();
    }
    result.wallSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace app
