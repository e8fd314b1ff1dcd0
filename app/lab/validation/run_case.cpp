#include "app/lab/validation/run_case.h"

#include "app/lab/checks/run_and_read.h"
#include "app/system/stopwatch.h"
#include "sim/core/check.h"

#include <chrono>
#include <cmath>

namespace app {

namespace {

void readAll(const Validation& validation, double time, CaseResult& result)
{
    for (std::size_t i = 0; i < validation.checks.size(); ++i) readNow(validation.checks[i], time, result.readings[i]);
}

void runAndRead(const LoadedScene& setup, const Backends& backends, const std::function<bool()>& stopWanted, CaseResult& result)
{
    const Validation& validation = result.validation;
    const auto simulation = backends.startSimulation(setup);
    validation.measures->look(*simulation);
    Measures& measures = *validation.measures;
    const auto read = [&](double time) {
        readAll(validation, time, result);
        measures.startInterval();
    };
    result.steps = runAndRead(
                       *simulation, setup.scene, validation.every, read, [&] { measures.afterStep(); }, stopWanted)
                       .steps;
}

}  // namespace

bool CaseResult::fails(std::size_t check) const
{
    const Finding& finding = findings[check];
    return !finding.passes && (validation.checks[check].outside.empty() || !std::isfinite(finding.value));
}

bool CaseResult::passes() const
{
    bool any = !failure.empty();
    for (std::size_t i = 0; i < findings.size(); ++i) any = any || fails(i);
    return !any;
}

CaseResult runCase(const std::string& name, const LoadedScene& setup, const Backends& backends, const std::function<bool()>& stopWanted)
{
    const auto begin = std::chrono::steady_clock::now();
    CaseResult result{.name = name, .setup = setup, .validation = *readValidation(setup), .readings = {}};
    const std::vector<Check>& checks = result.validation.checks;
    result.readings.resize(checks.size());
    try {
        runAndRead(setup, backends, stopWanted, result);
        for (std::size_t i = 0; i < checks.size(); ++i) result.findings.push_back(judge(checks[i], result.readings[i]));
    } catch (const sim::RunError& error) {
        result.failure = error.what();
    } catch (const sim::FormulaError& error) {
        result.failure = error.what();
    }
    result.wallSeconds = secondsSince(begin);
    return result;
}

}  // namespace app
