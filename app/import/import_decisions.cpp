#include "app/import/import_decisions.h"

#include "sim/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace app {

namespace {

constexpr double kSteepestFriction = 89.0;  // of scene files [deg]

void reportMaterial(const reference::Material& m, int number, const ImportOptions& options, ImportReport& report)
{
    if (!m.hasBiradius && !options.roundSections && m.radius[0] != m.radius[1])
        report.decisions.push_back(
            fmt::format("m{}: biradius is not given, and libWetCloth's default is {} cm whatever the radius: sections "
                        "are [{}, {}] cm "
                        "(--round-sections takes the radius for both)",
                        number, m.radius[1], m.radius[0], m.radius[1]));
    if (m.unreadFrictionAngle)
        report.decisions.push_back(options.trustFrictionAngle
                                       ? fmt::format("m{}: friction_angle={} deg counts (--trust-friction-angle)", number, *m.unreadFrictionAngle)
                                       : fmt::format("m{}: friction_angle={} deg is not what libWetCloth reads, which "
                                                     "is frictionAngle: the friction angle is {} deg "
                                                     "(--trust-friction-angle)",
                                                     number, *m.unreadFrictionAngle, m.frictionAngle));
    if (m.frictionAngle > kSteepestFriction)
        report.decisions.push_back(fmt::format("m{}: a friction angle of {} deg becomes {}", number, m.frictionAngle, kSteepestFriction));
}

void reportParticles(const ImportedScene& scene, ImportReport& report)
{
    std::set<int> used;
    for (const ImportedPiece& piece : scene.pieces) used.insert(piece.particles.begin(), piece.particles.end());
    int orphans = 0, heavy = 0, liquid = 0;
    for (std::size_t i = 0; i < scene.reference.particles.size(); ++i) {
        const reference::Particle& p = scene.reference.particles[i];
        if (used.contains(static_cast<int>(i))) continue;
        (p.isLiquid ? liquid : p.mass > 0.0 ? heavy : orphans) += 1;
    }
    if (orphans > 0) report.warnings.push_back(fmt::format("{} particles belong to no cloth and no yarn and have no mass: dropped", orphans));
    if (heavy > 0)
        report.warnings.push_back(
            fmt::format("{} particles with a mass belong to no cloth and no yarn: dropped, scene files have no lone masses", heavy));
    if (liquid > 0)
        report.warnings.push_back(fmt::format("{} particles of liquid are listed one by one: dropped, scene files have sources only", liquid));
}

/// Groups have names where something moves them; elsewhere libWetCloth draws them in other shades of grey.
void reportGroups(const reference::Scene& scene, ImportReport& report)
{
    std::set<int> still;
    for (const reference::Particle& p : scene.particles)
        if (!isMovedGroup(scene, p.group)) still.insert(p.group);
    if (still.size() > 1)
        report.decisions.push_back(
            fmt::format("groups {} of particles are moved by no script, so their numbers are not kept", fmt::join(still, ", ")));
}

void reportCohesion(const reference::LiquidInfo& l, bool vertexSolver, ImportReport& report)
{
    if (!l.coheres()) return;
    if (vertexSolver)
        report.decisions.push_back(
            fmt::format("cohesionCoeff={} is coupling.cohesion.strength: of bridges that hold by the length of threads and "
                        "by saturation, not by the element",
                        l.cohesionCoeff));
    else report.warnings.push_back(fmt::format("cohesion of wet fabric ({}): fabric.solver grid has none (--solver vertex has)", l.cohesionCoeff));
}

void reportUncoupled(const reference::LiquidInfo& l, ImportReport& report)
{
    if (l.airDrag) report.warnings.emplace_back("drag by air (dragByAir): this version has none");
    if (l.varyingFraction) report.warnings.emplace_back("a volume fraction that changes with stretch (useVaryingFraction): this version has none");
    if (l.porePressureOnFabric) report.warnings.emplace_back("pore pressure on fabric (applyPorePressureSolid): this version has none");
    if (l.levelSetForce)
        report.decisions.push_back(
            fmt::format("how hard solids push fabric follows from its mass and the step, not from levelsetYoungModulus={} and levelsetThickness={}",
                        l.levelsetYoung, l.levelsetThickness));
    if (!l.dragByFutureSolid)
        report.decisions.emplace_back(
            "dragByFutureSolid=0 is a defect of libWetCloth, which loses momentum: drag is with the fabric's new "
            "velocity");
    if (!l.porousNote.empty()) report.decisions.push_back(l.porousNote);
}

void reportFabric(const ImportedScene& scene, const ImportOptions& options, ImportReport& report)
{
    const reference::Scene& r = scene.reference;
    if (!scene.hasFabric()) {
        report.decisions.emplace_back("there is no fabric, so materials, pores and coupling are left out");
        return;
    }
    reportCohesion(r.liquid, scene.vertexSolver, report);
    reportUncoupled(r.liquid, report);
    if (r.liquid.solidModes > sim::FabricTransferSettings::kMostModes)
        report.decisions.push_back(fmt::format("scalarModes={}: fabric has {} modes at most, as a sheet is surface everywhere", r.liquid.solidModes,
                                               sim::FabricTransferSettings::kMostModes));
    reportGroups(r, report);
    std::set<int> used;
    for (const ImportedPiece& piece : scene.pieces) used.insert(piece.material);
    for (std::size_t m = 0; m < r.materials.size(); ++m) {
        if (used.contains(static_cast<int>(m))) reportMaterial(r.materials[m], static_cast<int>(m), options, report);
        else report.decisions.push_back(fmt::format("the material of line {} is of no fabric and is left out", r.materials[m].line));
    }
    report.decisions.emplace_back(scene.vertexSolver ? "fabric.solver is vertex, this program's own (--solver vertex): pins hold "
                                                       "exactly, bending and twist are its own"
                                                     : "fabric.solver is grid, the published method without its defects: hinges with "
                                                       "constant 3, polar torsion, springs at pins (--solver vertex)");
}

void reportRun(const ImportedScene& scene, ImportReport& report)
{
    const reference::Scene& r = scene.reference;
    report.decisions.emplace_back(
        "steps and transfers are as published: time.integrator plain, transfer.xi translation, liquid.surface_order 1, and keep "
        "for each step of the file");
    if (r.run.maxIterations < 200)
        report.decisions.push_back(fmt::format("solver.max_iterations is 200, not maxiters={}: a solve stops when it is done", r.run.maxIterations));
    if (!scene.bodies.sources.empty())
        report.decisions.emplace_back(
            "sources are filled as published (fill: reference, a little over half of their volume); lattice would fill "
            "them");
    if (!scene.bodies.sources.empty())
        report.decisions.push_back(
            fmt::format("particles are pushed apart as published (liquid.relax, from correctionStep {} and strength "
                        "{}), and this program's liquid.volume acts too",
                        r.liquid.correctionStep, r.liquid.correctionStrength));
    if (!r.springLines.empty())
        report.warnings.push_back(
            fmt::format("{} springs along edges (springforce, the first in line {}): scene files have none", r.springLines.size(), r.springLines[0]));
    if (r.poseLine) report.warnings.push_back(fmt::format("the pose of line {}: the fabric starts as the particles say", *r.poseLine));
}

}  // namespace

