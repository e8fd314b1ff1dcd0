#include "app/lab/random/random_bodies.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

using sim::Vec3;

namespace {

constexpr double kFastest = 2.0e3;  // of anything at the start [cm/s]

/// Speed at which something crosses so many cells within the run [cm/s].
double randomSpeed(RandomSource& random, const RandomPile& pile)
{
    const double cells = random.acrossScales(0.1, 8.0);
    return std::min(kFastest, cells * pile.cell / pile.duration);
}

Vec3 randomVelocity(RandomSource& random, const RandomPile& pile)
{
    const double speed = randomSpeed(random, pile);
    if (random.chance(0.6)) return {0.0, -speed, 0.0};
    return speed * random.direction();
}

/// One piece of a motion, of a length that cells and the run's duration give.
std::string randomMotion(RandomSource& random, const RandomPile& pile)
{
    const double begin = random.chance(0.5) ? 0.0 : random.between(0.0, 0.5) * pile.duration;
    const std::string span = fmt::format("t: [{:.4g}, {:.4g}]", begin, pile.duration * random.between(0.7, 1.5));
    const std::string axis = listText(random.direction());
    const double length = random.between(0.1, 3.0) * pile.cell;
    switch (random.whole(0, 4)) {
        case 0: return fmt::format("[{{{}, translate: {}}}]", span, listText(length * random.direction()));
        case 1: return fmt::format("[{{{}, translate: [0, {:.4g}, 0], ease: [0, 0]}}]", span, length);
        case 2: return fmt::format("[{{{}, rotate: {{axis: {}, angle: {:.4g}, frame: local}}}}]", span, axis, random.between(-90.0, 90.0));
        case 3:
            return fmt::format("[{{{}, oscillate: {{direction: {}, amplitude: {:.4g}, frequency: {:.4g}}}}}]", span, axis, 0.3 * length,
                               random.between(0.3, 3.0) / pile.duration);
        default:
            return fmt::format("[{{keys: [[0, 0, 0, 0], [{:.4g}, 0, {:.4g}, 0], [{:.4g}, 0, 0, 0]]}}]", 0.5 * pile.duration, 0.5 * length,
                               pile.duration);
    }
}

std::string randomEmission(RandomSource& random, const RandomPile& pile)
{
    if (!random.chance(0.2)) return fmt::format("velocity: {}", listText(randomVelocity(random, pile)));
    const double end = pile.duration * random.between(0.3, 1.2);
    return fmt::format("emit: [{{to: {:.4g}, velocity: [0, {:.4g}, 0]}}]", end, -randomSpeed(random, pile));
}

std::string randomFill(RandomSource& random)
{
    const std::string_view pattern = random.oneOf({"lattice", "reference", "jittered", "poisson"});
    return fmt::format("{{pattern: {}, seed: {}}}", pattern, random.whole(1, 1000));
}

enum class PieceKind { Cloth, Weave, Strand };

std::string randomPins(RandomSource& random, const RandomPile& pile, PieceKind kind)
{
    if (random.chance(0.3)) return "";
    std::string held = "nodes: [0, 1]";
    // A weave without borders has no yarn at the corner itself.
    if (kind != PieceKind::Strand && random.chance(0.5)) held = fmt::format("corners: all, patch: {}", random.whole(2, 3));
    // Cloth may be so askew that no side of it is the left one.
    if (kind == PieceKind::Weave && random.chance(0.5)) held = fmt::format("edge: x-, patch: {}", random.whole(1, 2));
    const std::string motion = random.chance(0.3) ? ", motion: " + randomMotion(random, pile) : "";
    return fmt::format("\n    pin: {{name: hold, {}, twist: {}{}}}", held, random.chance(0.3), motion);
}

/// What is behind the shape of a piece of fabric.
std::string randomPieceEnd(RandomSource& random, const RandomPile& pile, PieceKind kind)
{
    std::string text = randomPins(random, pile, kind);
    if (random.chance(0.3)) text += fmt::format("\n    wetness: {:.3g}", random.between(0.0, 1.0));
    if (random.chance(0.3)) text += "\n    velocity: " + listText(randomVelocity(random, pile));
    return text + "\n";
}

std::string radiusText(RandomSource& random, double radius)
{
    if (random.chance(0.7)) return fmt::format("{:.4g}", radius);
    return fmt::format("[{:.4g}, {:.4g}]", radius, radius * random.between(0.5, 1.0));
}

std::string randomCloth(RandomSource& random, RandomPile& pile)
{
    const double spacing = random.between(0.3, 0.8) * pile.cell;
    const int rows = random.whole(3, 14), columns = random.whole(3, 14);
    const std::string radius = radiusText(random, spacing * random.between(0.03, 0.2));
    const bool stands = random.chance(0.2);
    const double slope = stands ? 0.0 : random.between(-0.1, 0.1), skew = random.between(-0.3, 0.3);
    const double thickness = spacing * (stands ? columns : 1.0 + 0.1 * columns);
    const Vec3 center{random.between(-1.0, 1.0) * pile.cell, pile.add(thickness, random.between(0.3, 1.0) * pile.cell), 0.0};
    const Vec3 across = stands ? Vec3(skew, 1.0, 0.0) : Vec3(skew, slope, 1.0);
    return fmt::format("cloth_grid: {{material: thread, nodes: [{}, {}], spacing: {:.4g}, center: {}, u: [1, 0, 0], v: {}, radius: {}}}", rows,
                       columns, spacing, listText(center), listText(across), radius);
}

std::string randomWeave(RandomSource& random, RandomPile& pile)
{
    const double spacing = random.between(0.4, 0.9) * pile.cell;
    const int rows = random.whole(4, 10), columns = random.whole(4, 10);
    const double radius = spacing * random.between(0.1, 0.3), amplitude = radius * random.between(1.3, 1.6);
    const Vec3 center{0.0, pile.add(4.0 * amplitude, random.between(0.3, 1.0) * pile.cell), random.between(-1.0, 1.0) * pile.cell};
    const std::string_view weave = random.oneOf({"plain", "twill", "herringbone"});
    return fmt::format(
        "woven_yarns: {{material: thread, yarns: [{}, {}], spacing: {:.4g}, amplitude: {:.4g}, radius: {:.4g}, weave: {}, "
        "borders: {}, center: {}}}",
        rows, columns, spacing, amplitude, radius, weave, random.chance(0.5), listText(center));
}

std::string randomStrand(RandomSource& random, RandomPile& pile)
{
    const double half = random.between(1.0, 5.0) * pile.cell;
    const int segments = random.whole(1, 24);
    const std::string radius = radiusText(random, pile.cell * random.between(0.03, 0.3));
    const double height = pile.add(0.6 * pile.cell, random.between(0.4, 1.0) * pile.cell);
    const Vec3 along{half, 0.0, random.between(-1.0, 1.0) * half};
    const Vec3 middle{0.0, height, 0.0};
    return fmt::format("strand: {{material: thread, from: {}, to: {}, segments: {}, radius: {}}}", listText(middle - along), listText(middle + along),
                       segments, radius);
}

}  // namespace

