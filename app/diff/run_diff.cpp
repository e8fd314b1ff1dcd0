#include "app/diff/run_diff.h"

#include "app/checkpoint/state_files.h"
#include "app/diff/series.h"
#include "app/diff/state_diff.h"
#include "sim/core/check.h"
#include "sim/state_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace app {

namespace fs = std::filesystem;

namespace {

void append(std::vector<DiffFinding> more, std::vector<DiffFinding>& all) { std::ranges::move(more, std::back_inserter(all)); }

DiffFinding onlyOne(const std::string& what, bool isInA) { return {what, isInA ? "only A has it" : "only B has it", true}; }

RunResult reportOfRun(const fs::path& folder)
{
    auto report = readReport(folder);
    if (!report) throw sim::InputError(fmt::format("{}: this is no folder of a run: it has no report.json that can be read", folder.string()));
    return std::move(*report);
}

/// Frames of which both have a state. Pictures' states are as many in runs that are alike; of checkpoints only the last few are kept.
std::vector<std::int64_t> commonFrames(const fs::path& a, const fs::path& b, StateKind kind, std::vector<DiffFinding>& findings)
{
    const std::vector<std::int64_t> inA = storedFrames(a, kind), inB = storedFrames(b, kind);
    std::vector<std::int64_t> both, one;
    std::ranges::set_intersection(inA, inB, std::back_inserter(both));
    std::ranges::set_symmetric_difference(inA, inB, std::back_inserter(one));
    if (kind == StateKind::ForPictures && !one.empty())
        findings.push_back(onlyOne(fmt::format("states: frame {}", one.front()), std::ranges::binary_search(inA, one.front())));
    return both;
}

/// The hash decides where there is no tolerance, or nothing that tells how far apart states are.
DiffFinding hashFinding(const std::string& a, const std::string& b, const StateDiff& states, const Tolerance& tolerance)
{
    DiffFinding finding = {"state hash", {}, false};
    if (a == b && !states.differsFrom()) return finding;
    finding.words = fmt::format("{} against {}", a, b);
    if (states.isEmpty()) finding.words += "; output.data: [states] would tell where";
    if (states.differsFrom()) finding.words += fmt::format("; not the same from {:.6g} s on", *states.differsFrom());
    finding.differs = tolerance.wantsSameStates() || states.isEmpty();
    return finding;
}

}  // namespace

std::vector<DiffFinding> diffRuns(const fs::path& a, const fs::path& b, const Tolerance& tolerance, const std::function<bool()>& stopWanted)
{
    const RunResult reportA = reportOfRun(a), reportB = reportOfRun(b);
    std::vector<DiffFinding> findings, more;
    StateDiff states;
    for (const StateKind kind : {StateKind::ForPictures, StateKind::ForResuming})
        for (const std::int64_t frame : commonFrames(a, b, kind, more)) {
            if (stopWanted()) throw sim::InputError("stopped by the user before all was compared");
            states.add(loadCheckpoint(stateFile(a, kind, frame)).state, loadCheckpoint(stateFile(b, kind, frame)).state);
        }
    findings.push_back(hashFinding(reportA.stateHash, reportB.stateHash, states, tolerance));
    if (!states.isEmpty()) append(states.findings(tolerance), findings);
    append(std::move(more), findings);
    for (const char* log : {"energy.csv", "energy_ledger.csv", "probes.csv", "steps.jsonl"}) {
        const bool inA = fs::exists(a / log), inB = fs::exists(b / log);
        if (inA && inB) append(diffSeries(readSeries(a / log), readSeries(b / log), tolerance), findings);
        else if (inA || inB) findings.push_back(onlyOne(log, inA));
    }
    if (reportA.status != reportB.status) findings.push_back({"report.json: status", reportA.status + " against " + reportB.status, true});
    append(diffSeries(readReportNumbers(a / "report.json"), readReportNumbers(b / "report.json"), tolerance), findings);
    return findings;
}

std::vector<DiffFinding> diffStateFiles(const fs::path& a, const fs::path& b, const Tolerance& tolerance)
{
    const sim::State stateA = loadCheckpoint(a).state, stateB = loadCheckpoint(b).state;
    StateDiff states;
    states.add(stateA, stateB);
    std::vector<DiffFinding> findings = {hashFinding(hexDigits(sim::stateHash(stateA)), hexDigits(sim::stateHash(stateB)), states, tolerance)};
    append(states.findings(tolerance), findings);
    return findings;
}

}  // namespace app
