#include "app/diff/diff_page.h"

#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kShown = 12;  ///< pictures on the page: about a megabyte each

constexpr std::string_view kPageHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<style>
body { font: 15px/1.45 "DejaVu Sans", sans-serif; color: #222; margin: 2em auto; max-width: 1500px; padding: 0 1em; }
h1 { font-size: 1.4em } h2 { font-size: 1.1em; margin-top: 2em } figure { margin: 1.5em 0 } img { max-width: 100%; border: 1px solid #ccc }
table { border-collapse: collapse; font-size: 13px } td, th { padding: .2em .8em; text-align: right; border-bottom: 1px solid #ddd }
td:first-child, th:first-child, td.words { text-align: left } .differs { color: #b00000 } .same { color: #207020 }
</style>
)";

std::string escaped(std::string_view text)
{
    std::string result;
    for (const char c : text) {
        if (c == '&') result += "&amp;";
        else if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '"') result += "&quot;";
        else result += c;
    }
    return result;
}

std::string base64(std::string_view bytes)
{
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

const char* classOf(bool differs) { return differs ? "differs" : "same"; }

/// Bars of 1 − mean SSIM over the pictures in the order of their names.
std::string chart(std::vector<PictureDiff> pictures)
{
    std::ranges::sort(pictures, {}, [](const PictureDiff& p) { return p.pair.name; });
    const double barWidth = std::clamp(1400.0 / static_cast<double>(pictures.size()), 0.5, 24.0);
    const auto height = [](const PictureDiff& p) { return p.problem.empty() ? std::max(0.0, 1.0 - p.difference.similarity.mean) : 0.0; };
    double highest = 1e-6;
    for (const PictureDiff& p : pictures) highest = std::max(highest, height(p));
    std::string svg = fmt::format("<h2>1 &minus; mean SSIM by picture, up to {:.3g}</h2>\n<svg width=\"{:.0f}\" height=\"120\" role=\"img\">",
                                  highest, barWidth * static_cast<double>(pictures.size()));
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const PictureDiff& p = pictures[i];
        const double h = p.problem.empty() ? 1.0 + 118.0 * height(p) / highest : 119.0;  // one that is missing fills the chart
        svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{}</title></rect>",
                           barWidth * static_cast<double>(i), 120.0 - h, 0.9 * barWidth, h, p.differs ? "#b00000" : "#70a070", escaped(p.pair.name));
    }
    return svg + "</svg>\n";
}

std::string picturesTable(const DiffResult& result)
{
    std::string html = fmt::format(
        "<h2>All pictures, the worst first</h2>\n<table><tr><th>picture</th><th>mean SSIM</th><th>lowest</th><th>at</th>"
        "<th>over {}/255 [%]</th><th>largest</th><th>at</th></tr>\n",
        render::kVisibleStep);
    for (const PictureDiff& p : result.pictures) {
        html += fmt::format("<tr class=\"{}\"><td>{}</td>", classOf(p.differs), escaped(p.pair.name));
        const auto& [similarity, color] = p.difference;
        if (!p.problem.empty()) html += fmt::format("<td class=\"words\" colspan=\"6\">{}</td></tr>\n", escaped(p.problem));
        else
            html += fmt::format("<td>{:.5f}</td><td>{:.4f}</td><td>{}, {}</td><td>{:.3f}</td><td>{}</td><td>{}, {}</td></tr>\n", similarity.mean,
                                similarity.lowest, similarity.x, similarity.y, 100.0 * color.share, color.largest, color.x, color.y);
    }
    return html + "</table>\n";
}

std::string numbersTable(const std::vector<DiffFinding>& findings)
{
    std::string html = "<h2>Numbers</h2>\n<table><tr><th>of</th><th>A against B</th></tr>\n";
    for (const DiffFinding& f : findings)
        html += fmt::format("<tr class=\"{}\"><td>{}</td><td class=\"words\">{}</td></tr>\n", classOf(f.differs), escaped(f.what),
                            f.words.empty() ? "the same" : escaped(f.words));
    return html + "</table>\n";
}

bool canBeShown(const PictureDiff& p) { return p.problem.empty() && (p.differs || p.difference.color.largest > 0); }

fs::path panelsFile(const fs::path& folder, const PictureDiff& p) { return folder / ("diff_" + p.pair.name); }

/// Panels of those that differ, and of those that are shown; the latter may be within the tolerance.
std::vector<const PictureDiff*> drawAllPanels(const DiffResult& result, const fs::path& folder)
{
    std::vector<const PictureDiff*> drawn;
    for (const PictureDiff& p : result.pictures)
        if (canBeShown(p) && (p.differs || drawn.size() < kShown)) drawn.push_back(&p);
    sim::parallelFor(drawn.size(), [&](std::size_t i) { drawPanels(drawn[i]->pair, panelsFile(folder, *drawn[i])); });
    drawn.resize(std::min(drawn.size(), kShown));
    return drawn;
}

void removeEarlierPanels(const fs::path& folder)
{
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("diff_") && name.ends_with(".png")) old.push_back(entry.path());
    }
    for (const fs::path& file : old) fs::remove(file);
}

}  // namespace

void writeDiffPage(const DiffResult& result, const fs::path& folder)
{
    for (const fs::path& of : {result.of.a, result.of.b})
        if (fs::weakly_canonical(folder) == fs::weakly_canonical(fs::is_directory(of) ? of : fs::absolute(of).parent_path()))
            throw sim::InputError(fmt::format("--out {}: there is what is compared; choose another folder", folder.string()));
    makeFolder(folder);
    removeEarlierPanels(folder);
    const std::string title = fmt::format("{} against {}", result.of.a.string(), result.of.b.string());
    std::string html =
        fmt::format("{}<title>{}</title></head><body>\n<h1>A: {}<br>B: {}</h1>\n<p class=\"{}\">{}</p>\n", kPageHead, escaped(title),
                    escaped(result.of.a.string()), escaped(result.of.b.string()), classOf(result.differs()), escaped(result.verdict()));
    for (const PictureDiff* p : drawAllPanels(result, folder))
        html += fmt::format(
            "<figure><figcaption class=\"{}\">{}</figcaption><img alt=\"A, B and what differs\" src=\"data:image/png;base64,{}\"></figure>\n",
            classOf(p->differs), escaped(wordsOf(*p, result.tolerance.pictures)), base64(readWhole(panelsFile(folder, *p))));
    if (!result.pictures.empty()) html += chart(result.pictures) + picturesTable(result);
    if (!result.findings.empty()) html += numbersTable(result.findings);
    writeWhole(folder / "diff.html", html + "</body></html>\n");
}

}  // namespace app