std::string listText(const Vec3& x) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", x[0], x[1], x[2]); }

std::string randomShape(RandomSource& random, const Vec3& center, double radius)
{
    const std::string middle = listText(center);
    const auto ball = [&](const Vec3& at) { return fmt::format("{{ball: {{center: {}, radius: {:.4g}}}}}", listText(at), radius); };
    const auto turned = [&](const std::string& body) {
        const std::string axis = listText(random.direction());
        return fmt::format("{{{}, rotate: {{axis: {}, angle: {:.4g}}}}}", body, axis, random.between(0.0, 180.0));
    };
    const Vec3 half = 0.6 * radius * Vec3{random.between(0.5, 1.0), random.between(0.5, 1.0), random.between(0.5, 1.0)};
    switch (random.whole(0, 6)) {
        case 0: return turned(fmt::format("box: {{center: {}, half: {}}}", middle, listText(half)));
        case 1: return turned(fmt::format("rounded_box: {{center: {}, half: {}, round: {:.4g}}}", middle, listText(half), 0.3 * radius));
        case 2: {
            const Vec3 along = 0.5 * radius * random.direction();
            return fmt::format("{{capsule: {{a: {}, b: {}, radius: {:.4g}}}}}", listText(center - along), listText(center + along), 0.5 * radius);
        }
        case 3: return turned(fmt::format("cylinder: {{center: {}, radius: {:.4g}, half: {:.4g}}}", middle, 0.6 * radius, 0.7 * radius));
        case 4: {
            const std::string_view operation = random.oneOf({"union", "intersect", "subtract"});
            return fmt::format("{{{}: [{}, {}]}}", operation, ball(center), ball(center + 0.6 * radius * random.direction()));
        }
        default: return ball(center);
    }
}

namespace {

/// Turned any way, thinner than a cell or about as thick: liquid runs over its edges.
std::string randomPlate(RandomSource& random, const Vec3& center, double radius, double cell)
{
    const Vec3 half = Vec3{random.between(0.4, 0.8) * radius, 0.5 * cell * random.acrossScales(0.1, 1.0), random.between(0.4, 0.8) * radius};
    if (random.chance(0.3)) return fmt::format("{{box: {{center: {}, half: {}}}}}", listText(center), listText(half));
    const Vec3 axis = random.direction();
    return fmt::format("{{box: {{center: {}, half: {}}}, rotate: {{axis: {}, angle: {:.4g}}}}}", listText(center), listText(half), listText(axis),
                       random.between(-60.0, 60.0));
}

/// Through many cells, or round and round.
std::string fastMotion(RandomSource& random, const RandomPile& pile)
{
    const std::string span = fmt::format("t: [0, {:.4g}]", 2.0 * pile.duration);
    if (random.chance(0.5))
        return fmt::format("[{{{}, rotate: {{axis: {}, angle: {:.4g}, frame: local}}}}]", span, listText(random.direction()),
                           random.between(-1440.0, 1440.0));
    const double length = std::min(kFastest * pile.duration, random.acrossScales(1.0, 8.0) * pile.cell);
    return fmt::format("[{{{}, translate: {}, ease: [0, 0]}}]", span, listText(2.0 * length * random.direction()));
}

}  // namespace

