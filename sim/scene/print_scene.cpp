#include "sim/fabric/fabric.h"
#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/read_changes.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <numeric>

namespace sim {

namespace {

std::string vectorText(const Vec3& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); }

std::string boundsText(const Shape& shape)
{
    const Eigen::AlignedBox3d bounds = shape.bounds();
    if (!bounds.sizes().allFinite()) return "unbounded";
    return fmt::format("{} to {} cm", vectorText(bounds.min()), vectorText(bounds.max()));
}

void writeSource(SectionWriter& w, SourceSettings source)
{
    w.line("- name", Node::scalar(source.name, {}).flow(), fmt::format("about {:.4g} cm^3 of liquid, {}", source.volume, boundsText(source.shape)));
    w.line("  shape", source.shapeText, "[cm]");
    if (source.velocityField) {
        Node formulas;
        formulas.kind = Node::Kind::List;
        for (int a = 0; a < kAxes; ++a) formulas.items.push_back(Node::scalar(source.velocityField->formula(a), {}));
        w.line("  velocity_field", formulas.flow(), "[cm/s] of x, y, z [cm]");
    }
    w.below("  fill", "", [&](SectionWriter& inner) {
        inner.indentBy(1);
        visitFields(inner, source.fill);
    });
    std::string spans;
    for (Emission& e : source.emissions) {
        SectionWriter span;
        visitFields(span, e);
        spans += (spans.empty() ? "" : ", ") + span.flow();
    }
    w.line("  emit", "[" + spans + "]", "[s], [cm/s]");
}

void writeLiquid(SectionWriter& top, const Scene& scene)
{
    LiquidSettings liquid = scene.settings.liquid;
    top.below("liquid", "", [&](SectionWriter& w) {
        visitFields(w, liquid);
        if (!scene.sources.empty()) w.line("sources", "", "");
        for (const SourceSettings& source : scene.sources) writeSource(w, source);
        if (!scene.openings.empty()) w.line("openings", "", "");
        for (OpeningSettings opening : scene.openings) {
            SectionWriter fields;
            visitFields(fields, opening);
            w.item(fmt::format("{{name: {}, {}", Node::scalar(opening.name, {}).flow(), fields.flow().substr(1)));
        }
    });
}

void writeObstacle(SectionWriter& w, const ObstacleSettings& obstacle)
{
    const Shape body = obstacle.inside ? obstacle.shape.inverted() : obstacle.shape;
    w.line("- name", Node::scalar(obstacle.name, {}).flow(), fmt::format("{}{}", obstacle.inside ? "around " : "", boundsText(body)));
    w.line("  shape", obstacle.shapeText, "[cm]");
    w.line("  inside", obstacle.inside ? "true" : "false", "The solid is everything outside of the shape");
    w.line("  collide", obstacle.collide ? "true" : "false", "Fabric touches it");
    w.line("  cohesive", obstacle.cohesive ? "true" : "false", "Wet fabric sticks to it, where there is cohesion");
    if (obstacle.frictionAngle) w.line("  friction_angle", formatNumber(*obstacle.frictionAngle, Quantity::Angle), "[deg] Of fabric on it");
    if (!obstacle.motionText.empty()) w.line("  motion", obstacle.motionText, "[s], [cm], [deg]");
}

void writeMaterials(SectionWriter& top, std::vector<NamedMaterial> materials)
{
    top.below("materials", "", [&](SectionWriter& w) {
        for (NamedMaterial& m : materials)
            w.below(Node::scalar(m.name, {}).flow(), "", [&](SectionWriter& inner) { visitFields(inner, m.material); });
    });
}

std::string pinText(const PinGroup& pin)
{
    return fmt::format("{{{}{}{}{}}}", pin.name.empty() ? "" : fmt::format("name: {}, ", Node::scalar(pin.name, {}).flow()), pin.text,
                       pin.twist ? ", twist: true" : "", pin.motionText.empty() ? "" : ", motion: " + pin.motionText);
}

std::string sizeText(const FabricPiece& piece)
{
    const Fabric fabric = assembleFabric({&piece, 1});
    const double mass = std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
    Eigen::AlignedBox3d bounds;
    for (const Vec3& x : piece.points) bounds.extend(x);
    return fmt::format("{} vertices, {} yarns, {} faces, {:.4g} g, {} to {} cm", piece.points.size(), piece.strands.size(), piece.faces.size(), mass,
                       vectorText(bounds.min()), vectorText(bounds.max()));
}

void writePiece(SectionWriter& w, const FabricPiece& piece)
{
    w.line("- name", Node::scalar(piece.name, {}).flow(), sizeText(piece));
    if (!piece.group.empty()) w.line("  group", Node::scalar(piece.group, {}).flow(), "Another name for motions");
    w.line(fmt::format("  {}", piece.kind), piece.text, "[cm]");
    if (!piece.transformText.empty()) w.line("  transform", piece.transformText, "[cm], [deg]");
    const Vec3& v = piece.velocity;
    w.line("  velocity", fmt::format("[{}, {}, {}]", formatPlain(v[0]), formatPlain(v[1]), formatPlain(v[2])), "[cm/s]");
    if (piece.wetness > 0.0) w.line("  wetness", formatPlain(piece.wetness), "Share of the pores that liquid fills at the start");
    if (piece.pins.empty()) return;
    w.below("  pin", "[cm], [s], [deg]", [&](SectionWriter& inner) {
        inner.indentBy(1);
        for (const PinGroup& pin : piece.pins) inner.item(pinText(pin));
    });
}

void writeFabric(SectionWriter& w, const Scene& scene)
{
    Settings settings = scene.settings;
    describeFabric(w, settings);
    writeMaterials(w, scene.materials);
    if (!scene.fabrics.empty()) w.line("fabrics", "", "");
    for (const FabricPiece& piece : scene.fabrics) writePiece(w, piece);
}

}  // namespace

std::string printScene(const Scene& scene)
{
    SectionWriter w;
    w.line("drench", "1", "Schema version");
    w.line("units", "cgs", "Bare numbers: cm, g, s; angles in degrees");
    Scene names = scene;
    w.below("scene", "", [&](SectionWriter& inner) { describeNames(inner, names); });
    Settings settings = scene.settings;
    visitFields(w, settings);
    writeLiquid(w, scene);
    if (!scene.fabrics.empty() || !scene.materials.empty()) writeFabric(w, scene);
    if (!scene.obstacles.empty()) w.line("obstacles", "", "");
    for (const ObstacleSettings& o : scene.obstacles) writeObstacle(w, o);
    if (scene.domain) w.line("domain", scene.domainText, "[cm] Liquid outside is deleted");
    if (!scene.changes.empty()) w.line("changes", "", "");
    for (std::size_t i = 0; i < scene.changes.size(); ++i) w.item(changeText(scene.changes[i].step, changedSettings(scene, i)));
    return w.take();
}

}  // namespace sim
