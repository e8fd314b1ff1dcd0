#include "app/import/group_fabric.h"
#include "app/import/imported_fabric.h"
#include "sim/core/units.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace app {

using reference::Scene;

namespace {

constexpr std::size_t kFewYarns = 12;  // more loose yarns go to one file

/// The group with vertices counted from 0 in the order of its particles.
ListedFabric listed(const FabricGroup& group, const Scene& scene)
{
    ListedFabric out;
    std::map<int, int> numberOf;
    for (const int p : group.particles) {
        numberOf.emplace(p, static_cast<int>(out.points.size()));
        out.points.push_back(scene.particles[p].x);
    }
    for (const sim::Vec3i& f : group.faces) out.faces.emplace_back(numberOf.at(f[0]), numberOf.at(f[1]), numberOf.at(f[2]));
    for (std::vector<int> strand : group.strands) {
        for (int& p : strand) p = numberOf.at(p);
        out.strands.push_back(std::move(strand));
    }
    return out;
}

/// The fabric as it stands in the file, for want of a generator.
GeneratedFabric asListed(const ListedFabric& fabric)
{
    GeneratedFabric out;
    out.kind = fabric.faces.empty() ? "points" : "mesh";
    out.geometry = {.points = fabric.points, .strands = fabric.strands, .faces = fabric.faces, .lattice = {}};
    out.summary = fmt::format("{} vertices, {} yarns, {} faces as they are listed, in a file of their own", fabric.points.size(),
                              fabric.strands.size(), fabric.faces.size());
    for (std::size_t i = 0; i < fabric.points.size(); ++i) out.pointOf.push_back(static_cast<int>(i));
    return out;
}

/// The radius of the particles where all have the same, else the material's.
std::array<double, 2> radiusOf(const ImportedPiece& piece, const Scene& scene, ImportReport& report)
{
    const reference::Material& material = scene.materials[piece.material];
    const std::array<double, 2> first = scene.particles[piece.particles[0]].radius;
    const auto isFirst = [&](int p) { return scene.particles[p].radius == first; };
    if (std::ranges::all_of(piece.particles, isFirst)) return first[0] > 0.0 ? first : material.radius;
    report.warnings.push_back(
        fmt::format("{}: particles have radii of their own; a piece of fabric has one, so all get that of m{}", piece.name, piece.material));
    return material.radius;
}

sim::Vec3 velocityOf(const ImportedPiece& piece, const Scene& scene, ImportReport& report)
{
    sim::Vec3 mean = sim::Vec3::Zero();
    const sim::Vec3 first = scene.particles[piece.particles[0]].v;
    bool isUniform = true;
    for (const int p : piece.particles) {
        mean += scene.particles[p].v / static_cast<double>(piece.particles.size());
        isUniform = isUniform && scene.particles[p].v == first;
    }
    if (isUniform) return first;
    report.warnings.push_back(fmt::format("{}: particles have velocities of their own; a piece of fabric has one, so all get the mean", piece.name));
    return mean;
}

/// Volume of the piece, fibres and pores [cm^3].
double envelopeVolume(const ImportedPiece& piece)
{
    const sim::FabricGeometry& g = piece.shape.geometry;
    double volume = 0.0;
    for (const sim::Vec3i& f : g.faces)
        volume += 0.5 * (g.points[f[1]] - g.points[f[0]]).cross(g.points[f[2]] - g.points[f[0]]).norm() * (piece.radius[0] + piece.radius[1]);
    for (const std::vector<int>& s : g.strands)
        for (std::size_t i = 1; i < s.size(); ++i)
            volume += (g.points[s[i]] - g.points[s[i - 1]]).norm() * sim::kPi * piece.radius[0] * piece.radius[1];
    return volume;
}

double wetnessOf(const ImportedPiece& piece, const Scene& scene, ImportReport& report)
{
    double absorbed = 0.0;
    for (const int p : piece.particles) absorbed += scene.particles[p].liquidVolume;
    const double fraction = scene.materials[piece.material].volumeFraction.value_or(scene.liquid.volumeFraction);
    const double capacity = envelopeVolume(piece) * (1.0 - fraction);
    if (!(absorbed > 0.0) || !(capacity > 0.0)) return 0.0;
    const double wetness = std::min(1.0, absorbed / capacity);
    report.decisions.push_back(fmt::format("{}: has taken up {:.4g} cm^3, {:.3g} of its pores; it is spread evenly", piece.name, absorbed, wetness));
    return wetness;
}

/// What particles say and no piece of fabric can.
void reportDropped(const ImportedPiece& piece, const Scene& scene, ImportReport& report)
{
    const auto tell = [&](const char* what, auto holds) {
        const auto count = std::ranges::count_if(piece.particles, [&](int p) { return holds(scene.particles[p]); });
        if (count > 0) report.warnings.push_back(fmt::format("{}: {} of {} particles; a piece of fabric has no such thing", piece.name, what, count));
    };
    tell("mass or volume beyond that of the fabric (m, vol)", [](const reference::Particle& p) { return p.mass != 0.0 || p.volume != 0.0; });
    tell("twist at the start (theta, omega)", [](const reference::Particle& p) { return p.isTwisted; });
    if (scene.liquid.nonuniformFraction) tell("a volume fraction (vf)", [](const reference::Particle& p) { return p.hasFraction; });
}

/// Loose yarns of one material that are a weave without borders, or too many to list, become one group.
std::vector<FabricGroup> withLooseYarnsJoined(std::vector<FabricGroup> groups, const Scene& scene)
{
    std::map<int, std::vector<FabricGroup>> loose;
    for (const FabricGroup& group : groups)
        if (group.isLooseYarn()) loose[group.material].push_back(group);
    for (const auto& [material, yarns] : loose) {
        if (yarns.size() < 2) continue;
        FabricGroup all = merged(yarns);
        if (yarns.size() <= kFewYarns && !recogniseWeave(listed(all, scene))) continue;
        std::erase_if(groups, [&, number = material](const FabricGroup& g) { return g.isLooseYarn() && g.material == number; });
        groups.push_back(std::move(all));
    }
    std::ranges::stable_sort(groups, {}, &FabricGroup::line);
    return groups;
}

GeneratedFabric shapeOf(const ListedFabric& fabric)
{
    if (auto cloth = recogniseClothGrid(fabric)) return std::move(*cloth);
    if (auto weave = recogniseWeave(fabric)) return std::move(*weave);
    if (auto strand = recogniseStrand(fabric)) return std::move(*strand);
    return asListed(fabric);
}

std::string nameOf(const GeneratedFabric& shape, std::size_t number)
{
    const char* word = shape.kind == "woven_yarns" ? "weave" : !shape.geometry.faces.empty() ? "cloth" : shape.kind == "strand" ? "yarn" : "yarns";
    return fmt::format("{}{}", word, number);
}

ImportedPiece importPiece(const FabricGroup& group, std::size_t number, const Scene& scene, ImportReport& report)
{
    ImportedPiece piece;
    piece.line = group.line;
    piece.material = group.material;
    piece.shape = shapeOf(listed(group, scene));
    piece.name = nameOf(piece.shape, number);
    for (const int p : piece.shape.pointOf) piece.particles.push_back(group.particles[p]);
    piece.radius = radiusOf(piece, scene, report);
    piece.velocity = velocityOf(piece, scene, report);
    piece.wetness = wetnessOf(piece, scene, report);
    piece.pins = importPins(piece, scene, report);
    reportDropped(piece, scene, report);
    report.recognised.push_back(fmt::format("{}: {}, {}{}", piece.name, piece.shape.kind, piece.shape.summary,
                                            piece.hasFile() ? "" : fmt::format(", deviation {:.1e} cm", piece.shape.deviation)));
    return piece;
}

}  // namespace

bool isMovedGroup(const Scene& scene, int group)
{
    return std::ranges::any_of(scene.scripts, [&](const reference::Script& s) { return s.group == group; });
}

std::vector<ImportedPiece> importFabrics(const Scene& scene, ImportReport& report)
{
    std::vector<ImportedPiece> pieces;
    for (const FabricGroup& group : withLooseYarnsJoined(groupFabric(scene, report), scene))
        pieces.push_back(importPiece(group, pieces.size(), scene, report));
    return pieces;
}

std::string objText(const sim::FabricGeometry& geometry)
{
    std::string text;
    for (const sim::Vec3& x : geometry.points) text += fmt::format("v {} {} {}\n", x[0], x[1], x[2]);
    for (const sim::Vec3i& f : geometry.faces) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    for (const std::vector<int>& s : geometry.strands) {
        text += "l";
        for (const int v : s) text += fmt::format(" {}", v + 1);
        text += "\n";
    }
    return text;
}

}  // namespace app
