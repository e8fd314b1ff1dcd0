#include "app/diff/picture_diff.h"

#include "render/compose.h"
#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace app {

namespace fs = std::filesystem;

namespace {

std::map<std::string, fs::path> picturesIn(const fs::path& folder)
{
    std::map<std::string, fs::path> pictures;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".png") pictures[entry.path().filename().string()] = entry.path();
    if (pictures.empty()) throw sim::InputError(fmt::format("{}: there are no pictures (.png) in it", folder.string()));
    return pictures;
}

/// How much of a picture differs: for the order of pictures alone.
double severity(const PictureDiff& diff)
{
    if (!diff.problem.empty()) return 3.0;
    return 1.0 - diff.difference.similarity.mean + diff.difference.color.share;
}

PictureDiff diffOf(const PicturePair& pair, const render::ImageTolerance& tolerance)
{
    PictureDiff diff = {pair, {}, {}, true};
    if (pair.a.empty() || pair.b.empty()) {
        diff.problem = pair.a.empty() ? "only B has it" : "only A has it";
        return diff;
    }
    const render::Image a = render::readPng(pair.a), b = render::readPng(pair.b);
    if (a.width != b.width || a.height != b.height) {
        diff.problem = fmt::format("{} x {} pixels against {} x {}", a.width, a.height, b.width, b.height);
        return diff;
    }
    diff.difference = render::compareImages(a, b);
    diff.differs = !render::isWithin(diff.difference, tolerance);
    return diff;
}

/// The limit behind a number that misses it.
std::string missed(bool isMissed, const char* relation, double limit) { return isMissed ? fmt::format(" ({} {:.4g})", relation, limit) : ""; }

}  // namespace

std::vector<PicturePair> pairPictures(const fs::path& a, const fs::path& b, bool subset)
{
    const auto inA = picturesIn(a), inB = picturesIn(b);
    std::map<std::string, PicturePair> pairs;
    for (const auto& [name, file] : inA) pairs[name] = {name, file, {}};
    for (const auto& [name, file] : inB) {
        if (subset && !pairs.contains(name)) continue;
        pairs[name].name = name;
        pairs[name].b = file;
    }
    std::vector<PicturePair> all;
    for (auto& [name, pair] : pairs) all.push_back(std::move(pair));
    return all;
}

std::vector<PictureDiff> diffPictures(const std::vector<PicturePair>& pairs, const render::ImageTolerance& tolerance,
                                      const std::function<bool()>& stopWanted)
{
    std::vector<PictureDiff> diffs(pairs.size());
    sim::parallelFor(pairs.size(), [&](std::size_t i) {
        if (stopWanted()) throw sim::InputError("stopped by the user before all was compared");
        diffs[i] = diffOf(pairs[i], tolerance);
    });
    std::ranges::stable_sort(
        diffs, [](const PictureDiff& x, const PictureDiff& y) { return x.differs != y.differs ? x.differs : severity(x) > severity(y); });
    return diffs;
}

std::string wordsOf(const PictureDiff& diff, const render::ImageTolerance& tolerance)
{
    if (!diff.problem.empty()) return fmt::format("{}: {}", diff.pair.name, diff.problem);
    const auto& [similarity, color] = diff.difference;
    return fmt::format("{}: mean SSIM {:.4f}{}, lowest {:.4f}{} at ({}, {}), {:.3g} % of pixels over {}/255{}, largest difference {}{} at ({}, {})",
                       diff.pair.name, similarity.mean, missed(similarity.mean < tolerance.meanSsim, "at least", tolerance.meanSsim),
                       similarity.lowest, missed(similarity.lowest < tolerance.lowestSsim, "at least", tolerance.lowestSsim), similarity.x,
                       similarity.y, 100.0 * color.share, render::kVisibleStep,
                       missed(color.share > tolerance.pixels, "at most", 100.0 * tolerance.pixels), color.largest,
                       missed(color.largest > tolerance.largest, "at most", tolerance.largest), color.x, color.y);
}

void drawPanels(const PicturePair& pair, const fs::path& target)
{
    const render::Image a = render::readPng(pair.a), b = render::readPng(pair.b);
    const std::array<render::Image, 3> panels = {a, b, render::differenceImage(b, a)};
    const std::array<std::string, 3> labels = {"A", "B", "what differs"};
    const render::Font font;
    render::writePng(render::compose(panels, labels, font).image, target);
}

}  // namespace app
