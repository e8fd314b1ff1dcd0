#include "app/import/imported_fabric.h"
#include "sim/core/check.h"
#include "sim/scene/read_fabrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace app {

namespace {

constexpr int kLargestPatch = 8;

/// The vertices that these words hold; none where they mean nothing.
std::vector<int> heldBy(const std::string& words, const sim::FabricGeometry& geometry)
{
    static const auto kSource = std::make_shared<const sim::TextSource>(sim::TextSource{.name = "import"});
    try {
        const sim::Node node = sim::parseYaml("{" + words + "}", kSource);
        return sim::readPins(node, "pin", geometry, geometry.points, 1.0)[0].vertices;
    } catch (const sim::InputError&) {
        return {};
    }
}

/// "x-", "x- z+", …: whatever may name a corner or, if it is one word, a side.
std::vector<std::string> endWords(bool onlySides)
{
    std::vector<std::string> sides, all;
    for (const char axis : {'x', 'y', 'z'})
        for (const char end : {'-', '+'}) sides.push_back({axis, end});
    if (onlySides) return sides;
    for (const std::string& a : sides)
        for (const std::string& b : sides)
            if (a[0] < b[0]) all.push_back(a + " " + b);
    all.insert(all.end(), sides.begin(), sides.end());
    return all;
}

/// The corners that together are these vertices, as "[x- z-, x- z+]"; empty if there are none such.
std::string cornersOf(const sim::FabricGeometry& geometry, const std::vector<int>& vertices, const std::string& patch)
{
    std::vector<std::vector<int>> taken;
    std::vector<int> together;
    std::string list;
    for (const std::string& word : endWords(false)) {
        const std::vector<int> corner = heldBy(fmt::format("corners: [{}]{}", word, patch), geometry);
        if (corner.empty() || !std::ranges::includes(vertices, corner) || std::ranges::find(taken, corner) != taken.end()) continue;
        taken.push_back(corner);
        std::vector<int> more;
        std::ranges::set_union(together, corner, std::back_inserter(more));
        if (more.size() == together.size()) continue;
        together = std::move(more);
        list += (list.empty() ? "" : ", ") + word;
    }
    return together == vertices ? fmt::format("corners: [{}]{}", list, patch) : "";
}

std::string numbersOf(const std::vector<int>& vertices) { return fmt::format("nodes: [{}]", fmt::join(vertices, ", ")); }

}  // namespace

std::string pinSelection(const sim::FabricGeometry& geometry, const std::vector<int>& vertices)
{
    if (geometry.lattice.empty()) return numbersOf(vertices);
    for (const bool borderOnly : {false, true}) {
        for (int size = 1; size <= kLargestPatch; ++size) {
            const std::string patch = fmt::format("{}{}", size > 1 ? fmt::format(", patch: {}", size) : "", borderOnly ? ", border_only: true" : "");
            const std::string all = "corners: all" + patch;
            if (heldBy(all, geometry) == vertices) return all;
            for (const std::string& word : borderOnly ? std::vector<std::string>{} : endWords(true))
                if (const std::string edge = fmt::format("edge: {}{}", word, patch); heldBy(edge, geometry) == vertices) return edge;
            if (const std::string some = cornersOf(geometry, vertices, patch); !some.empty()) return some;
        }
    }
    return numbersOf(vertices);
}

namespace {

/// Vertices in front of one that is held with its twist: libWetCloth's twist of a vertex is that of the edge behind it,
/// which a pin at the edge's other end holds too.
std::vector<char> twistHeldByNext(const ImportedPiece& piece, const reference::Scene& scene)
{
    std::vector<char> isHeld(piece.particles.size(), 0);
    for (const std::vector<int>& strand : piece.shape.geometry.strands) {
        for (std::size_t i = 1; i < strand.size(); ++i) {
            const reference::Particle& next = scene.particles[piece.particles[strand[i]]];
            if (next.isHeld && next.isTwistHeld) isHeld[strand[i - 1]] = 1;
        }
    }
    return isHeld;
}

void reportLoneTwistPins(const ImportedPiece& piece, const reference::Scene& scene, ImportReport& report)
{
    const std::vector<char> isHeldByNext = twistHeldByNext(piece, scene);
    int byNeighbour = 0, lost = 0;
    for (std::size_t v = 0; v < piece.particles.size(); ++v) {
        const reference::Particle& particle = scene.particles[piece.particles[v]];
        if (!particle.isTwistHeld || particle.isHeld) continue;
        (isHeldByNext[v] ? byNeighbour : lost) += 1;
    }
    if (byNeighbour > 0)
        report.decisions.push_back(
            fmt::format("{}: the twist of {} free vertices (fixed=2) is that of an edge whose other end is held with "
                        "its twist, so the pin there holds it",
                        piece.name, byNeighbour));
    if (lost > 0)
        report.warnings.push_back(fmt::format(
            "{}: {} vertices whose twist is held while they are free (fixed=2); pins of scene files hold the place too", piece.name, lost));
}

}  // namespace

std::vector<ImportedPin> importPins(const ImportedPiece& piece, const reference::Scene& scene, ImportReport& report)
{
    std::map<std::pair<int, bool>, ImportedPin> byGroup;
    const bool isYarn = piece.shape.geometry.faces.empty();
    for (std::size_t v = 0; v < piece.particles.size(); ++v) {
        const reference::Particle& particle = scene.particles[piece.particles[v]];
        if (!particle.isHeld) continue;
        const int group = isMovedGroup(scene, particle.group) ? particle.group : -1;
        ImportedPin& pin = byGroup[{group, isYarn && particle.isTwistHeld}];
        pin.group = group;
        pin.twist = isYarn && particle.isTwistHeld;
        pin.vertices.push_back(static_cast<int>(v));
    }
    std::vector<ImportedPin> pins;
    for (auto& [key, pin] : byGroup) {
        pin.selection = pinSelection(piece.shape.geometry, pin.vertices);
        pins.push_back(std::move(pin));
    }
    if (isYarn) reportLoneTwistPins(piece, scene, report);
    return pins;
}

}  // namespace app
