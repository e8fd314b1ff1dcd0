#include "sim/scene/load_scene.h"

#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/estimate_volume.h"
#include "sim/scene/read_bodies.h"
#include "sim/scene/read_changes.h"
#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"
#include "sim/scene/section_writer.h"
#include "sim/scene/unread_settings.h"
#include "sim/shapes/thickness.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double kMaxParticles = 2.0e8;  // more do not fit into the memory of a workstation

/// Keys of the top level, whoever reads them.
template <class V>
void describeTop(V& v, Settings& settings)
{
    v.other("drench", "");
    v.other("scene", "");
    visitFields(v, settings);
    describeFabric(v, settings);
    for (const char* key : {"liquid", "materials", "fabrics", "obstacles", "domain", "motion", "changes"}) v.other(key, "");
    for (const char* key : {"render", "output", "compare", "validate", "precision"}) v.other(key, "");
    v.unsupported("benchmark", "no verb reads it; remove the section (drench bench --scene times a scene)");
    v.unsupported("test", "no verb reads it; remove the section (a scene's checks stand in validate)");
    describeLater(v);
}

void readNames(const Node& root, const std::string& file, Scene& scene)
{
    scene.name = asName(std::filesystem::path(file).stem().string());
    const Node* section = root.find("scene");
    SectionReader::read(section, "scene", [&](auto& v) { describeNames(v, scene); });
    if (scene.name.empty() || scene.name != asName(scene.name)) {
        const Node* name = section ? section->find("name") : nullptr;
        fail(name ? name->location : root.location, fmt::format("scene.name: {} may have a-z, 0-9 and _ only; {} would do", inQuotes(scene.name),
                                                                scene.name.empty() ? "drop" : asName(scene.name)));
    }
}

/// A source must hold some liquid, and not more than fits into memory.
void checkSource(const Scene& scene, std::size_t maxBoxes, SourceSettings& source)
{
    const std::string path = joinPath("liquid.sources", source.name);
    const VolumeEstimate region = estimateVolume(source, scene, maxBoxes);
    source.volume = region.volume;
    if (region.isUnbounded) fail(source.where, fmt::format("{}: reaches to infinity; intersect its shape with a box", path));
    if (region.isEmpty) {
        const bool isBodiless = estimateVolume(source, Scene{}, maxBoxes).isEmpty;
        fail(source.where, fmt::format("{}: is empty: {}", path,
                                       isBodiless ? "its shape has no volume; make its parts overlap"
                                                  : "its shape lies outside of the domain or inside obstacles; move it"));
    }
    const double pitch = source.fill.pitch() * scene.settings.cell;
    const double count = region.volume / (pitch * pitch * pitch);
    if (!(count <= kMaxParticles)) {
        fail(source.where, fmt::format("{}: would be about {:.2g} particles (at most {:.0e} are possible); use a "
                                       "larger grid.cell than {:.3g} cm",
                                       path, count, kMaxParticles, scene.settings.cell));
    }
}

/// A layer of the domain, one cell thick, behind an opening and below its level.
Eigen::AlignedBox3d behindOpening(const OpeningSettings& opening, const Scene& scene)
{
    Eigen::AlignedBox3d layer = scene.domain->bounds();
    const int a = opening.axis;
    const double cell = scene.settings.cell;
    if (opening.isUpper) layer.min()[a] = layer.max()[a] - cell;
    else layer.max()[a] = layer.min()[a] + cell;
    if (!std::isfinite(opening.level)) return layer;
    int up = 0;
    scene.settings.gravity.cwiseAbs().maxCoeff(&up);
    if (scene.settings.gravity[up] < 0.0) layer.max()[up] = std::min(layer.max()[up], opening.level);
    else layer.min()[up] = std::max(layer.min()[up], -opening.level);
    return layer;
}

/// Obstacles must leave something of an opening.
void checkOpenings(const Scene& scene)
{
    for (const OpeningSettings& opening : scene.openings) {
        const Eigen::AlignedBox3d layer = behindOpening(opening, scene);
        if ((layer.sizes().array() <= 0.0).any())
            fail(opening.where, fmt::format("liquid.openings.{}.level: is below all of the face; raise it", opening.name));
        SourceSettings mouth;
        mouth.shape = Shape::box(layer.center(), 0.5 * layer.sizes());
        constexpr std::size_t kBoxes = 100'000;
        if (estimateVolume(mouth, scene, kBoxes).isEmpty)
            fail(opening.where, fmt::format("liquid.openings.{}: obstacles close all of the face{}; leave liquid a way to it", opening.name,
                                            std::isfinite(opening.level) ? " below its level" : ""));
    }
}

