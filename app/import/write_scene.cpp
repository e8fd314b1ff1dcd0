#include "app/import/write_scene.h"
#include "app/import/lattice_fit.h"

#include "sim/scene/node.h"
#include "sim/scene/old_keys.h"
#include "sim/scene/units.h"
#include "sim/settings.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace app {

using sim::formatPlain;

namespace {

constexpr double kFrameTime = 4.0e-3;  // of the published videos: 20 steps of 2e-4 s [s]

std::string quoted(const std::string& text) { return sim::Node::scalar(text, {}).flow(); }

void writeHead(const ImportedScene& scene, SceneLines& out)
{
    const reference::Scene& r = scene.reference;
    out.add(0, fmt::format("# Imported from {}, a scene of libWetCloth. What was decided on the way stands in {}.", scene.from, scene.report));
    out.add(0, "drench: 1");
    out.add(0, "units: cgs");
    out.add(0, "scene:");
    out.add(1, "name: " + scene.name);
    if (!r.description.empty()) out.add(1, "description: " + quoted(r.description));
    if (!r.tag.empty()) out.add(1, fmt::format("tags: [{}]", quoted(r.tag)));
    out.blank();
    out.from(r.run.line);
    out.add(0, fmt::format("time: {{dt: {}, duration: {}, integrator: plain}}", formatPlain(r.run.dt), formatPlain(r.run.duration)));
    out.add(0, fmt::format("grid: {{cell: {}}}", formatPlain(r.run.cell)));
    out.add(0, fmt::format("gravity: {}", yamlList(r.run.gravity)));
    out.add(0, fmt::format("solver: {{max_iterations: {}}}", std::max(200, r.run.maxIterations)));
}

/// "8", or of both where they differ.
std::string modesText(const ImportedScene& scene)
{
    const reference::LiquidInfo& l = scene.reference.liquid;
    const int fabric = std::min(l.solidModes, sim::FabricTransferSettings::kMostModes);
    if (!scene.hasFabric() || l.fluidModes == fabric) return std::to_string(l.fluidModes);
    return fmt::format("{{liquid: {}, fabric: {}}}", l.fluidModes, fabric);
}

void writeTransfer(const ImportedScene& scene, const char* method, SceneLines& out)
{
    const reference::LiquidInfo& l = scene.reference.liquid;
    const bool isPolyPic = std::string_view(method) == "polypic";
    out.blank();
    out.add(0, "transfer:");
    out.add(1, fmt::format("method: {}", method));
    out.from(l.line);
    if (isPolyPic) out.add(1, "modes: " + modesText(scene));
    out.add(1, "xi: translation");
    const std::string fabric = scene.hasFabric() && !scene.vertexSolver
                                   ? fmt::format(", fabric_stretch: {}, fabric_rotation: {}, fabric_velocity: {}", sim::lostText(l.stretchKept),
                                                 sim::lostText(l.rotationKept), sim::lostText(l.velocityKept))
                                   : "";
    out.add(1, fmt::format("damping: {{liquid_affine: {}{}}}", sim::lostText(l.affineKept), fabric));
    out.add(1, fmt::format("damping_dt: {}", formatPlain(scene.reference.run.dt)));
    if (isPolyPic) out.add(1, "damp_modes: false          # as published: damping acts on affine velocities only");
}

void writeObstacles(const ImportedScene& scene, SceneLines& out)
{
    if (scene.bodies.obstacles.empty()) return;
    out.blank();
    out.add(0, "obstacles:");
    for (const ImportedBodies::Obstacle& o : scene.bodies.obstacles) {
        out.from(o.line);
        out.add(1, "- name: " + o.name);
        out.add(2, "shape: " + o.shape);
        if (o.inside) out.add(2, "inside: true");
        if (scene.hasFabric()) {
            out.add(2, fmt::format("collide: {}", yesOrNo(scene.reference.liquid.levelSetForce)));
            if (!o.sampled && scene.vertexSolver && scene.reference.liquid.coheres()) out.add(2, "cohesive: false");
        }
        if (!o.motion.empty()) out.add(2, "motion: " + o.motion);
    }
}

void writeMotions(const ImportedScene& scene, SceneLines& out)
{
    if (scene.motions.empty()) return;
    out.blank();
    out.add(0, "motion:");
    for (const auto& [group, pieces] : scene.motions) {
        for (const reference::Script& s : scene.reference.scripts)
            if (s.group == group) out.from(s.line);
        out.add(1, fmt::format("group{}: {}", group, pieces));
    }
}

void writeCamera(const reference::Scene& r, SceneLines& out)
{
    if (r.background) out.add(1, "background: " + yamlList(*r.background));
    if (!r.camera || !(r.camera->distance > 0.0)) return;
    const auto& [x, y, z, w] = r.camera->rotation;
    const Eigen::Quaterniond given(w, x, y, z);
    const Eigen::Quaterniond turn = given.norm() > 0.0 ? given.normalized() : Eigen::Quaterniond::Identity();
    const sim::Vec3 eye = r.camera->center + turn * sim::Vec3(0.0, 0.0, r.camera->distance);
    out.add(1, fmt::format("camera: {{look_at: {}, eye: {}, up: {}, fov: {}}}", yamlList(r.camera->center), yamlList(shortest(eye)),
                           yamlList(shortest(sim::Vec3(turn * sim::Vec3::UnitY()))), formatPlain(r.camera->fov)));
}

void writeOutput(const reference::Scene& r, SceneLines& out)
{
    out.blank();
    out.from(r.run.line);
    if (r.background || r.camera) out.add(0, "render:");
    writeCamera(r, out);
    const double steps = std::max(1.0, std::round(kFrameTime / r.run.dt));
    out.add(0, fmt::format("output: {{every: {}, frames: png, data: [energy, stats], video: {{fps: 50}}}}",
                           formatPlain(std::min(steps * r.run.dt, r.run.duration))));
}

}  // namespace

ChosenMethod chosenMethod(const reference::Run& run, const ImportOptions& options)
{
    constexpr const char* kMethods[] = {"pic", "apic", "polypic"};
    if (run.picMethod) return {kMethods[*run.picMethod], ""};
    if (options.strictFork) return {"pic", "no picMethod: pic, as the PolyPIC fork reads the file (--strict-fork)"};
    if (run.apic)
        return {*run.apic ? "apic" : "pic", fmt::format("no picMethod, but apic={}: {}, as the file means it; the "
                                                        "PolyPIC fork would run it as PIC (--strict-fork)",
                                                        *run.apic ? 1 : 0, *run.apic ? "apic" : "pic")};
    return {"apic", "neither picMethod nor apic: apic, as in 2018; the PolyPIC fork would run it as PIC (--strict-fork)"};
}

SceneLines writeScene(const ImportedScene& scene, const std::function<std::string(const ImportedPiece&)>& fileOf)
{
    SceneLines out;
    writeHead(scene, out);
    writeTransfer(scene, scene.method, out);
    writeLiquid(scene, out);
    writeFabrics(scene, fileOf, out);
    writeObstacles(scene, out);
    if (!scene.bodies.domain.empty()) {
        out.blank();
        out.from(scene.bodies.domainLine);
        out.add(0, "domain: " + scene.bodies.domain);
    }
    writeMotions(scene, out);
    writeOutput(scene.reference, out);
    return out;
}

}  // namespace app