void reportDecisions(const ImportedScene& scene, const ImportOptions& options, ImportReport& report)
{
    const std::string why = chosenMethod(scene.reference.run, options).why;
    if (!why.empty()) report.decisions.push_back(why);
    reportRun(scene, report);
    reportFabric(scene, options, report);
    reportParticles(scene, report);
}

void reportCounts(const ImportedScene& scene, ImportReport& report)
{
    std::size_t vertices = 0, yarns = 0, edges = 0, faces = 0, held = 0;
    for (const ImportedPiece& piece : scene.pieces) {
        vertices += piece.particles.size();
        faces += piece.shape.geometry.faces.size();
        yarns += piece.shape.geometry.strands.size();
        for (const std::vector<int>& s : piece.shape.geometry.strands) edges += s.size() - 1;
        for (const ImportedPin& pin : piece.pins) held += pin.vertices.size();
    }
    report.counts.push_back(fmt::format("particles of the file {}, vertices {}, of them {} held", scene.reference.particles.size(), vertices, held));
    report.counts.push_back(fmt::format("yarns {}, edges {}, faces {}, pieces of fabric {}", yarns, edges, faces, scene.pieces.size()));
    report.counts.push_back(fmt::format("sources {}, obstacles {}, domain {}, scripts {}", scene.bodies.sources.size(), scene.bodies.obstacles.size(),
                                        scene.bodies.domain.empty() ? "none" : "1", scene.reference.scripts.size()));
}

}  // namespace app
