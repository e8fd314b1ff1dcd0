#include "app/options.h"

#include "app/provenance/provenance.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <thread>

namespace app {

namespace {

constexpr int kMaxThreads = 1024;

CLI::Option* addScene(CLI::App& verb, Options& options)
{
    auto* scene = verb.add_option("scene", options.scene, "scene file (YAML)")->required();
    verb.add_option("--set", options.sets, "override a key of the scene: dotted.key=value")->take_all()->allow_extra_args(false);
    return scene;
}

void addVariant(CLI::App& verb, Options& options)
{
    verb.add_option("--variant", options.variants, "one of the scene's compare.variants")->take_all()->allow_extra_args(false);
}

void addOutput(CLI::App& verb, Options& options)
{
    verb.add_option("--out", options.out, "output folder");
    verb.add_option("--threads", options.threads, "threads of the simulation (default: all)")->check(CLI::Range(1, kMaxThreads));
    verb.add_flag("!--no-frames", options.frames, "no pictures");
    verb.add_flag("!--no-video", options.video, "no video");
}

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

void addStress(CLI::App& program, Options& options)
{
    auto* stress = program.add_subcommand("stress", "look for runs that explode: a map of stable time steps, or random scenes");
    auto* scenes = stress->add_option("scene", options.scenes, "scene files, or names in scenes/ (default: the paper's four)");
    stress->add_option("--method", options.methods, "only these: apic, polypic_8, polypic_11, polypic_15, polypic_27")->delimiter(',');
    stress->add_option("--steps", options.stepFactors, "time steps in units of the published 2e-4 s (default: 0.5,1,2,5,10,20)")
        ->delimiter(',')
        ->check(CLI::PositiveNumber);
    stress->add_flag("--largest-only", options.largestOnly, "of each method only the steps from the longest to the first stable one");
    stress->add_option("--knob", options.knob, "also turn stiffness, density, viscosity or cell");
    stress->add_option("--factors", options.knobFactors, "by these factors (default: 0.01,0.1,1,10,100)")->delimiter(',')->check(CLI::PositiveNumber);
    stress->add_option("--duration", options.duration, "simulated seconds of each run")->check(CLI::PositiveNumber);
    stress->add_option("--set", options.sets, "override a key of the scenes: dotted.key=value")->take_all()->allow_extra_args(false);
    stress->add_flag("--quick", options.quick, "shorter runs, fewer time steps");
    stress->add_option("--random", options.randomScenes, "run so many random scenes instead")->check(CLI::Range(1, 1'000'000))->excludes(scenes);
    stress->add_option("--seed", options.seed, "of the random scenes");
    stress->add_option("--first", options.firstScene, "number of the first random scene")->check(CLI::Range(0, 1'000'000'000));
    stress->add_option("--limit", options.limitSeconds, "seconds after which a run is ended")->check(CLI::Range(1.0, 1.0e6));
    stress->add_option("--out", options.out, "folder of the report");
    stress->add_option("--threads", options.threads, "runs side by side (default: one per thread)")->check(CLI::Range(1, kMaxThreads));
    stress->callback([&options] { options.verb = Verb::Stress; });
}

void addImport(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("import", "turn a scene of libWetCloth (XML) into a scene file, with a report of what was decided");
    verb->add_option("file", options.scene, "scene of libWetCloth (XML)")->required();
    verb->add_option("-o,--out", options.out, "scene file to write (default: the same name with .yaml, in this folder)");
    const std::map<std::string, bool> solvers = {{"grid", false}, {"vertex", true}};
    verb->add_option("--solver", options.import.vertexSolver, "of the fabric: grid, as published (default), or vertex")
        ->transform(CLI::CheckedTransformer(solvers));
    verb->add_flag("--strict-fork", options.import.strictFork, "without picMethod it is PIC, as the PolyPIC fork reads it");
    verb->add_flag("--trust-friction-angle", options.import.trustFrictionAngle, "friction_angle counts, which libWetCloth does not read");
    verb->add_flag("--round-sections", options.import.roundSections, "a missing biradius is the radius, not 0.018 cm");
    verb->add_flag("!--no-thread-count", options.import.legacyThreadCount, "fabricThreadCount of 2018 does not count");
    verb->callback([&options] { options.verb = Verb::Import; });
}

void addRender(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("render", "make pictures of a run anew, from the states it has stored (output.data: [states])");
    verb->add_option("folder", options.scene, "folder of the run")->required();
    verb->add_option("--set", options.sets, "override a key of render or output: dotted.key=value")->take_all()->allow_extra_args(false);
    verb->add_option("--out", options.out, "folder of the pictures (default: pictures, in the run's)");
    verb->add_option("--threads", options.threads, "threads to draw with (default: all)")->check(CLI::Range(1, kMaxThreads));
    verb->add_flag("!--no-video", options.video, "no video");
    verb->add_flag("--panel", options.asPanel, "pictures without label, time and colour bar, to stand beside others");
    verb->callback([&options] { options.verb = Verb::Render; });
}

void addExport(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("export", "write geometry files of a run, from the states it has stored (output.data: [states])");
    verb->add_option("folder", options.scene, "folder of the run")->required();
    verb->add_option("--to", options.formats, "vtp, ply, obj, usda (default: as the scene says)")->delimiter(',');
    verb->add_option("--set", options.sets, "override a key of output: dotted.key=value")->take_all()->allow_extra_args(false);
    verb->add_option("--out", options.out, "the folder geometry/ comes below it (default: the run's)");
    verb->add_option("--threads", options.threads, "threads (default: all)")->check(CLI::Range(1, kMaxThreads));
    verb->callback([&options] { options.verb = Verb::Export; });
}

void addDiff(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("diff", "tell whether two results are the same: exit code 0 same, 1 different, 2 cannot be compared");
    verb->add_option("A", options.diff.a, "what is expected: a picture, a folder of pictures, a video, a run, a series, a report or a state")
        ->required();
    verb->add_option("B", options.diff.b, "what is held against it")->required();
    verb->add_option("--tolerances", options.diff.tolerances,
                     "a file of tolerances, or a scene with compare.tolerance (default: tolerance.yaml beside A, or the scene of A's run)");
    verb->add_option("--set", options.sets, "a tolerance: key=value")->take_all()->allow_extra_args(false);
    verb->add_flag("--subset", options.diff.subset, "A has only some of B's pictures: the others do not count");
    verb->add_option("--out", options.out, "folder for diff.html and pictures of what differs (default: none are made)");
    verb->add_option("--threads", options.threads, "threads (default: all)")->check(CLI::Range(1, kMaxThreads));
    verb->callback([&options] { options.verb = Verb::Diff; });
}

void addProbe(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("probe", "read probes of a run afterwards, from the states it has stored (output.data: [states])");
    verb->add_option("folder", options.scene, "folder of the run")->required();
    verb->add_option("probes", options.probes, "a file (YAML) of what stands in output.probes (default: as the scene says)");
    verb->add_option("--set", options.sets, "override a key of output: dotted.key=value")->take_all()->allow_extra_args(false);
    verb->add_option("--out", options.out, "folder of table and plot (default: probes, in the run's)");
    verb->callback([&options] { options.verb = Verb::Probe; });
}

void addSchema(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand("schema", "write the JSON schema of scene files or studies, by which editors complete and check them");
    verb->add_option("kind", options.scene, "scene (default), study, or keys: the keys of scenes as tables in Markdown")
        ->check(CLI::IsMember({"scene", "study", "keys"}));
    verb->add_option("--out", options.out, "file to write (default: to standard output)");
    verb->callback([&options] { options.verb = Verb::Schema; });
}

void addSweep(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand(
        "sweep", "do the runs of a study: one scene with different settings, in one table; what is done already is not done again");
    verb->add_option("study", options.scene, "study file (YAML): scene, runs, and what holds for all of them")->required();
    verb->add_option("--out", options.out, "folder of the study (default: out/<study>)");
    verb->add_option("--jobs", options.jobs, "runs side by side (default: 1)")->check(CLI::Range(1, 10'000));
    auto* threads =
        verb->add_option("--threads", options.threads, "threads of each run (default: all, shared among them)")->check(CLI::Range(1, kMaxThreads));
    auto* onSlurm = verb->add_option("--on", "where: here (default), or slurm")->check(CLI::IsMember({"here", "slurm"}));
    verb->add_flag("!--no-wait", options.wait, "with slurm: hand over the jobs, and that is all");
    verb->add_option("--task", options.task, "do this run alone, as a job of slurm does: a number from 0")->check(CLI::NonNegativeNumber);
    verb->add_flag("--force", options.force, "redo runs that are done");
    verb->add_flag("!--no-frames", options.frames, "no pictures");
    verb->add_flag("!--no-video", options.video, "no video");
    verb->callback([&options, threads, onSlurm] {
        options.verb = Verb::Sweep;
        options.onSlurm = onSlurm->count() > 0 && onSlurm->as<std::string>() == "slurm";
        if (threads->count() == 0) options.threads = options.onSlurm ? 1 : std::max(1, options.threads / options.jobs);
    });
}

std::vector<std::string> verbNames(const CLI::App& program)
{
    std::vector<std::string> names;
    for (const auto* verb : program.get_subcommands({})) names.push_back(verb->get_name());
    return names;
}

void addVerbs(CLI::App& program, Options& options)
{
    program.require_subcommand(1);
    program.set_version_flag("--version", programName());
    program.add_flag_callback(
        "--verbs", [&program] { throw CLI::CallForVersion(fmt::format("{}", fmt::join(verbNames(program), "\n")), 0); },
        "print the names of all verbs, one on each line");

    auto* run = program.add_subcommand("run", "run a scene, or one of its variants, to its end");
    addScene(*run, options)->required(false);
    addVariant(*run, options);
    addOutput(*run, options);
    auto* resume =
        run->add_option("--resume", options.resume, "go on with the run in this folder; with --out go on elsewhere, where --set may change settings");
    run->add_option("--from-frame", options.fromFrame, "go on from the checkpoint of this frame (default: the last one)")
        ->check(CLI::NonNegativeNumber)
        ->needs(resume);
    run->add_option("--again", options.again, "repeat the run of this report.json, and say whether it ends the same: exit code 0 same, 1 different");
    run->add_flag("--panel", options.asPanel, "pictures without label, time and colour bar, to stand beside others");
    run->callback([&options] {
        options.verb = Verb::Run;
        if (!options.scene.empty() + !options.resume.empty() + !options.again.empty() != 1)
            throw CLI::RequiredError("either scene, --resume or --again");
        if (!options.resume.empty() && !options.variants.empty()) throw CLI::ExcludesError("--resume", "--variant");
        if (!options.again.empty() && !options.variants.empty()) throw CLI::ExcludesError("--again", "--variant");
        if (!options.again.empty() && !options.sets.empty()) throw CLI::ExcludesError("--again", "--set");
    });

    auto* compare = program.add_subcommand("compare", "run the scene's variants and put them side by side");
    addScene(*compare, options)->required(false);
    compare->add_option("--from", options.from, "put runs side by side that are there, each in its folder, in place of a scene's; needs --out")
        ->take_all()
        ->allow_extra_args(false);
    addOutput(*compare, options);
    compare->add_option("--variant", options.variants, "only this variant; may be repeated")->take_all()->allow_extra_args(false);
    compare->add_flag("--force", options.force, "redo variants that are done");
    compare->add_flag("--or-run", options.orRun, "where there is nothing to compare, just run");
    compare->callback([&options] {
        options.verb = Verb::Compare;
        if (options.scene.empty() == options.from.empty()) throw CLI::RequiredError("either scene or --from");
        if (!options.from.empty() && options.out.empty()) throw CLI::RequiredError("--out, where runs --from folders are put side by side,");
    });

    auto* paper = program.add_subcommand("paper", "the scenes of the PolyPIC paper, each with APIC and PolyPIC, in one report");
    addOutput(*paper, options);
    paper->add_flag("--quick", options.quick, "only the first moments of each scene");
    paper->add_flag("--force", options.force, "redo runs that are done");
    paper->add_option("--set", options.sets, "override a key of all scenes: dotted.key=value")->take_all()->allow_extra_args(false);
    paper->callback([&options] { options.verb = Verb::Paper; });

    auto* validate = program.add_subcommand("validate", "compare runs with known answers, and report");
    validate->add_option("case", options.cases, "names in scenes/validation (default: all)");
    validate->add_option("--out", options.out, "folder of the report");
    validate->add_option("--threads", options.threads, "threads of the simulation (default: all)")->check(CLI::Range(1, kMaxThreads));
    auto* quick = validate->add_flag("--quick", options.quick, "shorter or coarser, within minutes");
    validate->add_flag("--full", options.full, "as the scenes are written (default)")->excludes(quick);
    validate->callback([&options] { options.verb = Verb::Validate; });

    addRender(program, options);
    addExport(program, options);
    addDiff(program, options);
    addProbe(program, options);
    addSchema(program, options);
    addSweep(program, options);
    addStress(program, options);
    addImport(program, options);

    auto* check = program.add_subcommand("check", "validate a scene and print it resolved, with units");
    addScene(*check, options);
    addVariant(*check, options);
    check->callback([&options] { options.verb = Verb::Check; });

    auto* view = program.add_subcommand("view", "show a scene in a window while it is simulated");
    addScene(*view, options);
    addVariant(*view, options);
    view->add_option("--threads", options.threads, "threads of the simulation (default: all)")->check(CLI::Range(1, kMaxThreads));
    view->add_flag("--paused", options.view.paused, "wait with the first step");
    view->add_option("--beside", options.view.beside, "another variant of the scene, at the same times");
    view->callback([&options] { options.verb = Verb::View; });

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

/// The parser takes a word that is no verb for nothing at all and only misses the verb.
void requireKnownVerb(const CLI::App& program, const std::string& word)
{
    const std::vector<std::string> names = verbNames(program);
    if (word.starts_with('-') || std::ranges::find(names, word) != names.end()) return;
    throw sim::InputError(fmt::format("unknown verb \"{}\": there are {}", word, fmt::join(names, ", ")));
}

/// The parser's message as one line.
std::string oneLine(std::string text)
{
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace

std::optional<Options> readOptions(int argc, const char* const* argv)
{
    Options options;
    options.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxThreads);
    CLI::App program("Drench simulates liquid meeting fabric and turns scenes into pictures and videos.", "drench");
    addVerbs(program, options);
    if (argc > 1) requireKnownVerb(program, argv[1]);
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) throw sim::InputError(fmt::format("{} (drench --help tells more)", oneLine(error.what())));
        program.exit(error);
        return std::nullopt;
    }
    if (options.verb != Verb::Compare && options.variants.size() > 1) throw sim::InputError("--variant: only one at a time, except for compare");
    return options;
}

}  // namespace app
