#include "app/lab/random/random_bodies.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

using sim::Vec3;

namespace {

constexpr double kFastest = 2.0e3;  // of anything at the start [cm/s]

/// At which something crosses so many cells within the run [cm/s].
double randomSpeed(Dice& dice, const RandomPile& pile)
{
    const double cells = dice.acrossScales(0.1, 8.0);
    return std::min(kFastest, cells * pile.cell / pile.duration);
}

Vec3 randomVelocity(Dice& dice, const RandomPile& pile)
{
    const double speed = randomSpeed(dice, pile);
    if (dice.chance(0.6)) return {0.0, -speed, 0.0};
    return speed * dice.direction();
}

/// One piece of a motion, of a length that cells and the run's duration give.
std::string randomMotion(Dice& dice, const RandomPile& pile)
{
    const double begin = dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.5) * pile.duration;
    const std::string span = fmt::format("t: [{:.4g}, {:.4g}]", begin, pile.duration * dice.between(0.7, 1.5));
    const std::string axis = listText(dice.direction());
    const double length = dice.between(0.1, 3.0) * pile.cell;
    switch (dice.whole(0, 4)) {
        case 0: return fmt::format("[{{{}, translate: {}}}]", span, listText(length * dice.direction()));
        case 1: return fmt::format("[{{{}, translate: [0, {:.4g}, 0], ease: [0, 0]}}]", span, length);
        case 2: return fmt::format("[{{{}, rotate: {{axis: {}, angle: {:.4g}, frame: local}}}}]", span, axis, dice.between(-90.0, 90.0));
        case 3:
            return fmt::format("[{{{}, oscillate: {{direction: {}, amplitude: {:.4g}, frequency: {:.4g}}}}}]", span, axis, 0.3 * length,
                               dice.between(0.3, 3.0) / pile.duration);
        default:
            return fmt::format("[{{keys: [[0, 0, 0, 0], [{:.4g}, 0, {:.4g}, 0], [{:.4g}, 0, 0, 0]]}}]", 0.5 * pile.duration, 0.5 * length,
                               pile.duration);
    }
}

std::string randomEmission(Dice& dice, const RandomPile& pile)
{
    if (!dice.chance(0.2)) return fmt::format("velocity: {}", listText(randomVelocity(dice, pile)));
    const double end = pile.duration * dice.between(0.3, 1.2);
    return fmt::format("emit: [{{to: {:.4g}, velocity: [0, {:.4g}, 0]}}]", end, -randomSpeed(dice, pile));
}

std::string randomFill(Dice& dice)
{
    const std::string_view pattern = dice.oneOf({"lattice", "reference", "jittered", "poisson"});
    return fmt::format("{{pattern: {}, seed: {}}}", pattern, dice.whole(1, 1000));
}

enum class PieceKind { Cloth, Weave, Strand };

std::string randomPins(Dice& dice, const RandomPile& pile, PieceKind kind)
{
    if (dice.chance(0.3)) return "";
    std::string held = "nodes: [0, 1]";
    // A weave without borders has no yarn at the corner itself.
    if (kind != PieceKind::Strand && dice.chance(0.5)) held = fmt::format("corners: all, patch: {}", dice.whole(2, 3));
    // Cloth may be so askew that no side of it is the left one.
    if (kind == PieceKind::Weave && dice.chance(0.5)) held = fmt::format("edge: x-, patch: {}", dice.whole(1, 2));
    const std::string motion = dice.chance(0.3) ? ", motion: " + randomMotion(dice, pile) : "";
    return fmt::format("\n    pin: {{name: hold, {}, twist: {}{}}}", held, dice.chance(0.3), motion);
}

/// What is behind the shape of a piece of fabric.
std::string randomPieceEnd(Dice& dice, const RandomPile& pile, PieceKind kind)
{
    std::string text = randomPins(dice, pile, kind);
    if (dice.chance(0.3)) text += fmt::format("\n    wetness: {:.3g}", dice.between(0.0, 1.0));
    if (dice.chance(0.3)) text += "\n    velocity: " + listText(randomVelocity(dice, pile));
    return text + "\n";
}

std::string radiusText(Dice& dice, double radius)
{
    if (dice.chance(0.7)) return fmt::format("{:.4g}", radius);
    return fmt::format("[{:.4g}, {:.4g}]", radius, radius * dice.between(0.5, 1.0));
}

std::string randomCloth(Dice& dice, RandomPile& pile)
{
    const double spacing = dice.between(0.3, 0.8) * pile.cell;
    const int rows = dice.whole(3, 14), columns = dice.whole(3, 14);
    const std::string radius = radiusText(dice, spacing * dice.between(0.03, 0.2));
    const bool stands = dice.chance(0.2);
    const double slope = stands ? 0.0 : dice.between(-0.1, 0.1), skew = dice.between(-0.3, 0.3);
    const double thickness = spacing * (stands ? columns : 1.0 + 0.1 * columns);
    const Vec3 center{dice.between(-1.0, 1.0) * pile.cell, pile.add(thickness, dice.between(0.3, 1.0) * pile.cell), 0.0};
    const Vec3 across = stands ? Vec3(skew, 1.0, 0.0) : Vec3(skew, slope, 1.0);
    return fmt::format("cloth_grid: {{material: thread, nodes: [{}, {}], spacing: {:.4g}, center: {}, u: [1, 0, 0], v: {}, radius: {}}}", rows,
                       columns, spacing, listText(center), listText(across), radius);
}

