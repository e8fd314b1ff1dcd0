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

int runVerb(const Options& options, const Backends& backends)
{
    switch (options.verb) {
        case Verb::Run: return runVerbRun(options, backends);
        case Verb::Compare: return runVerbCompare(options, backends);
        case Verb::Check: return runVerbCheck(options, backends);
        case Verb::View: return runVerbView(options, backends);
        case Verb::Bench: return runVerbBench(options, backends);
        case Verb::BenchPrecision: return runVerbBenchPrecision(options, backends);
        case Verb::Paper: return runVerbPaper(options, backends);
        case Verb::Validate: return runVerbValidate(options, backends);
        case Verb::Stress: return runVerbStress(options, backends);
        case Verb::Render: return runVerbRender(options, backends);
        case Verb::Diff: return runVerbDiff(options, backends);
        case Verb::Probe: return runVerbProbe(options, backends);
        case Verb::Schema: return runVerbSchema(options, backends);
        case Verb::Export: return runVerbExport(options, backends);
        case Verb::Sweep: return runVerbSweep(options, backends);
        case Verb::Ensemble: return runVerbEnsemble(options, backends);
        case Verb::Import: return runVerbImport(options, backends);
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

int runProgram(int argc, const char* const* argv, const Backends& backends)
{
    startLog();
    std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told like a full disk
    try {
        const auto options = readOptions(argc, argv);
        if (!options) return 0;
        watchForInterrupt();
        return runVerb(*options, backends);
    } catch (const sim::InputError& error) {
        return tell(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return tell("out of memory", 1);
    } catch (const std::exception& error) {
        return tell(error.what(), 1);
    }
}

}  // namespace app
