#include "app/options.h"

#include "app/command_line/verb_options.h"
#include "app/provenance/provenance.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <thread>

namespace app {

namespace {

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

    addRun(program, options);
    addCompare(program, options);
    addPaper(program, options);
    addValidate(program, options);
    addRender(program, options);
    addExport(program, options);
    addDiff(program, options);
    addProbe(program, options);
    addSchema(program, options);
    addSweep(program, options);
    addEnsemble(program, options);
    addStress(program, options);
    addImport(program, options);
    addCheck(program, options);
    addView(program, options);
    addBench(program, options);
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