std::string randomWeave(Dice& dice, RandomPile& pile)
{
    const double spacing = dice.between(0.4, 0.9) * pile.cell;
    const int rows = dice.whole(4, 10), columns = dice.whole(4, 10);
    const double radius = spacing * dice.between(0.1, 0.3), amplitude = radius * dice.between(1.3, 1.6);
    const Vec3 center{0.0, pile.add(4.0 * amplitude, dice.between(0.3, 1.0) * pile.cell), dice.between(-1.0, 1.0) * pile.cell};
    const std::string_view weave = dice.oneOf({"plain", "twill", "herringbone"});
    return fmt::format(
        "woven_yarns: {{material: thread, yarns: [{}, {}], spacing: {:.4g}, amplitude: {:.4g}, radius: {:.4g}, weave: {}, "
        "borders: {}, center: {}}}",
        rows, columns, spacing, amplitude, radius, weave, dice.chance(0.5), listText(center));
}

std::string randomStrand(Dice& dice, RandomPile& pile)
{
    const double half = dice.between(1.0, 5.0) * pile.cell;
    const int segments = dice.whole(1, 24);
    const std::string radius = radiusText(dice, pile.cell * dice.between(0.03, 0.3));
    const double height = pile.add(0.6 * pile.cell, dice.between(0.4, 1.0) * pile.cell);
    const Vec3 along{half, 0.0, dice.between(-1.0, 1.0) * half};
    const Vec3 middle{0.0, height, 0.0};
    return fmt::format("strand: {{material: thread, from: {}, to: {}, segments: {}, radius: {}}}", listText(middle - along), listText(middle + along),
                       segments, radius);
}

}  // namespace

std::string listText(const Vec3& x) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", x[0], x[1], x[2]); }

std::string randomShape(Dice& dice, const Vec3& center, double radius)
{
    const std::string middle = listText(center);
    const auto ball = [&](const Vec3& at) { return fmt::format("{{ball: {{center: {}, radius: {:.4g}}}}}", listText(at), radius); };
    const auto turned = [&](const std::string& body) {
        const std::string axis = listText(dice.direction());
        return fmt::format("{{{}, rotate: {{axis: {}, angle: {:.4g}}}}}", body, axis, dice.between(0.0, 180.0));
    };
    const Vec3 half = 0.6 * radius * Vec3{dice.between(0.5, 1.0), dice.between(0.5, 1.0), dice.between(0.5, 1.0)};
    switch (dice.whole(0, 6)) {
        case 0: return turned(fmt::format("box: {{center: {}, half: {}}}", middle, listText(half)));
        case 1: return turned(fmt::format("rounded_box: {{center: {}, half: {}, round: {:.4g}}}", middle, listText(half), 0.3 * radius));
        case 2: {
            const Vec3 along = 0.5 * radius * dice.direction();
            return fmt::format("{{capsule: {{a: {}, b: {}, radius: {:.4g}}}}}", listText(center - along), listText(center + along), 0.5 * radius);
        }
        case 3: return turned(fmt::format("cylinder: {{center: {}, radius: {:.4g}, half: {:.4g}}}", middle, 0.6 * radius, 0.7 * radius));
        case 4: {
            const std::string_view operation = dice.oneOf({"union", "intersect", "subtract"});
            return fmt::format("{{{}: [{}, {}]}}", operation, ball(center), ball(center + 0.6 * radius * dice.direction()));
        }
        default: return ball(center);
    }
}

namespace {

/// Turned any way, thinner than a cell or about as thick: liquid runs over its edges.
std::string randomPlate(Dice& dice, const Vec3& center, double radius, double cell)
{
    const Vec3 half = Vec3{dice.between(0.4, 0.8) * radius, 0.5 * cell * dice.acrossScales(0.1, 1.0), dice.between(0.4, 0.8) * radius};
    if (dice.chance(0.3)) return fmt::format("{{box: {{center: {}, half: {}}}}}", listText(center), listText(half));
    const Vec3 axis = dice.direction();
    return fmt::format("{{box: {{center: {}, half: {}}}, rotate: {{axis: {}, angle: {:.4g}}}}}", listText(center), listText(half), listText(axis),
                       dice.between(-60.0, 60.0));
}

/// Through many cells, or round and round.
std::string fastMotion(Dice& dice, const RandomPile& pile)
{
    const std::string span = fmt::format("t: [0, {:.4g}]", 2.0 * pile.duration);
    if (dice.chance(0.5))
        return fmt::format("[{{{}, rotate: {{axis: {}, angle: {:.4g}, frame: local}}}}]", span, listText(dice.direction()),
                           dice.between(-1440.0, 1440.0));
    const double length = std::min(kFastest * pile.duration, dice.acrossScales(1.0, 8.0) * pile.cell);
    return fmt::format("[{{{}, translate: {}, ease: [0, 0]}}]", span, listText(2.0 * length * dice.direction()));
}

}  // namespace