std::string randomObstacles(RandomSource& random, RandomPile& pile)
{
    std::string text;
    const int plates = random.whole(0, 2);
    for (int i = 0; i < plates; ++i) {
        const double radius = random.between(2.0, 4.0) * pile.cell;
        const bool isFast = random.chance(0.4);
        // What turns reaches nothing that lies below, and no floor: between two solids that close there is nowhere to go.
        const double height = pile.add((isFast ? 2.4 : 1.6) * radius, random.between(0.1, 0.8) * pile.cell);
        const Vec3 center = Vec3{random.between(-1.5, 1.5) * pile.cell, height, random.between(-1.5, 1.5) * pile.cell};
        text += fmt::format("  - name: plate_{}\n    shape: {}\n", i, randomPlate(random, center, radius, pile.cell));
        if (isFast) text += fmt::format("    motion: {}\n", fastMotion(random, pile));
    }
    const int count = random.whole(0, 2);
    for (int i = 0; i < count; ++i) {
        const double radius = random.between(0.8, 1.6) * pile.cell;
        const double height = pile.add(2.4 * radius, random.between(0.2, 0.8) * pile.cell);
        const Vec3 center{random.between(-2.0, 2.0) * pile.cell, height, random.between(-2.0, 2.0) * pile.cell};
        text += fmt::format("  - name: body_{}\n    shape: {}\n", i, randomShape(random, center, radius));
        if (random.chance(0.5)) text += fmt::format("    friction_angle: {:.3g}\n", random.between(0.0, 60.0));
        if (random.chance(0.6)) text += fmt::format("    motion: {}\n", randomMotion(random, pile));
    }
    return text;
}

std::string randomFabrics(RandomSource& random, RandomPile& pile)
{
    std::string text;
    const int count = random.whole(1, 3);
    for (int i = 0; i < count; ++i) {
        const auto kind = static_cast<PieceKind>(random.whole(0, 2));
        const std::string shape = kind == PieceKind::Cloth   ? randomCloth(random, pile)
                                  : kind == PieceKind::Weave ? randomWeave(random, pile)
                                                             : randomStrand(random, pile);
        text += fmt::format("  - name: piece_{}\n    {}{}", i, shape, randomPieceEnd(random, pile, kind));
    }
    return text;
}

std::string randomSources(RandomSource& random, RandomPile& pile, bool withPool)
{
    std::string text;
    if (withPool) {
        const double half = random.between(2.0, 4.0) * pile.cell, depth = random.between(1.0, 2.5) * pile.cell;
        const double middle = pile.add(depth, random.between(0.0, 1.0) * pile.cell);
        text += fmt::format("    - name: pool\n      shape: {{box: {{center: [0, {:.4g}, 0], half: [{:.4g}, {:.4g}, {:.4g}]}}}}\n", middle, half,
                            0.5 * depth, half);
    }
    if (withPool && random.chance(0.3)) {
        Vec3 mouth = pile.cell * Vec3{random.between(-1.0, 1.0), random.between(0.4, 1.0), random.between(-1.0, 1.0)};
        const double half = random.between(0.4, 1.0) * pile.cell, end = pile.duration * random.between(0.3, 1.2), speed = randomSpeed(random, pile);
        mouth.y() = std::max(mouth.y(), half);  // a mouth that reached through the floor would give liquid below it
        text += fmt::format(
            "    - name: spring\n      shape: {{box: {{center: {}, half: [{:.4g}, {:.4g}, {:.4g}]}}}}\n      emit: [{{to: {:.4g}, "
            "velocity: {}}}]\n",
            listText(mouth), half, half, half, end, listText(speed * random.direction()));
    }
    const int count = random.whole(withPool ? 0 : 1, 2);
    for (int i = 0; i < count; ++i) {
        const double radius = random.between(1.0, 2.4) * pile.cell;
        // A third of those with no liquid below begin within what lies there: in fabric, or around an obstacle.
        const double above = pile.add((i == 0 ? 3.6 : 2.0) * radius, random.between(0.0, 0.5) * pile.cell);
        const double height = !withPool && i == 0 && random.chance(0.33) ? std::max(1.8 * radius, random.between(0.5, 1.0) * above) : above;
        const Vec3 center{random.between(-2.0, 2.0) * pile.cell, height, random.between(-2.0, 2.0) * pile.cell};
        text += fmt::format("    - name: body_{}\n      shape: {}\n", i, randomShape(random, center, radius));
        text += fmt::format("      {}\n", randomEmission(random, pile));
        text += fmt::format("      fill: {}\n", randomFill(random));
    }
    return text;
}

}  // namespace app