/// Drag and suction know one diameter of fibres.
void checkFibres(const Node& root, const Scene& scene)
{
    const NamedMaterial* first = nullptr;
    for (const NamedMaterial& m : scene.materials) {
        if (root.find("porous") || !(m.fibreDiameter > 0.0)) continue;
        if (first && m.fibreDiameter != first->fibreDiameter)
            fail(root.find("materials")->location,
                 fmt::format("materials: fibres of {} are {:.2g} cm thick and those of {} {:.2g} cm, and liquid flows around one kind; say "
                             "porous: {{fibre_diameter: {:.2g}, volume_fraction: 0.3}}",
                             first->name, first->fibreDiameter, m.name, m.fibreDiameter, first->fibreDiameter));
        if (!first) first = &m;
    }
}

/// What liquid and fabric cannot do together.
void checkCoupling(const Node& root, const Scene& scene)
{
    const bool isWet = std::ranges::any_of(scene.fabrics, [](const FabricPiece& piece) { return piece.wetness > 0.0; });
    if (scene.fabrics.empty() || (scene.sources.empty() && scene.openings.empty() && !isWet)) return;
    checkFibres(root, scene);
    const std::string& where = scene.fabrics[0].where;
    const CouplingSettings& coupling = scene.settings.coupling;
    if (coupling.drag == DragLaw::Nonlinear && coupling.dragExponent > 1.0 && scene.settings.liquid.viscosity == 0.0)
        fail(where, fmt::format("fabrics: nonlinear drag with exponent {} is infinite at liquid.viscosity 0; give a viscosity, "
                                "or choose coupling.drag_exponent 1 or coupling.drag linear",
                                coupling.dragExponent));
}

/// Where cohesion is asked for there must be something for it to act on.
void checkCohesion(const Node& root, const Settings& settings)
{
    const Node* coupling = root.find("coupling");
    const Node* node = coupling ? coupling->find("cohesion") : nullptr;
    const CohesionSettings& cohesion = settings.coupling.cohesion;
    if (!node || !(cohesion.strength > 0.0) || !root.find("fabrics")) return;
    const auto refuse = [&](const char* why) { fail(node->location, fmt::format("coupling.cohesion: {}", why)); };
    if (settings.fabric.solver == FabricSolver::Grid) refuse("fabric.solver grid has none; choose fabric.solver: vertex, or strength: 0");
    if (!settings.fabric.contact) refuse("acts where fabric touches, and fabric.contact is false; set that true, or strength: 0");
    if (!cohesion.fabric && !cohesion.obstacle) refuse("holds neither fabric nor obstacle; set one of them true, or strength: 0");
}

/// Laws of cloth that know no warp and weft.
void checkWarp(const Node& root, const FabricSettings& fabric, const std::vector<NamedMaterial>& materials)
{
    const Node* section = root.find("fabric");
    for (const NamedMaterial& m : materials) {
        const auto refuse = [&](const char* law, const char* key, const char* other) {
            fail(section ? section->location : root.location,
                 fmt::format("fabric.{}: is alike in all directions, and materials.{} has {} along warp and weft; choose {}", law, m.name, key,
                             other));
        };
        if (m.material.stretchStiffness[0] > 0.0 && fabric.membrane == MembraneModel::NeoHookean) refuse("membrane", "stretch_stiffness", "stvk");
        if (m.material.bendingStiffness[0] > 0.0 && fabric.bending == BendingModel::Hinge) refuse("bending", "bending_stiffness", "shape_operator");
    }
}

}  // namespace

std::span<const LiquidPreset> liquidPresets()
{
    static constexpr LiquidPreset kAll[] = {
        {"water", 1.0, 8.9e-3, 72.0}, {"oil", 0.92, 0.81, 32.0}, {"honey", 1.45, 80.0, 50.0}, {"acetal", 0.7802, 2.208e-3, 20.59375}};
    return kAll;
}

void readLiquidPreset(const SectionReader& section, LiquidSettings& liquid)
{
    const Node* node = section.find("preset");
    if (!node) return;
    std::vector<std::string> names;
    for (const LiquidPreset& preset : liquidPresets()) names.emplace_back(preset.name);
    names.emplace_back("none");
    const std::size_t chosen = readChoice(*node, section.pathOf("preset"), names);
    if (chosen >= liquidPresets().size()) return;
    const LiquidPreset& preset = liquidPresets()[chosen];
    liquid.density = preset.density;
    liquid.viscosity = preset.viscosity;
    liquid.surfaceTension = preset.surfaceTension;
}