std::string randomObstacles(Dice& dice, RandomPile& pile)
{
    std::string text;
    const int plates = dice.whole(0, 2);
    for (int i = 0; i < plates; ++i) {
        const double radius = dice.between(2.0, 4.0) * pile.cell;
        const bool isFast = dice.chance(0.4);
        // What turns reaches nothing that lies below, and no floor: between two solids that close there is nowhere to go.
        const double height = pile.add((isFast ? 2.4 : 1.6) * radius, dice.between(0.1, 0.8) * pile.cell);
        const Vec3 center = Vec3{dice.between(-1.5, 1.5) * pile.cell, height, dice.between(-1.5, 1.5) * pile.cell};
        text += fmt::format("  - name: plate_{}\n    shape: {}\n", i, randomPlate(dice, center, radius, pile.cell));
        if (isFast) text += fmt::format("    motion: {}\n", fastMotion(dice, pile));
    }
    const int count = dice.whole(0, 2);
    for (int i = 0; i < count; ++i) {
        const double radius = dice.between(0.8, 1.6) * pile.cell;
        const double height = pile.add(2.4 * radius, dice.between(0.2, 0.8) * pile.cell);
        const Vec3 center{dice.between(-2.0, 2.0) * pile.cell, height, dice.between(-2.0, 2.0) * pile.cell};
        text += fmt::format("  - name: body_{}\n    shape: {}\n", i, randomShape(dice, center, radius));
        if (dice.chance(0.5)) text += fmt::format("    friction_angle: {:.3g}\n", dice.between(0.0, 60.0));
        if (dice.chance(0.6)) text += fmt::format("    motion: {}\n", randomMotion(dice, pile));
    }
    return text;
}

std::string randomFabrics(Dice& dice, RandomPile& pile)
{
    std::string text;
    const int count = dice.whole(1, 3);
    for (int i = 0; i < count; ++i) {
        const auto kind = static_cast<PieceKind>(dice.whole(0, 2));
        const std::string shape = kind == PieceKind::Cloth   ? randomCloth(dice, pile)
                                  : kind == PieceKind::Weave ? randomWeave(dice, pile)
                                                             : randomStrand(dice, pile);
        text += fmt::format("  - name: piece_{}\n    {}{}", i, shape, randomPieceEnd(dice, pile, kind));
    }
    return text;
}

std::string randomSources(Dice& dice, RandomPile& pile, bool withPool)
{
    std::string text;
    if (withPool) {
        const double half = dice.between(2.0, 4.0) * pile.cell, depth = dice.between(1.0, 2.5) * pile.cell;
        const double middle = pile.add(depth, dice.between(0.0, 1.0) * pile.cell);
        text += fmt::format("    - name: pool\n      shape: {{box: {{center: [0, {:.4g}, 0], half: [{:.4g}, {:.4g}, {:.4g}]}}}}\n", middle, half,
                            0.5 * depth, half);
    }
    if (withPool && dice.chance(0.3)) {
        Vec3 mouth = pile.cell * Vec3{dice.between(-1.0, 1.0), dice.between(0.4, 1.0), dice.between(-1.0, 1.0)};
        const double half = dice.between(0.4, 1.0) * pile.cell, end = pile.duration * dice.between(0.3, 1.2), speed = randomSpeed(dice, pile);
        mouth.y() = std::max(mouth.y(), half);  // a mouth that reached through the floor would give liquid below it
        text += fmt::format(
            "    - name: spring\n      shape: {{box: {{center: {}, half: [{:.4g}, {:.4g}, {:.4g}]}}}}\n      emit: [{{to: {:.4g}, "
            "velocity: {}}}]\n",
            listText(mouth), half, half, half, end, listText(speed * dice.direction()));
    }
    const int count = dice.whole(withPool ? 0 : 1, 2);
    for (int i = 0; i < count; ++i) {
        const double radius = dice.between(1.0, 2.4) * pile.cell;
        // A third of those with no liquid below begin within what lies there: in fabric, or around an obstacle.
        const double above = pile.add((i == 0 ? 3.6 : 2.0) * radius, dice.between(0.0, 0.5) * pile.cell);
        const double height = !withPool && i == 0 && dice.chance(0.33) ? std::max(1.8 * radius, dice.between(0.5, 1.0) * above) : above;
        const Vec3 center{dice.between(-2.0, 2.0) * pile.cell, height, dice.between(-2.0, 2.0) * pile.cell};
        text += fmt::format("    - name: body_{}\n      shape: {}\n", i, randomShape(dice, center, radius));
        text += fmt::format("      {}\n", randomEmission(dice, pile));
        text += fmt::format("      fill: {}\n", randomFill(dice));
    }
    return text;
}

}  // namespace app
