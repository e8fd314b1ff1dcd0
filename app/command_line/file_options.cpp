#include "app/command_line/verb_options.h"

#include <map>
#include <string>

namespace app {

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

void addCheck(CLI::App& program, Options& options)
{
    auto* check = program.add_subcommand("check", "validate a scene and print it resolved, with units");
    addScene(*check, options);
    addVariant(*check, options);
    check->callback([&options] { options.verb = Verb::Check; });
}

}  // namespace app
