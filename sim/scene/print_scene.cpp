#include "sim/scene/describe.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/measure_region.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

namespace sim {

namespace {

std::string vectorText(const Vec3& x)
{
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]);
}

std::string boundsText(const Shape& shape)
{
    const Eigen::AlignedBox3d bounds = shape.bounds();
    if (!bounds.sizes().allFinite()) return "unbounded";
    return fmt::format("{} to {} cm", vectorText(bounds.min()), vectorText(bounds.max()));
}

void writeSource(SectionWriter& w, SourceSettings source, const Scene& scene)
{
    const double volume = measureRegion(source, scene).volume;
    w.line("- name", Node::scalar(source.name, {}).flow(),
           fmt::format("about {:.4g} cm^3 of liquid, {}", volume, boundsText(source.shape)));
    w.line("  shape", source.shapeText, "[cm]");
    w.below("  fill", "", [&](SectionWriter& inner) {
        inner.indentBy(1);
        describe(inner, source.fill);
    });
    std::string spans;
    for (Emission& e : source.emissions) {
        SectionWriter span;
        describe(span, e);
        spans += (spans.empty() ? "" : ", ") + span.flow();
    }
    w.line("  emit", "[" + spans + "]", "[s], [cm/s]");
}

void writeLiquid(SectionWriter& top, const Scene& scene)
{
    LiquidSettings liquid = scene.settings.liquid;
    top.below("liquid", "", [&](SectionWriter& w) {
        describe(w, liquid);
        w.line("sources", "", "");
        for (const SourceSettings& source : scene.sources) writeSource(w, source, scene);
    });
}

void writeObstacle(SectionWriter& w, const ObstacleSettings& obstacle)
{
    const Shape body = obstacle.inside ? obstacle.shape.inverted() : obstacle.shape;
    w.line("- name", Node::scalar(obstacle.name, {}).flow(),
           fmt::format("{}{}", obstacle.inside ? "around " : "", boundsText(body)));
    w.line("  shape", obstacle.shapeText, "[cm]");
    w.line("  inside", obstacle.inside ? "true" : "false", "The solid is everything outside of the shape");
    if (!obstacle.motionText.empty()) w.line("  motion", obstacle.motionText, "[s], [cm], [deg]");
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
    describe(w, settings);
    writeLiquid(w, scene);
    if (!scene.obstacles.empty()) w.line("obstacles", "", "");
    for (const ObstacleSettings& o : scene.obstacles) writeObstacle(w, o);
    if (scene.domain) w.line("domain", scene.domainText, "[cm] Liquid outside is deleted");
    return w.take();
}

}  // namespace sim
