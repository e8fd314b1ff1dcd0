#include "app/diff/diff.h"

#include "app/diff/read_tolerance.h"
#include "app/diff/run_diff.h"
#include "app/diff/series.h"
#include "app/diff/video_frames.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace fs = std::filesystem;

namespace {

enum class ResultKind { Picture, Pictures, Video, Run, Series, Report, State };

const char* nameOf(ResultKind kind)
{
    switch (kind) {
        case ResultKind::Picture: return "a picture";
        case ResultKind::Pictures: return "a folder of pictures";
        case ResultKind::Video: return "a video";
        case ResultKind::Run: return "a run";
        case ResultKind::Series: return "a series";
        case ResultKind::Report: return "a report";
        default: return "a state";
    }
}

ResultKind kindOf(const fs::path& path)
{
    if (!fs::exists(path)) throw sim::InputError(fmt::format("{}: there is no such file or folder", path.string()));
    if (fs::is_directory(path)) return fs::exists(path / "report.json") ? ResultKind::Run : ResultKind::Pictures;
    const std::string extension = path.extension().string();
    if (extension == ".png") return ResultKind::Picture;
    if (extension == ".mp4" || extension == ".mkv" || extension == ".mov") return ResultKind::Video;
    if (extension == ".csv" || extension == ".jsonl") return ResultKind::Series;
    if (extension == ".json") return ResultKind::Report;
    if (extension == ".h5") return ResultKind::State;
    throw sim::InputError(
        fmt::format("{}: cannot be compared; there are pictures (.png), videos (.mp4), series (.csv, .jsonl), reports (.json), states (.h5) "
                    "and folders of pictures or runs",
                    path.string()));
}

bool isPictures(ResultKind kind) { return kind == ResultKind::Pictures || kind == ResultKind::Run; }

/// The kind that both are compared as.
ResultKind commonKind(const DiffOptions& of)
{
    const ResultKind a = kindOf(of.a), b = kindOf(of.b);
    if (a == b) return a;
    if (isPictures(a) && isPictures(b)) return ResultKind::Pictures;
    throw sim::InputError(fmt::format("{} is {} and {} is {}: two of a kind can be compared, and a folder of pictures with a run", of.a.string(),
                                      nameOf(a), of.b.string(), nameOf(b)));
}

/// The file asked for, else what A has: a run its scene, pictures tolerance.yaml beside them. Nothing else has any.
Tolerance toleranceOf(const DiffOptions& of, const std::vector<std::string>& sets)
{
    if (!of.tolerances.empty()) return readTolerance(of.tolerances, false, sets);
    const fs::path folder = fs::is_directory(of.a) ? of.a : of.a.parent_path();
    if (const fs::path file = folder / kToleranceFile; fs::exists(file)) return readTolerance(file, false, sets);
    if (const fs::path scene = folder / "resolved.yaml"; fs::exists(scene)) return readTolerance(scene, true, sets);
    return readTolerance({}, false, sets);
}

bool hasPictures(const fs::path& folder)
{
    return std::ranges::any_of(fs::directory_iterator(folder), [](const fs::directory_entry& entry) { return entry.path().extension() == ".png"; });
}

void addPictures(const std::vector<PicturePair>& pairs, const std::function<bool()>& stopWanted, DiffResult& result)
{
    result.pictures = diffPictures(pairs, result.tolerance.pictures, stopWanted);
}

void addRuns(const std::function<bool()>& stopWanted, DiffResult& result)
{
    const DiffOptions& of = result.of;
    result.findings = diffRuns(of.a, of.b, result.tolerance, stopWanted);
    const bool inA = hasPictures(of.a), inB = hasPictures(of.b);
    if (inA && inB) addPictures(pairPictures(of.a, of.b, of.subset), stopWanted, result);
    else if (inA || (inB && !of.subset)) result.findings.push_back({"pictures", inA ? "only A has them" : "only B has them", true});
}

void addVideos(const std::function<bool()>& stopWanted, DiffResult& result)
{
    const auto frames = std::make_shared<VideoFrames>(result.of.a, result.of.b);
    addPictures(pairPictures(frames->a(), frames->b(), result.of.subset), stopWanted, result);
    result.frames = frames;
}

}  // namespace

bool DiffResult::differs() const
{
    return std::ranges::any_of(findings, &DiffFinding::differs) || std::ranges::any_of(pictures, &PictureDiff::differs);
}

std::string DiffResult::verdict() const
{
    const auto numbers = std::ranges::count_if(findings, &DiffFinding::differs), drawn = std::ranges::count_if(pictures, &PictureDiff::differs);
    std::string text;
    if (!findings.empty()) text = fmt::format("{} of {} numbers", numbers, findings.size());
    if (!pictures.empty()) text += fmt::format("{}{} of {} pictures", text.empty() ? "" : " and ", drawn, pictures.size());
    if (!differs()) {
        if (pictures.empty()) return fmt::format("same: {} differ by more than the tolerance", text);
        return fmt::format("same: {} differ by more than the tolerance; the worst is {}", text, wordsOf(pictures.front(), tolerance.pictures));
    }
    std::string first;
    constexpr int kTold = 3;
    int told = 0;
    for (const DiffFinding& finding : findings)
        if (finding.differs && told++ < kTold) first += fmt::format("{}: {}; ", finding.what, finding.words);
    if (drawn > 0 && told < kTold) first += wordsOf(pictures.front(), tolerance.pictures) + "; ";
    return fmt::format("different: {}{} differ", first, text);
}

DiffResult diffResults(const DiffOptions& options, const std::vector<std::string>& sets, const std::function<bool()>& stopWanted)
{
    const ResultKind kind = commonKind(options);
    if (options.subset && !fs::is_directory(options.a) && kind != ResultKind::Video)
        throw sim::InputError("--subset: goes with folders of pictures, runs and videos");
    DiffResult result = {options, toleranceOf(options, sets), {}, {}, nullptr};
    const fs::path &a = options.a, &b = options.b;
    switch (kind) {
        case ResultKind::Picture: addPictures({{a.filename().string(), a, b}}, stopWanted, result); break;
        case ResultKind::Pictures: addPictures(pairPictures(a, b, options.subset), stopWanted, result); break;
        case ResultKind::Video: addVideos(stopWanted, result); break;
        case ResultKind::Run: addRuns(stopWanted, result); break;
        case ResultKind::Series: result.findings = diffSeries(readSeries(a), readSeries(b), result.tolerance); break;
        case ResultKind::Report: result.findings = diffSeries(readReportNumbers(a), readReportNumbers(b), result.tolerance); break;
        case ResultKind::State: result.findings = diffStateFiles(a, b, result.tolerance); break;
    }
    return result;
}

}  // namespace app
