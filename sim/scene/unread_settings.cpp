#include "sim/scene/unread_settings.h"

#include "sim/scene/parameters.h"
#include "sim/scene/surface_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace sim {

namespace {

/// What reads the settings whose paths begin so, and whether it is there; `*` stands for a name.
struct Reader {
    std::string_view path;
    bool isThere;
    std::string_view what;
};

void addFabricReaders(const Scene& scene, std::vector<Reader>& readers)
{
    const FabricSettings& f = scene.settings.fabric;
    const CouplingSettings& c = scene.settings.coupling;
    const bool hasFabric = !scene.fabrics.empty(), isGrid = f.solver == FabricSolver::Grid, isVertex = f.solver == FabricSolver::Vertex;
    for (std::string_view section : {"fabric.", "porous.", "coupling."}) readers.push_back({section, hasFabric, "fabrics"});
    for (std::string_view path : {"time.max_cfl.fabric", "transfer.method.fabric", "transfer.modes.fabric", "transfer.xi.fabric",
                                  "transfer.damping.fabric_", "materials.*.contact_stiffness", "materials.*.pin_stiffness"})
        readers.push_back({path, hasFabric && isGrid, "fabric.solver grid"});
    for (std::string_view path : {"fabric.newton", "fabric.max_halvings", "fabric.integrator"})
        readers.push_back({path, isVertex, "fabric.solver vertex"});
    readers.push_back({"materials.*.friction_angle", f.contact, "fabric.contact true"});
    readers.push_back({"fabric.hinge.", f.bending == BendingModel::Hinge, "fabric.bending hinge"});
    readers.push_back({"coupling.drag_exponent", c.drag != DragLaw::Linear, "coupling.drag nonlinear"});
    readers.push_back({"coupling.capillary_reaction", c.capillary, "coupling.capillary true"});
    readers.push_back({"coupling.capture.published_rate_factor", c.capture.rate > 0.0, "a coupling.capture.rate above 0"});
    for (std::string_view path : {"coupling.wicking.suction_exponent", "coupling.wicking.permeability_exponent", "coupling.wicking.pressure"})
        readers.push_back({path, c.wicking.rateScale > 0.0, "a coupling.wicking.rate_scale above 0"});
    for (std::string_view path : {"coupling.cohesion.fabric", "coupling.cohesion.obstacle"})
        readers.push_back({path, c.cohesion.strength > 0.0, "a coupling.cohesion.strength above 0"});
}

void addLiquidReaders(const Scene& scene, std::vector<Reader>& readers)
{
    const LiquidSettings& l = scene.settings.liquid;
    const TransferSettings& t = scene.settings.transfer;
    const bool hasFabric = !scene.fabrics.empty(), isPolyPic = t.method == TransferMethod::PolyPic, isPic = t.modeCount() == 1;
    readers.push_back({"time.cfl", scene.settings.time.mode != TimeMode::Fixed, "time.mode cfl and adaptive"});
    readers.push_back({"transfer.modes.liquid", isPolyPic, "transfer.method polypic"});
    readers.push_back({"transfer.xi.liquid", !isPic, "transfer.method apic and polypic"});
    readers.push_back({"transfer.damping.liquid_affine", !isPic, "transfer.method apic and polypic"});
    readers.push_back({"transfer.damp_modes", isPolyPic || scene.settings.fabric.solver == FabricSolver::Grid, "transfer.method polypic"});
    readers.push_back({"transfer.flip_ratio", t.method == TransferMethod::Flip, "transfer.method flip"});
    readers.push_back({"liquid.viscosity_substeps", l.solveViscosity, "liquid.solve_viscosity true"});
    readers.push_back({"solver.viscosity_tolerance", l.solveViscosity, "liquid.solve_viscosity true"});
    readers.push_back({"liquid.viscosity", l.solveViscosity || hasFabric, "liquid.solve_viscosity true, and fabrics"});
    readers.push_back({"liquid.curvature_smoothing", l.surfaceTensionForce, "liquid.surface_tension_force true"});
    readers.push_back({"liquid.surface_order", canCorrectStrain(scene),
                       "air, and solids that are resting boxes around it, in planes of the grid, that it slips along"});
    readers.push_back({"liquid.surface_tension", l.surfaceTensionForce || hasFabric, "liquid.surface_tension_force true, and fabrics"});
    readers.push_back({"liquid.contact_angle", hasFabric, "fabrics"});
    readers.push_back({"liquid.relax.range", l.relax.rate > 0.0, "a liquid.relax.rate above 0"});
    readers.push_back({"liquid.wall_friction", !scene.obstacles.empty(), "obstacles"});
}

/// Does a path begin as a reader says, or is it that?
bool isOf(std::string_view path, std::string_view pattern)
{
    const std::size_t star = pattern.find('*');
    if (star != std::string_view::npos) {
        const std::string_view before = pattern.substr(0, star), behind = pattern.substr(star + 1);
        return path.starts_with(before) && path.ends_with(behind);
    }
    const bool isPrefix = pattern.ends_with('.') || pattern.ends_with('_');
    return isPrefix ? path.starts_with(pattern) : path == pattern;
}

/// What pieces, sources and solids are given in vain.
void noteUnreadOfBodies(Scene& scene)
{
    const auto add = [&](const std::string& where, const std::string& what, std::string_view why) {
        scene.notes.push_back(fmt::format("{}: {}: has no effect here; it goes with {}", where, what, why));
    };
    for (const FabricPiece& piece : scene.fabrics)
        if (piece.wetness > 0.0 && piece.material.volumeFraction >= 1.0)
            add(piece.where, fmt::format("fabrics.{}.wetness", piece.name), "pores, a volume_fraction of its material or of porous below 1");
    const FillSettings usual;
    for (const SourceSettings& source : scene.sources)
        if (source.fill.seed != usual.seed && source.fill.pattern == FillSettings::Pattern::Lattice)
            add(source.where, fmt::format("liquid.sources.{}.fill.seed", source.name), "the patterns that are random");
    const CohesionSettings& cohesion = scene.settings.coupling.cohesion;
    for (const ObstacleSettings& solid : scene.obstacles) {
        const auto path = [&](const char* key) { return fmt::format("obstacles.{}.{}", solid.name, key); };
        if (!solid.cohesive && !(cohesion.strength > 0.0 && cohesion.obstacle)) add(solid.where, path("cohesive"), "coupling.cohesion");
        if (solid.frictionAngle && !solid.collide && !scene.fabrics.empty()) add(solid.where, path("friction_angle"), "collide true");
    }
}

}  // namespace

