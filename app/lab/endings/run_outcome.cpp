#include "app/lab/endings/run_outcome.h"

#include "app/frames/frame_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>

namespace app {

namespace {

/// "scene drop, step 12, t = 0.0024 s, stage pressure: why"
bool isDiagnosis(const std::string& words)
{
    static const std::regex kForm("drench: scene [a-zA-Z0-9_]+, step [0-9]+, t = [^ ]+ s, stage [a-z_0-9]+: .+");
    return std::regex_match(words, kForm);
}

/// The first step whose log has a number that is none: in JSON such are null. Empty if there is no such step.
std::string firstStepThatIsNotFinite(const std::filesystem::path& steps)
{
    std::ifstream in(steps);
    std::string line;
    for (int n = 1; std::getline(in, line); ++n)
        if (line.find("null") != std::string::npos) return fmt::format("step {} has numbers that are not finite", n);
    return "";
}

std::string firstMissingPicture(const std::filesystem::path& folder, int pictures)
{
    for (int n = 0; n < pictures; ++n)
        if (!std::filesystem::exists(folder / frameFileName(n))) return frameFileName(n) + " is missing";
    return "";
}

}  // namespace

RunVerdict judgeEnd(const ProcessEnd& end, const std::filesystem::path& folder, int pictures)
{
    const auto outcome = [&](RunOutcome ending, std::string why) { return RunVerdict{ending, std::move(why), end.seconds}; };
    constexpr int kSignals = 128, kMistake = 2;  // exit codes
    if (end.timedOut) return outcome(RunOutcome::TimedOut, fmt::format("ended after {:.0f} s", end.seconds));
    if (end.exit.code > kSignals) return outcome(RunOutcome::Crashed, fmt::format("signal {}: {}", end.exit.code - kSignals, end.exit.lastWords()));
    if (const std::string why = firstStepThatIsNotFinite(folder / "steps.jsonl"); !why.empty()) return outcome(RunOutcome::NotFinite, why);
    const std::string words = end.exit.lastWords();
    if (end.exit.code == kMistake) return outcome(RunOutcome::Refused, words);
    if (!end.exit.ok()) return outcome(isDiagnosis(words) ? RunOutcome::Stopped : RunOutcome::Undiagnosed, words);
    const std::string missing = firstMissingPicture(folder, pictures);
    return outcome(missing.empty() ? RunOutcome::Finished : RunOutcome::Undiagnosed, missing);
}

}  // namespace app
