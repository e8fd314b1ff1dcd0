#include "sim/scene/read_bodies.h"

#include "sim/scene/describe.h"
#include "sim/scene/read_list.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

void checkEmission(const Emission& e, const Node& node, const std::string& path, double start)
{
    if (e.to < start) fail(node.location, fmt::format("{}: ends at {} s, before the run starts at {} s", path, e.to, start));
    const bool isInitial = e.from == start && e.to == start;
    if (!isInitial && !(e.to > e.from)) fail(node.location, fmt::format("{}: to must be after from", path));
}

/// Why an emission is asked for nothing, or "".
std::string whyNothing(const Emission& e, const TimeSettings& time)
{
    if (e.from == e.to) return "";
    const double begin = time.start, end = time.start + time.duration;
    if (e.to <= begin || e.from >= end)
        return fmt::format("nothing comes from {:.6g} to {:.6g} s: the run is from {:.6g} to {:.6g} s", e.from, e.to, begin, end);
    if (e.velocity.isZero(0.0)) return "without a velocity the source is asked for nothing but to stay full; give it one to make it flow";
    return "";
}

std::vector<Emission> readEmissions(const Node& source, const std::string& path, const Emission& initial)
{
    const Node* list = listAt(&source, "emit", joinPath(path, "emit"), "[{from: 0, to: 0.5}]");
    if (!list) return {initial};
    if (list->items.empty()) fail(list->location, fmt::format("{}.emit: is empty; remove it, or give a span like {{from: 0, to: 0.5}}", path));
    std::vector<Emission> all;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const std::string itemPath = fmt::format("{}.emit.{}", path, i);
        Emission e = initial;
        SectionReader::read(&list->items[i], itemPath, [&](auto& v) { visitFields(v, e); });
        checkEmission(e, list->items[i], itemPath, initial.from);
        all.push_back(e);
    }
    return all;
}

VelocityField readField(const Node& node, const std::string& path)
{
    const std::vector<std::string> formulas = readTexts(node, path);
    if (formulas.size() != kAxes)
        fail(node.location, fmt::format("{}: needs three formulas of x, y, z like [\"-y\", \"x\", \"0\"], not {}", path, formulas.size()));
    if (node.location.source->isSi) fail(node.location, path + ": knows centimetres only; write the file in units: cgs");
    try {
        return VelocityField({formulas[0], formulas[1], formulas[2]});
    } catch (const VelocityField::Mistake& mistake) {
        fail(node.location, fmt::format("{}: {}: {}", path, inQuotes(formulas[mistake.component]), mistake.what));
    }
}

SourceSettings readSource(const Node& node, const std::string& name, const std::string& path, const Settings& settings)
{
    SourceSettings source;
    source.name = name;
    source.where = node.location.text();
    Emission initial;
    initial.from = initial.to = settings.time.start;
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "What tables and the keys of variants call it");
        v.required("shape", "what the liquid fills, like shape: {ball: {center: [0, 5, 0], radius: 1}}");
        v.other("shape", "");
        v.vector("velocity", initial.velocity, Quantity::Velocity, "Of the liquid that starts there, and of what emit gives");
        v.other("velocity_field", "Velocity at the start instead, three formulas of x, y, z [cm/s]");
        v.section("fill", source.fill, "How particles are laid");
        v.other("emit", "Times between which it flows");
    });
    if (const Node* field = node.find("velocity_field")) source.velocityField = readField(*field, joinPath(path, "velocity_field"));
    if (source.fill.spacing == 0.0) source.fill.spacing = settings.liquid.particleSpacing;
    source.emissions = readEmissions(node, path, initial);
    const bool isJet = std::ranges::any_of(source.emissions, [](const Emission& e) { return e.from != e.to; });
    if (source.velocityField && isJet)
        fail(node.find("velocity_field")->location, path + ".velocity_field: goes without emit: it is that of the initial body");
    ReadShape shape = readShape(*node.find("shape"), joinPath(path, "shape"), settings.cell);
    source.shape = std::move(shape.shape);
    source.shapeText = std::move(shape.text);
    source.notes = std::move(shape.notes);
    for (const Emission& e : source.emissions)
        if (const std::string nothing = whyNothing(e, settings.time); !nothing.empty())
            source.notes.push_back(fmt::format("{}: {}.emit: {}", node.find("emit")->location.text(), path, nothing));
    return source;
}

OpeningSettings readOpening(const Node& node, const std::string& name, const std::string& path)
{
    OpeningSettings opening;
    opening.name = name;
    opening.where = node.location.text();
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "What messages and the keys of variants call it");
        visitFields(v, opening);
    });
    return opening;
}

/// What an opening needs of the domain: to be in a face of a box that is long enough.
void checkDomain(const OpeningSettings& opening, const Node& node, const std::string& path, double cell, const std::optional<Shape>& domain)
{
    const std::optional<Shape::AxisBox> box = domain ? domain->axisBox() : std::nullopt;
    if (!box || box->inside || box->round > 0.0)
        fail(node.location,
             path + ": is in a face of the domain, which must be a box for that, like domain: {box: {min: [0, 0, 0], max: [40, 10, 5]}}");
    constexpr double kShortest = 8.0;
    const double length = box->box.sizes()[opening.axis] / cell;
    if (length < kShortest)
        fail(node.location, fmt::format("{}: the domain is {:.3g} cells long there, and openings need {:.0f}; make it longer, or grid.cell smaller",
                                        path, length, kShortest));
}

