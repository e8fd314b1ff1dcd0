#include "app/command_line/verb_options.h"

#include <algorithm>
#include <functional>
#include <string>

namespace app {

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

void addRun(CLI::App& program, Options& options)
{
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
    run->add_option("--runs-to-follow", options.runsToFollow,
                    "what follows in the same command takes so many times as long: progress tells the time that is left of all")
        ->check(CLI::NonNegativeNumber);
    run->callback([&options] {
        options.verb = Verb::Run;
        if (!options.scene.empty() + !options.resume.empty() + !options.again.empty() != 1)
            throw CLI::RequiredError("either scene, --resume or --again");
        if (!options.resume.empty() && !options.variants.empty()) throw CLI::ExcludesError("--resume", "--variant");
        if (!options.again.empty() && !options.variants.empty()) throw CLI::ExcludesError("--again", "--variant");
        if (!options.again.empty() && !options.sets.empty()) throw CLI::ExcludesError("--again", "--set");
    });
}

void addCompare(CLI::App& program, Options& options)
{
    auto* compare = program.add_subcommand("compare", "run the scene's variants and put them side by side");
    addScene(*compare, options)->required(false);
    compare
        ->add_option("--from", options.from,
                     "put runs side by side that are there, each in its folder, or ensembles, in place of a scene's; needs --out")
        ->take_all()
        ->allow_extra_args(false);
    addOutput(*compare, options);
    compare->add_option("--variant", options.variants, "only this variant; may be repeated")->take_all()->allow_extra_args(false);
    compare->add_option("--confidence", options.confidence, "of ensembles: with which all intervals together hold (default: 0.99)")
        ->check(CLI::Range(0.5, 0.999999));
    compare->add_flag("--force", options.force, "redo variants that are done");
    compare->add_flag("--or-run", options.orRun, "where there is nothing to compare, just run");
    compare->callback([&options] {
        options.verb = Verb::Compare;
        if (options.scene.empty() == options.from.empty()) throw CLI::RequiredError("either scene or --from");
        if (!options.from.empty() && options.out.empty()) throw CLI::RequiredError("--out, where runs --from folders are put side by side,");
    });
}

void addPaper(CLI::App& program, Options& options)
{
    auto* paper = program.add_subcommand("paper", "the scenes of the PolyPIC paper, each with APIC and PolyPIC, in one report");
    addOutput(*paper, options);
    paper->add_flag("--quick", options.quick, "only the first moments of each scene");
    paper->add_option("--repeats", options.paperRepeats, "runs of each with particles laid otherwise, so that all numbers have a spread (default: 1)")
        ->check(CLI::Range(1, 1000));
    paper->add_flag("--force", options.force, "redo runs that are done");
    paper->add_option("--set", options.sets, "override a key of all scenes: dotted.key=value")->take_all()->allow_extra_args(false);
    paper->callback([&options] { options.verb = Verb::Paper; });
}

/// Where and how the runs of a study are done. What it returns settles the options when all are read.
std::function<void()> addStudyWork(CLI::App& verb, Options& options)
{
    verb.add_option("--jobs", options.jobs, "runs side by side (default: 1)")->check(CLI::Range(1, 10'000));
    auto* threads =
        verb.add_option("--threads", options.threads, "threads of each run (default: all, shared among them)")->check(CLI::Range(1, kMaxThreads));
    auto* onSlurm = verb.add_option("--on", "where: here (default), or slurm")->check(CLI::IsMember({"here", "slurm"}));
    verb.add_flag("!--no-wait", options.wait, "with slurm: hand over the jobs, and that is all");
    verb.add_flag("--force", options.force, "redo runs that are done");
    return [&options, threads, onSlurm] {
        options.onSlurm = onSlurm->count() > 0 && onSlurm->as<std::string>() == "slurm";
        if (threads->count() == 0) options.threads = options.onSlurm ? 1 : std::max(1, options.threads / options.jobs);
    };
}

void addSweep(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand(
        "sweep", "do the runs of a study: one scene with different settings, in one table; what is done already is not done again");
    verb->add_option("study", options.scene, "study file (YAML): scene, runs, and what holds for all of them")->required();
    verb->add_option("--out", options.out, "folder of the study (default: out/<study>)");
    const auto settle = addStudyWork(*verb, options);
    verb->add_option("--task", options.task, "do this run alone, as a job of slurm does: a number from 0")->check(CLI::NonNegativeNumber);
    verb->add_flag("!--no-frames", options.frames, "no pictures");
    verb->add_flag("!--no-video", options.video, "no video");
    verb->callback([&options, settle] {
        options.verb = Verb::Sweep;
        settle();
    });
}

void addEnsemble(CLI::App& program, Options& options)
{
    auto* verb = program.add_subcommand(
        "ensemble", "run a scene many times with different random numbers, or a setting drawn from a range: means with their spread");
    addScene(*verb, options);
    addVariant(*verb, options);
    verb->add_option("-n,--runs", options.members, "how many (default: 20)")->check(CLI::Range(2, 1000));
    verb->add_option("--vary", options.vary,
                     "what differs: positions of the particles (default), seed of sources that are filled at random, or key=a..b; may be repeated")
        ->take_all()
        ->allow_extra_args(false);
    verb->add_option("--first", options.firstMember, "number of the first run: other numbers, other draws (default: 0)")
        ->check(CLI::Range(0, 1'000'000));
    verb->add_option("--out", options.out, "folder of the ensemble (default: out/<scene>/<variant>_ensemble)");
    const auto settle = addStudyWork(*verb, options);
    verb->add_flag("--frames", options.framesOfAll, "pictures and videos of all runs, too");
    verb->callback([&options, settle] {
        options.verb = Verb::Ensemble;
        settle();
    });
}

void addView(CLI::App& program, Options& options)
{
    auto* view = program.add_subcommand("view", "show a scene in a window while it is simulated");
    addScene(*view, options);
    addVariant(*view, options);
    view->add_option("--threads", options.threads, "threads of the simulation (default: all)")->check(CLI::Range(1, kMaxThreads));
    view->add_flag("--paused", options.view.paused, "wait with the first step");
    view->add_option("--beside", options.view.beside, "another variant of the scene, at the same times");
    view->callback([&options] { options.verb = Verb::View; });
}

}  // namespace app
