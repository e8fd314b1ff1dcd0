#include "app/import/imported_bodies.h"
#include "app/import/lattice_fit.h"
#include "app/import/recognise.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

using reference::Script;
using sim::formatPlain;

namespace {

std::string spanText(const Script& s) { return fmt::format("t: [{}, {}]", formatPlain(s.start), formatPlain(s.end)); }

std::string easedSpanText(const Script& s)
{
    return fmt::format("{}, ease: [{}, {}]", spanText(s), formatPlain(shortest(s.easeStart)), formatPlain(shortest(s.easeEnd)));
}

/// What turns about a point of its own takes it along.
std::string axisText(const Script& s, const sim::Vec3& center)
{
    return fmt::format("axis: {}, origin: {}, frame: {}", yamlList(s.direction.normalized()), yamlList(s.origin.value_or(center)),
                       s.origin ? "world" : "local");
}

std::string degrees(double radians) { return sim::formatNumber(radians, sim::Quantity::Angle); }

/// Places along the direction, one every so often, as offsets from the first.
std::string pathText(const Script& s)
{
    std::string rows;
    for (std::size_t i = 0; i < s.base.size(); ++i) {
        const double t = s.start + static_cast<double>(i) * s.baseStep;
        if (t > s.end + 0.5 * s.baseStep) break;
        const sim::Vec3 offset = (s.base[i] - s.base[0]) * s.direction.normalized();
        rows += fmt::format("{}[{}, {}, {}, {}]", rows.empty() ? "" : ", ", formatPlain(t), formatPlain(offset[0]), formatPlain(offset[1]),
                            formatPlain(offset[2]));
    }
    return fmt::format("{{interp: cubic, keys: [{}]}}", rows);
}

/// A script as one piece of a motion; empty where it moves nothing, or cannot be said.
std::string pieceText(const Script& s, const sim::Vec3& center, ImportReport& report)
{
    if (!(s.direction.norm() > 0.0) || (s.rotates && s.course == "cubic" && s.angle == 0.0)) {
        report.decisions.push_back(fmt::format("the script of line {} moves by nothing and is left out", s.line));
        return "";
    }
    if (s.course == "cosine") {
        report.decisions.push_back(
            fmt::format("the script of line {} swings as a cosine with eases; here as a sine without, a quarter of a "
                        "period earlier, from where it stands",
                        s.line));
        const std::string frequency = formatPlain(s.frequency);
        return s.rotates ? fmt::format("{{{}, oscillate: {{{}, amplitude: {}, frequency: {}}}}}", spanText(s), axisText(s, center),
                                       degrees(s.amplitude), frequency)
                         : fmt::format("{{{}, oscillate: {{direction: {}, amplitude: {}, frequency: {}}}}}", spanText(s),
                                       yamlList(s.direction.normalized()), formatPlain(s.amplitude), frequency);
    }
    if (s.course == "weno") {
        if (!s.rotates) return pathText(s);
        report.warnings.push_back(
            fmt::format("the script of line {} turns through a list of angles (weno); scene files have lists of places only", s.line));
        return "";
    }
    if (s.rotates) return fmt::format("{{{}, rotate: {{{}, angle: {}}}}}", easedSpanText(s), axisText(s, center), degrees(s.angle));
    return fmt::format("{{{}, translate: {}}}", easedSpanText(s), yamlList(s.direction));
}

}  // namespace

std::string motionText(const reference::Scene& scene, int group, const sim::Vec3& center, ImportReport& report)
{
    std::string pieces;
    int rotations = 0;
    for (const Script& s : scene.scripts) {
        if (s.group != group) continue;
        const std::string piece = pieceText(s, center, report);
        if (!piece.empty()) pieces += (pieces.empty() ? "" : ", ") + piece;
        rotations += s.rotates;
    }
    if (rotations > 1)
        report.decisions.push_back(
            fmt::format("group {} is turned by {} scripts: one with an origin turns about it where it stands, one "
                        "without about the group's own "
                        "middle, which moves along; global is not read",
                        group, rotations));
    return pieces.empty() ? "" : "[" + pieces + "]";
}

}  // namespace app
