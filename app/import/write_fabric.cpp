#include "app/import/write_scene.h"

#include "sim/scene/node.h"
#include "sim/scene/units.h"
#include "sim/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace app {

using sim::formatPlain;

namespace {

constexpr double kSteepestFriction = 89.0;  // of scene files [deg]

std::string radiusText(const std::array<double, 2>& radius)
{
    return radius[0] == radius[1] ? formatPlain(radius[0]) : fmt::format("[{}, {}]", formatPlain(radius[0]), formatPlain(radius[1]));
}

void writeCoupling(const reference::LiquidInfo& l, bool vertexSolver, SceneLines& out)
{
    const std::string cohesion = vertexSolver && l.coheres()
                                     ? fmt::format(", cohesion: {{strength: {}, fabric: {}, obstacle: {}}}", formatPlain(l.cohesionCoeff),
                                                   yesOrNo(l.softCohesion), yesOrNo(l.solidCohesion))
                                     : "";
    out.blank();
    out.from(l.line);
    out.add(0, fmt::format("porous: {{fibre_diameter: {}, volume_fraction: {}}}", formatPlain(l.fibreDiameter), formatPlain(l.volumeFraction)));
    out.add(0, fmt::format("coupling: {{drag: {}, drag_fraction: cell, drag_exponent: {}, pressure_on_fabric: {}, "
                           "capture: {{law: published, published_rate_factor: {}}}, wicking: {{pressure: {}}}{}}}",
                           !l.drag           ? "off"
                           : l.nonlinearDrag ? "nonlinear"
                                             : "linear",
                           formatPlain(l.yazdchiPower), yesOrNo(l.pressureOnFabric),
                           formatPlain(sim::CaptureSettings().publishedRateFactor * l.captureRate), yesOrNo(l.pressureInFabric), cohesion));
}

void writeSolver(const ImportedScene& scene, SceneLines& out)
{
    const reference::LiquidInfo& l = scene.reference.liquid;
    out.blank();
    const char* solver = !l.solveSolid ? "off" : scene.vertexSolver ? "vertex" : "grid";
    const char* measure = l.bendingScheme == "tantheta" ? "tan" : l.bendingScheme == "sintheta" ? "sin" : "angle";
    const std::string published =
        scene.vertexSolver ? "" : fmt::format(", bending: hinge, hinge: {{constant: 3, measure: {}}}, torsion: polar", measure);
    out.add(0, fmt::format("fabric: {{solver: {}, twist: {}{}}}", solver, yesOrNo(l.twist), published));
}

void writeMaterial(const reference::Material& m, int number, bool vertexSolver, SceneLines& out)
{
    std::string fields = fmt::format("young: {}, poisson: {}, density: {}, damping_viscosity: {}, damp_bending: {}, damp_stretching: {}",
                                     formatPlain(m.young), formatPlain(m.poisson), formatPlain(m.density), formatPlain(m.viscosity), yesOrNo(m.damps),
                                     yesOrNo(m.damps && !m.dampsOnlyBending));
    const auto add = [&](const char* key, const std::string& value) { fields += fmt::format(", {}: {}", key, value); };
    if (m.stretchingMultiplier != 1.0) add("stretch_factor", formatPlain(m.stretchingMultiplier));
    if (!vertexSolver) add("contact_stiffness", formatPlain(m.collisionMultiplier));
    if (!vertexSolver) add("pin_stiffness", formatPlain(m.attachMultiplier));
    add("friction_angle", formatPlain(std::min(m.frictionAngle, kSteepestFriction)));
    if (m.volumeFraction) add("volume_fraction", formatPlain(*m.volumeFraction));
    if (m.baseRotation != 0.0) add("section_rotation", sim::formatNumber(m.baseRotation, sim::Quantity::Angle));
    out.from(m.line);
    out.add(1, fmt::format("m{}: {{{}}}", number, fields));
}

std::string pinText(const ImportedPin& pin)
{
    const std::string name = pin.group >= 0 ? fmt::format("name: group{}, ", pin.group) : "";
    return fmt::format("{{{}{}{}}}", name, pin.selection, pin.twist ? ", twist: true" : "");
}

void writePiece(const ImportedPiece& piece, const std::string& file, SceneLines& out)
{
    out.from(piece.line);
    out.add(1, "- name: " + piece.name);
    out.add(2, piece.shape.kind + ":");
    out.add(3, fmt::format("material: m{}", piece.material));
    if (piece.hasFile()) out.add(3, "file: " + sim::Node::scalar(file, {}).flow());
    for (const auto& [key, value] : piece.shape.fields) out.add(3, key + ": " + value);
    out.add(3, "radius: " + radiusText(piece.radius));
    if (piece.velocity != sim::Vec3::Zero()) out.add(2, "velocity: " + yamlList(piece.velocity));
    if (piece.wetness > 0.0) out.add(2, "wetness: " + formatPlain(piece.wetness));
    if (piece.pins.size() == 1) out.add(2, "pin: " + pinText(piece.pins[0]));
    if (piece.pins.size() < 2) return;
    out.add(2, "pin:");
    for (const ImportedPin& pin : piece.pins) out.add(3, "- " + pinText(pin));
}

}  // namespace

void writeFabrics(const ImportedScene& scene, const std::function<std::string(const ImportedPiece&)>& fileOf, SceneLines& out)
{
    if (!scene.hasFabric()) return;
    writeCoupling(scene.reference.liquid, scene.vertexSolver, out);
    writeSolver(scene, out);
    out.add(0, "materials:");
    std::set<int> used;
    for (const ImportedPiece& piece : scene.pieces) used.insert(piece.material);
    for (const int m : used) writeMaterial(scene.reference.materials[m], m, scene.vertexSolver, out);
    out.blank();
    out.add(0, "fabrics:");
    for (const ImportedPiece& piece : scene.pieces) writePiece(piece, fileOf(piece), out);
}

}  // namespace app
