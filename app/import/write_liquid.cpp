#include "app/import/write_scene.h"

#include "sim/scene/units.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

using sim::formatPlain;

namespace {

bool isOnce(const reference::Emission& e) { return e.start == 0.0 && e.end == 0.0; }

std::string emissionText(const reference::Emission& e)
{
    const std::string volume = std::isfinite(e.maxVolume) ? fmt::format(", max_volume: {}", formatPlain(e.maxVolume)) : "";
    return fmt::format("{{from: {}, to: {}{}, velocity: {}}}", formatPlain(e.start), formatPlain(e.end), volume, yamlList(e.velocity));
}

void writeSource(const ImportedBodies::Source& source, SceneLines& out)
{
    out.from(source.line);
    out.add(2, "- name: " + source.name);
    out.add(3, "shape: " + source.shape);
    out.add(3, "fill: {pattern: reference, seed: 1}");
    if (source.emissions.size() == 1 && isOnce(source.emissions[0]) && !std::isfinite(source.emissions[0].maxVolume)) {
        if (source.emissions[0].velocity != sim::Vec3::Zero()) out.add(3, "velocity: " + yamlList(source.emissions[0].velocity));
        return;
    }
    out.add(3, "emit:");
    for (const reference::Emission& e : source.emissions) out.add(4, "- " + emissionText(e));
}

}  // namespace

void writeLiquid(const ImportedScene& scene, SceneLines& out)
{
    const reference::LiquidInfo& l = scene.reference.liquid;
    out.blank();
    out.from(l.line);
    out.add(0, "liquid:");
    out.add(1, fmt::format("density: {}", formatPlain(l.density)));
    out.add(1, fmt::format("viscosity: {}", formatPlain(l.viscosity)));
    out.add(1, fmt::format("surface_tension: {}", formatPlain(l.surfaceTension)));
    out.add(1, fmt::format("contact_angle: {}", sim::formatNumber(l.contactAngle, sim::Quantity::Angle)));
    out.add(1, fmt::format("particle_spacing: {}     # in cells", formatPlain(l.particleCellMultiplier)));
    if (!scene.bodies.obstacles.empty()) out.add(1, fmt::format("wall_friction: {}", formatPlain(l.wallFriction)));
    out.add(1, fmt::format("relax: {{rate: {}, range: {}}}", formatPlain(l.correctionStrength / (l.correctionStep * scene.reference.run.dt)),
                           formatPlain(l.correctionMultiplier)));
    out.add(1, "surface_order: 1");
    if (l.solveViscosity) {
        out.add(1, "solve_viscosity: true");
        out.add(1, fmt::format("viscosity_substeps: {}", scene.reference.run.viscositySubsteps));
    }
    if (l.surfaceTensionForce) {
        out.add(1, "surface_tension_force: true");
        out.add(1, fmt::format("curvature_smoothing: {}", l.curvatureSmoothing));
    }
    if (!scene.bodies.sources.empty()) out.add(1, "sources:");
    for (const ImportedBodies::Source& source : scene.bodies.sources) writeSource(source, out);
}

}  // namespace app
