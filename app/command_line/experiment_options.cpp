#include "app/command_line/verb_options.h"
#include "sim/renamed.h"

#include <spdlog/spdlog.h>

namespace app {

namespace {

constexpr int kPrecisionThreads = 2;

CLI::App* addBenchPrecision(CLI::App& bench, Options& options)
{
    auto* verb = bench.add_subcommand("precision", "error against run time of methods, integrators, steps and cells");
    verb->add_option("case", options.cases, "names in scenes/bench/precision (default: all)");
    verb->add_option("--out", options.out, "folder of table, plots and report");
    auto* threads = verb->add_option("--threads", options.threads, "threads of the simulation (default: 2)")->check(CLI::Range(1, kMaxThreads));
    auto* repeats =
        verb->add_option("--repeats", options.repeats, "runs of the front and of the published scheme, of which the median counts (default: 1)")
            ->check(CLI::Range(1, 1000));
    verb->add_flag("--quick", options.quick, "few of them, within minutes");
    verb->add_flag("--csv", options.csv, "keep them in <results>/<machine>/precision");
    verb->add_option("--results", options.results, "folder of the machines' results");
    verb->add_option("--machine", options.machine, "name of this machine in them");
    verb->callback([&options, threads, repeats] {
        if (threads->count() == 0) options.threads = kPrecisionThreads;
        if (repeats->count() == 0) options.repeats = 1;
    });
    return verb;
}

/// Takes options of a verb by the names that they had before, too (sim/renamed.h), which the help does not show. Returns these.
std::vector<CLI::Option*> takeOldNames(CLI::App& verb)
{
    std::vector<CLI::Option*> taken;
    for (const sim::Renamed& row : sim::renamedOptions()) {
        const std::string before(row.before), now(row.now);
        CLI::Option* option = verb.get_option_no_throw(now);
        if (!option) continue;
        const auto handOn = [before, now, option](const std::string& value) {
            spdlog::warn("{} is called {} now", before, now);
            option->add_result(value);
            option->run_callback();
        };
        taken.push_back(verb.add_option_function<std::string>(before, handOn)->group(""));
    }
    return taken;
}

}  // namespace

void addValidate(CLI::App& program, Options& options)
{
    auto* validate = program.add_subcommand("validate", "compare runs with known answers, and report");
    validate->add_option("case", options.cases, "names in scenes/validation (default: all)");
    validate->add_option("--out", options.out, "folder of the report");
    validate->add_option("--threads", options.threads, "threads of the simulation (default: all)")->check(CLI::Range(1, kMaxThreads));
    validate->add_option("--set", options.sets, "override a key of the cases: dotted.key=value")->take_all()->allow_extra_args(false);
    auto* quick = validate->add_flag("--quick", options.quick, "shorter or coarser, within minutes");
    validate->add_flag("--full", options.full, "as the scenes are written (default)")->excludes(quick);
    validate->callback([&options] { options.verb = Verb::Validate; });
}

void addStress(CLI::App& program, Options& options)
{
    auto* stress = program.add_subcommand("stress", "look for runs that explode: a map of stable time steps, or random scenes");
    const std::vector<CLI::Option*> ofMaps = {
        stress->add_option("scene", options.scenes, "scene files, or names in scenes/ (default: the paper's four)"),
        stress->add_option("--method", options.methods, "only these: apic, polypic_8, polypic_11, polypic_15, polypic_27")->delimiter(','),
        stress->add_option("--steps", options.stepFactors, "time steps in units of the published 2e-4 s (default: 0.5,1,2,5,10,20)")
            ->delimiter(',')
            ->check(CLI::PositiveNumber),
        stress->add_flag("--largest-only", options.largestOnly, "of each method only the steps from the longest to the first stable one"),
        stress->add_option("--parameter", options.parameter, "also vary stiffness, density, viscosity or cell"),
        stress->add_option("--factors", options.parameterFactors, "by these factors (default: 0.01,0.1,1,10,100)")
            ->delimiter(',')
            ->check(CLI::PositiveNumber),
        stress->add_option("--duration", options.duration, "simulated seconds of each run")->check(CLI::PositiveNumber),
        stress->add_flag("--quick", options.quick, "shorter runs, fewer time steps"),
    };
    stress->add_option("--set", options.sets, "override a key of the scenes: dotted.key=value")->take_all()->allow_extra_args(false);
    auto* random = stress->add_option("--random", options.randomScenes, "run so many random scenes instead")->check(CLI::Range(1, 1'000'000));
    for (CLI::Option* option : ofMaps) random->excludes(option);
    for (CLI::Option* option : takeOldNames(*stress)) random->excludes(option);
    stress->add_option("--seed", options.seed, "of the random scenes")->needs(random);
    stress->add_option("--first", options.firstScene, "number of the first random scene")->check(CLI::Range(0, 1'000'000'000))->needs(random);
    stress->add_option("--limit", options.limitSeconds, "seconds after which a run is ended")->check(CLI::Range(1.0, 1.0e6));
    stress->add_option("--out", options.out, "folder of the report");
    stress->add_option("--threads", options.threads, "runs side by side (default: one per thread)")->check(CLI::Range(1, kMaxThreads));
    stress->callback([&options] { options.verb = Verb::Stress; });
}

void addBench(CLI::App& program, Options& options)
{
    auto* bench = program.add_subcommand("bench", "time a scene by stage");
    bench->add_option("--scene", options.scene, "a name in scenes/bench, or a scene file");
    bench->add_option("--threads", options.benchThreads, "numbers of threads to try: 1,2,4")->delimiter(',')->check(CLI::Range(1, kMaxThreads));
    bench->add_option("--repeats", options.repeats, "runs of each")->check(CLI::Range(1, 1000));
    bench->add_option("--steps", options.steps, "steps that are timed")->check(CLI::Range(1, 1'000'000));
    bench->add_option("--warmup", options.warmupSteps, "steps before those")->check(CLI::Range(0, 1'000'000));
    bench->add_option("--set", options.sets, "override a key of the scene")->take_all()->allow_extra_args(false);
    addVariant(*bench, options);
    bench->add_flag("--csv", options.csv, "write <results>/<machine>/<scene>.csv");
    bench->add_option("--results", options.results, "folder of the CSV files");
    bench->add_option("--machine", options.machine, "name of this machine in them");
    auto* precision = addBenchPrecision(*bench, options);
    bench->callback([&options, precision] {
        options.verb = precision->parsed() ? Verb::BenchPrecision : Verb::Bench;
        if (options.verb == Verb::Bench && options.scene.empty()) throw CLI::RequiredError("--scene");
    });
}

}  // namespace app