void readSettings(const Node& root, Settings& settings, std::vector<NamedMaterial>& materials)
{
    SectionReader::read(&root, "", [&](auto& v) { describeTop(v, settings); });
    SectionReader::read(root.find("liquid"), "liquid", [&](auto& v) { visitFields(v, settings.liquid); });
    materials = readMaterials(root, settings.porous);
    checkCohesion(root, settings);
    checkWarp(root, settings.fabric, materials);
}

/// Tells of cloth between whose vertices liquid slips: what solver grid holds is in them, and reaches 1.5 cells.
void noteWideMeshes(Scene& scene)
{
    if (scene.settings.fabric.solver != FabricSolver::Grid) return;
    constexpr double kCells = 1.25;
    const double cell = scene.settings.cell;
    for (const FabricPiece& piece : scene.fabrics) {
        double area = 0.0;  // twice that of the faces [cm^2]
        for (const Vec3i& f : piece.faces) area += (piece.points[f[1]] - piece.points[f[0]]).cross(piece.points[f[2]] - piece.points[f[0]]).norm();
        if (piece.faces.empty()) continue;
        const double spacing = std::sqrt(area / static_cast<double>(piece.faces.size()));  // of a square grid: two faces to a square
        if (spacing < kCells * cell) continue;
        scene.notes.push_back(
            fmt::format("{}: vertices of fabric {} are {:.2g} cm apart, {:.2g} cells: with solver grid liquid slips between them; "
                        "a finer mesh, a grid.cell of {:.2g} cm or solver vertex would hold it",
                        piece.where, piece.name, spacing, spacing / cell, spacing));
    }
}

/// Tells of walls between which and the liquid the grid sees little.
void noteThinWalls(Scene& scene)
{
    constexpr double kCells = 2.0;
    const double cell = scene.settings.cell;
    for (const ObstacleSettings& solid : scene.obstacles)
        if (const double thick = thicknessOf(solid.shape, cell); thick < kCells * cell)
            scene.notes.push_back(
                fmt::format("{}: obstacle {} is {:.2g} cm thick, {:.2g} cells: liquid does not pass it, but what flows close to its two "
                            "sides is as coarse as a cell; "
                            "a grid.cell of {:.2g} cm would resolve it",
                            solid.where, solid.name, thick, thick / cell, thick / kCells));
}

Scene readScene(const SceneFile& file)
{
    Scene scene;
    scene.file = file.file;
    scene.notes = file.notes;
    const Node& root = file.root;
    readSettings(root, scene.settings, scene.materials);
    readNames(root, file.file, scene);
    scene.fabrics = readFabrics(root, scene);
    scene.obstacles = readObstacles(root, scene.settings);
    readMotions(root, scene);
    if (const Node* domain = root.find("domain")) {
        ReadShape shape = readShape(*domain, "domain", scene.settings.cell);
        scene.domain = std::move(shape.shape);
        scene.domainText = std::move(shape.text);
    }
    scene.openings = readOpenings(root, scene.settings, scene.domain);
    const bool hasInlet = std::ranges::any_of(scene.openings, &OpeningSettings::isInlet);
    scene.sources = readSources(root, scene.settings, scene.fabrics.empty() && !hasInlet);
    checkOpenings(scene);
    for (SourceSettings& source : scene.sources) checkSource(scene, root.location.source->bounds.maxBoxes, source);
    for (const FabricPiece& piece : scene.fabrics) scene.notes.insert(scene.notes.end(), piece.notes.begin(), piece.notes.end());
    for (const SourceSettings& source : scene.sources) scene.notes.insert(scene.notes.end(), source.notes.begin(), source.notes.end());
    for (const ObstacleSettings& solid : scene.obstacles) scene.notes.insert(scene.notes.end(), solid.notes.begin(), solid.notes.end());
    if (!scene.sources.empty()) {
        noteThinWalls(scene);
        noteWideMeshes(scene);
    }
    noteUnreadSettings(root, scene);
    checkCoupling(root, scene);
    scene.changes = readChanges(root, scene);
    return scene;
}

Scene loadScene(const std::filesystem::path& path, const LoadOptions& options) { return readScene(loadSceneFile(path, options)); }

}  // namespace sim