void checkOpening(const OpeningSettings& opening, const Node& node, const std::string& path, const Settings& settings,
                  const std::optional<Shape>& domain)
{
    checkDomain(opening, node, path, settings.cell, domain);
    if (settings.liquid.full) fail(node.location, path + ": liquid.full is a closed box; leave full out, an outlet sets the pressure");
    const Vec3& gravity = settings.gravity;
    const bool hasLevel = std::isfinite(opening.level);
    if (gravity.isZero(0.0)) {
        if (hasLevel) fail(node.location, path + ".level: without gravity liquid has no level; leave it out");
        return;
    }
    if (!hasLevel) {
        if (opening.isInlet()) return;
        fail(node.location, path + ": needs a velocity at which liquid comes in, or the level of the liquid that it goes out to, like level: 4");
    }
    int up = 0;
    if (gravity.cwiseAbs().maxCoeff(&up) != gravity.norm()) fail(node.location, path + ".level: needs gravity along an axis; turn the scene");
    const Eigen::AlignedBox3d box = domain->bounds();
    const double lowest = gravity[up] < 0.0 ? box.min()[up] : -box.max()[up];
    if (!(opening.level > lowest))
        fail(node.location, fmt::format("{}.level: is below the domain, which begins at {:.6g} cm; raise it", path, lowest));
}

ObstacleSettings readObstacle(const Node& node, const std::string& name, const std::string& path, const Settings& settings)
{
    ObstacleSettings obstacle;
    obstacle.name = name;
    obstacle.where = node.location.text();
    double friction = 0.0;
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "What motions, forces and probes call it");
        v.required("shape", "the solid body, like shape: {ball: {center: [0, 0, 0], radius: 1}}");
        v.other("shape", "");
        v.flag("inside", obstacle.inside, "It is hollow: all outside of the shape is solid");
        v.other("motion", "How it moves");
        v.flag("collide", obstacle.collide, "Fabric feels it; false lets fabric through");
        v.number("friction_angle", friction, Quantity::Angle, Range::between(0.0, 89.0), "Of fabric on it; left out: that of the material");
        v.flag("cohesive", obstacle.cohesive, "Wet fabric sticks to it");
    });
    if (node.find("friction_angle")) obstacle.frictionAngle = friction;
    ReadShape shape = readShape(*node.find("shape"), joinPath(path, "shape"), settings.cell);
    obstacle.shape = obstacle.inside ? shape.shape.inverted() : std::move(shape.shape);
    obstacle.shapeText = std::move(shape.text);
    obstacle.notes = std::move(shape.notes);
    if (const Node* motion = node.find("motion")) {
        ReadMotion read = readMotion(*motion, joinPath(path, "motion"));
        obstacle.motion = std::move(read.motion);
        obstacle.motionText = std::move(read.text);
    }
    return obstacle;
}

}  // namespace

std::vector<SourceSettings> readSources(const Node& root, const Settings& settings, bool isNeeded)
{
    std::vector<SourceSettings> sources;
    const std::string path = "liquid.sources";
    const Node* list = listAt(root.find("liquid"), "sources", path, "[{shape: …}]");
    if (isNeeded && (!list || list->items.empty())) {
        fail(list ? list->location : root.location,
             "liquid.sources: a scene needs at least one source, like - shape: {ball: {center: [0, 5, 0], radius: 1}}");
    }
    for (std::size_t i = 0; list && i < list->items.size(); ++i) {
        const std::string name = nameIn(list->items[i], i, path);
        sources.push_back(readSource(list->items[i], name, joinPath(path, name), settings));
    }
    requireUnique(sources, path);
    return sources;
}

std::vector<OpeningSettings> readOpenings(const Node& root, const Settings& settings, const std::optional<Shape>& domain)
{
    std::vector<OpeningSettings> openings;
    const std::string path = "liquid.openings";
    const Node* list = listAt(root.find("liquid"), "openings", path, "[{face: x+, level: 4}]");
    for (std::size_t i = 0; list && i < list->items.size(); ++i) {
        const std::string name = nameIn(list->items[i], i, path);
        OpeningSettings opening = readOpening(list->items[i], name, joinPath(path, name));
        checkOpening(opening, list->items[i], joinPath(path, name), settings, domain);
        for (const OpeningSettings& other : openings)
            if (other.axis == opening.axis && other.isUpper == opening.isUpper)
                fail(list->items[i].location, fmt::format("{}: {} is in that face already; choose another", joinPath(path, name), other.name));
        openings.push_back(std::move(opening));
    }
    requireUnique(openings, path);
    return openings;
}

std::vector<ObstacleSettings> readObstacles(const Node& root, const Settings& settings)
{
    std::vector<ObstacleSettings> obstacles;
    if (const Node* list = listAt(&root, "obstacles", "obstacles", "[{shape: …}]")) {
        for (std::size_t i = 0; i < list->items.size(); ++i) {
            const std::string name = nameIn(list->items[i], i, "obstacles");
            obstacles.push_back(readObstacle(list->items[i], name, joinPath("obstacles", name), settings));
        }
    }
    requireUnique(obstacles, "obstacles");
    return obstacles;
}

}  // namespace sim