const Node* nodeAt(const Node& root, std::string_view path)
{
    const Node* node = &root;
    while (!path.empty() && node) {
        const std::size_t dot = std::min(path.find('.'), path.size());
        const Node* next = node->find(path.substr(0, dot));
        if (!next && path == "liquid" && node->isScalar()) return node;
        node = next;
        path.remove_prefix(std::min(dot + 1, path.size()));
    }
    return node;
}

bool isOfThisRun(const Node& root, const Node& given)
{
    const Node* compare = root.find("compare");
    const bool isShared = (compare && compare->find("variants")) || root.find("precision");
    return !isShared || !given.location.source || !given.location.source->numbered;  // of the command line
}

std::string unreadNote(const Node& given, std::string_view path, std::string_view lacking)
{
    return fmt::format("{}: {}: has no effect here; it goes with {}", given.location.text(), path, lacking);
}

void noteUnreadSettings(const Node& root, Scene& scene)
{
    noteUnreadOfBodies(scene);
    std::vector<Reader> readers;
    addFabricReaders(scene, readers);
    addLiquidReaders(scene, readers);
    std::vector<NamedMaterial> usual = scene.materials;
    for (NamedMaterial& named : usual) named.material = FabricMaterial();
    const std::vector<Parameter> given = parametersOf(scene.settings, scene.materials), defaults = parametersOf(Settings(), usual);
    for (std::size_t i = 0; i < given.size(); ++i) {
        const std::string& path = given[i].path;
        if (given[i].value == defaults[i].value) continue;
        const auto lacking = std::ranges::find_if(readers, [&](const Reader& r) { return !r.isThere && isOf(path, r.path); });
        const Node* node = lacking == readers.end() ? nullptr : nodeAt(root, path);
        if (node && isOfThisRun(root, *node)) scene.notes.push_back(unreadNote(*node, path, lacking->what));
    }
}

}  // namespace sim
