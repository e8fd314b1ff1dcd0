#include "app/program.h"

#include "app/options.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <new>

namespace app {

namespace {

int runVerb(const Options& options, const Parts& parts)
{
    switch (options.verb) {
        case Verb::Run: return runVerbRun(options, parts);
        case Verb::Compare: return runVerbCompare(options, parts);
        case Verb::Check: return runVerbCheck(options, parts);
        case Verb::View: return runVerbView(options, parts);
        case Verb::Bench: return runVerbBench(options, parts);
        case Verb::BenchPrecision: return runVerbBenchPrecision(options, parts);
        case Verb::Paper: return runVerbPaper(options, parts);
        case Verb::Validate: return runVerbValidate(options, parts);
        case Verb::Stress: return runVerbStress(options, parts);
        case Verb::Render: return runVerbRender(options, parts);
        case Verb::Diff: return runVerbDiff(options, parts);
        case Verb::Probe: return runVerbProbe(options, parts);
        case Verb::Schema: return runVerbSchema(options, parts);
        case Verb::Export: return runVerbExport(options, parts);
        case Verb::Sweep: return runVerbSweep(options, parts);
        case Verb::Ensemble: return runVerbEnsemble(options, parts);
        case Verb::Import: return runVerbImport(options, parts);
    }
    return 1;
}

int tell(std::string message, int exitCode)
{
    std::ranges::replace(message, '\n', ' ');
    spdlog::error("{}", message);
    return exitCode;
}

/// What the program has to say goes to standard error, plain, behind its name.
void startLog()
{
    auto log = std::make_shared<spdlog::logger>("drench", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    log->set_pattern("%n: %v");
    spdlog::set_default_logger(log);
}

}  // namespace

int runProgram(int argc, const char* const* argv, const Parts& parts)
{
    startLog();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told like a full disk
    try {
        const auto options = readOptions(argc, argv);
        if (!options) return 0;
        watchForInterrupt();
        return runVerb(*options, parts);
    } catch (const sim::InputError& error) {
        return tell(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return tell("out of memory", 1);
    } catch (const std::exception& error) {
        return tell(error.what(), 1);
    }
}

}  // namespace app
