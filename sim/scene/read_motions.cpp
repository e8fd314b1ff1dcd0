#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_shape.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

namespace sim {

namespace {

/// Something that a motion moves.
struct Movable {
    Motion* motion;
    std::string* text;
};

/// Everything of that name: obstacles, pins, and all pins of fabrics of that name or group.
std::vector<Movable> everythingNamed(const std::string& name, const Node& node, Scene& scene)
{
    std::vector<Movable> found;
    std::vector<std::string> names;
    const auto isNamed = [&](const std::string& candidate) {
        if (!candidate.empty()) names.push_back(candidate);
        return candidate == name;
    };
    for (ObstacleSettings& o : scene.obstacles) {
        if (isNamed(o.name)) found.push_back({&o.motion, &o.motionText});
    }
    bool isPinless = false;
    for (std::size_t i = 0; i < scene.fabrics.size(); ++i) {
        FabricPiece& piece = scene.fabrics[i];
        const bool hasName = piece.name != std::to_string(i);  // else it is only its number
        const bool isNamedItself = hasName && isNamed(piece.name), isInGroup = isNamed(piece.group);
        for (PinGroup& pin : piece.pins) {
            if (isNamed(pin.name) || isNamedItself || isInGroup) found.push_back({&pin.motion, &pin.motionText});
        }
        isPinless = isPinless || ((isNamedItself || isInGroup) && piece.pins.empty());
    }
    if (found.empty() && isPinless)
        fail(node.location, fmt::format("motion: fabric {} has no pin; a motion moves pins, give it one", inQuotes(name)));
    if (found.empty()) {
        fail(node.location, fmt::format("motion: no obstacle, pin or fabric is named {}{}", inQuotes(name), suggestion(name, names)));
    }
    return found;
}

/// Gives what is named so the motion that the section has for it.
void giveMotion(const Node& pieces, const std::string& name, const std::string& path, Scene& scene)
{
    const ReadMotion read = readMotion(pieces, path);
    for (const Movable& movable : everythingNamed(name, pieces, scene)) {
        if (!movable.text->empty())
            fail(pieces.location, fmt::format("motion: {} has a motion already; put all pieces into one list", inQuotes(name)));
        *movable.motion = read.motion;
        *movable.text = read.text;
    }
}

constexpr const char* kTargets[] = {"obstacle", "group", "pin"};

/// A list of pieces that each say what they move, as a map {name: [pieces]}.
Node byName(const Node& list)
{
    Node map = Node::map(list.location);
    for (const Node& item : list.items) {
        const Node* name = nullptr;
        Node piece = item;
        for (const char* key : kTargets) {
            if (item.find(key)) name = item.find(key);
            piece.erase(key);
        }
        if (!name) fail(item.location, "motion: obstacle is missing; it is the name of what moves, like obstacle: paddle");
        Node& pieces = map.at(readText(*name, "motion.obstacle"), item.location);
        pieces.kind = Node::Kind::List;
        pieces.items.push_back(std::move(piece));
    }
    return map;
}

/// A vertex that two pins of a piece hold must not be asked to go two ways.
void requireOneMotionPerVertex(const FabricPiece& piece)
{
    std::vector<const PinGroup*> holder(piece.points.size(), nullptr);
    for (const PinGroup& pin : piece.pins) {
        for (const int v : pin.vertices) {
            if (holder[v] && holder[v]->motionText != pin.motionText)
                fail(pin.where, fmt::format("fabrics.{}.pin: vertex {} is held by two pins that move differently; let them "
                                            "not overlap",
                                            piece.name, piece.called(v)));
            holder[v] = &pin;
        }
    }
}

}  // namespace

void readMotions(const Node& root, Scene& scene)
{
    if (const Node* section = root.find("motion")) {
        if (!section->isMap() && !section->isList())
            fail(section->location,
                 fmt::format("motion: needs a list like [{{obstacle: paddle, t: [0, 1], translate: [0, 5, 0]}}], not {}", section->called()));
        const Node names = section->isMap() ? *section : byName(*section);
        for (std::size_t i = 0; i < names.keys.size(); ++i) giveMotion(names.items[i], names.keys[i], joinPath("motion", names.keys[i]), scene);
    }
    for (const FabricPiece& piece : scene.fabrics) requireOneMotionPerVertex(piece);
}

}  // namespace sim
