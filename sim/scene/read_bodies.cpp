#include "sim/scene/read_bodies.h"

#include "sim/scene/describe.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace sim {

namespace {

/// The list behind a key, or nullptr; anything but a list is refused.
const Node* listAt(const Node* map, const char* key, const std::string& path, const char* example)
{
    const Node* node = map ? map->find(key) : nullptr;
    if (node && !node->isList())
        fail(node->place, fmt::format("{}: needs a list like {}, not {}", path, example, node->called()));
    return node;
}

/// The element's name, or its number where it has none: as overrides address it.
std::string nameIn(const Node& element, std::size_t index, const std::string& path)
{
    const Node* name = element.find("name");
    if (!name) return std::to_string(index);
    const std::string& text = readText(*name, joinPath(path, std::to_string(index) + ".name"));
    const auto isAllowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    if (text.empty() || !std::all_of(text.begin(), text.end(), isAllowed)) {
        fail(name->place,
             fmt::format("{}.{}.name: {} may have letters, digits, _ and - only", path, index, inQuotes(text)));
    }
    return text;
}

template <class Settings>
void requireUnique(const std::vector<Settings>& all, const std::string& path)
{
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (all[i].name == all[k].name)
                fail(all[i].where, fmt::format("{}: two are named {}; rename one", path, inQuotes(all[i].name)));
        }
    }
}

void checkEmission(const Emission& e, const Node& node, const std::string& path, double start)
{
    if (e.to < start)
        fail(node.place, fmt::format("{}: ends at {} s, before the run starts at {} s", path, e.to, start));
    const bool isInitial = e.from == start && e.to == start;
    if (!isInitial && !(e.to > e.from)) fail(node.place, fmt::format("{}: to must be after from", path));
}

std::vector<Emission> readEmissions(const Node& source, const std::string& path, const Emission& initial)
{
    const Node* list = listAt(&source, "emit", joinPath(path, "emit"), "[{from: 0, to: 0.5}]");
    if (!list) return {initial};
    if (list->items.empty())
        fail(list->place, fmt::format("{}.emit: is empty; remove it, or give a span like {{from: 0, to: 0.5}}", path));
    std::vector<Emission> all;
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const std::string itemPath = fmt::format("{}.emit.{}", path, i);
        Emission e = initial;
        SectionReader::read(&list->items[i], itemPath, [&](auto& v) { describe(v, e); });
        checkEmission(e, list->items[i], itemPath, initial.from);
        all.push_back(e);
    }
    return all;
}

SourceSettings readSource(const Node& node, const std::string& name, const std::string& path, const Settings& settings)
{
    SourceSettings source;
    source.name = name;
    source.where = node.place.text();
    Emission initial;
    initial.from = initial.to = settings.time.start;
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "");
        v.needs("shape", "what the liquid fills, like shape: {ball: {center: [0, 5, 0], radius: 1}}");
        v.other("shape", "");
        v.vector("velocity", initial.velocity, Quantity::Velocity, "");
        v.section("fill", source.fill, "");
        v.other("emit", "");
    });
    if (source.fill.spacing == 0.0) source.fill.spacing = settings.liquid.particleSpacing;
    source.emissions = readEmissions(node, path, initial);
    ReadShape shape = readShape(*node.find("shape"), joinPath(path, "shape"), settings.cell);
    source.shape = std::move(shape.shape);
    source.shapeText = std::move(shape.text);
    return source;
}

ObstacleSettings readObstacle(const Node& node, const std::string& name, const std::string& path,
                              const Settings& settings)
{
    ObstacleSettings obstacle;
    obstacle.name = name;
    obstacle.where = node.place.text();
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "");
        v.needs("shape", "the solid body, like shape: {ball: {center: [0, 0, 0], radius: 1}}");
        v.other("shape", "");
        v.flag("inside", obstacle.inside, "");
        v.other("motion", "");
        v.withoutEffect([](auto& w) {
            bool flag = true;
            double angle = 0.0;
            w.flag("collide", flag, "");
            w.flag("cohesive", flag, "");
            w.number("friction_angle", angle, Quantity::Angle, Range::between(0.0, 89.0), "");
        });
    });
    ReadShape shape = readShape(*node.find("shape"), joinPath(path, "shape"), settings.cell);
    obstacle.shape = obstacle.inside ? shape.shape.inverted() : std::move(shape.shape);
    obstacle.shapeText = std::move(shape.text);
    if (const Node* motion = node.find("motion")) {
        ReadMotion read = readMotion(*motion, joinPath(path, "motion"));
        obstacle.motion = std::move(read.motion);
        obstacle.motionText = std::move(read.text);
    }
    return obstacle;
}

ObstacleSettings& obstacleNamed(const std::string& name, const Node& node, std::vector<ObstacleSettings>& obstacles)
{
    std::vector<std::string> names;
    for (ObstacleSettings& o : obstacles) {
        if (o.name == name) return o;
        names.push_back(o.name);
    }
    fail(node.place, fmt::format("motion: no obstacle is named {}{}", inQuotes(name), suggestion(name, names)));
}

/// Gives an obstacle the motion that the section `motion` has for it.
void giveMotion(const Node& pieces, const std::string& name, const std::string& path,
                std::vector<ObstacleSettings>& obstacles)
{
    ObstacleSettings& obstacle = obstacleNamed(name, pieces, obstacles);
    if (!obstacle.motionText.empty())
        fail(pieces.place,
             fmt::format("motion: {} has a motion already; put all pieces into one list", inQuotes(name)));
    ReadMotion read = readMotion(pieces, path);
    obstacle.motion = std::move(read.motion);
    obstacle.motionText = std::move(read.text);
}

/// The section `motion`: a map {name: [pieces]}, or a list of pieces that each say which obstacle they move.
void readMotions(const Node& section, std::vector<ObstacleSettings>& obstacles)
{
    if (section.isMap()) {
        for (std::size_t i = 0; i < section.keys.size(); ++i) {
            giveMotion(section.items[i], section.keys[i], joinPath("motion", section.keys[i]), obstacles);
        }
        return;
    }
    if (!section.isList())
        fail(section.place,
             fmt::format("motion: needs a list like [{{obstacle: paddle, t: [0, 1], translate: [0, 5, 0]}}], not {}",
                         section.called()));
    Node byName = Node::map(section.place);
    for (const Node& item : section.items) {
        const Node* name = item.find("obstacle") ? item.find("obstacle") : item.find("group");
        if (!name) fail(item.place, "motion: obstacle is missing; it is the name of what moves, like obstacle: paddle");
        Node piece = item;
        piece.erase("obstacle");
        piece.erase("group");
        Node& pieces = byName.at(readText(*name, "motion.obstacle"), item.place);
        pieces.kind = Node::Kind::List;
        pieces.items.push_back(std::move(piece));
    }
    readMotions(byName, obstacles);
}

}  // namespace

std::vector<SourceSettings> readSources(const Node& root, const Settings& settings)
{
    std::vector<SourceSettings> sources;
    const std::string path = "liquid.sources";
    const Node* list = listAt(root.find("liquid"), "sources", path, "[{shape: …}]");
    if (!list || list->items.empty()) {
        fail(list ? list->place : root.place,
             "liquid.sources: a scene needs at least one source, like - shape: {ball: {center: [0, 5, 0], radius: 1}}");
    }
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        const std::string name = nameIn(list->items[i], i, path);
        sources.push_back(readSource(list->items[i], name, joinPath(path, name), settings));
    }
    requireUnique(sources, path);
    return sources;
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
    if (const Node* section = root.find("motion")) readMotions(*section, obstacles);
    return obstacles;
}

}  // namespace sim
