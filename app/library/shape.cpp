#include "drench/shape.h"

#include "app/library/scene_parts.h"
#include "sim/scene/units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace drench {

namespace {

using sim::formatPlain;

Shape combined(const char* operation, const std::vector<Shape>& shapes)
{
    std::vector<std::string> texts;
    for (const Shape& shape : shapes) texts.push_back(shape.text);
    return {fmt::format("{{{}: [{}]}}", operation, fmt::join(texts, ", "))};
}

}  // namespace

Shape ball(const Vec3& center, double radius) { return {fmt::format("{{ball: {{center: {}, radius: {}}}}}", flow(center), formatPlain(radius))}; }

Shape box(const Vec3& min, const Vec3& max) { return {fmt::format("{{box: {{min: {}, max: {}}}}}", flow(min), flow(max))}; }

Shape capsule(const Vec3& a, const Vec3& b, double radius)
{
    return {fmt::format("{{capsule: {{a: {}, b: {}, radius: {}}}}}", flow(a), flow(b), formatPlain(radius))};
}

Shape cylinder(const Vec3& center, const Vec3& axis, double radius, double half)
{
    return {fmt::format("{{cylinder: {{center: {}, axis: {}, radius: {}, half: {}}}}}", flow(center), flow(axis), formatPlain(radius),
                        formatPlain(half))};
}

Shape mesh(const std::string& file, double scale)
{
    std::string quoted;
    for (const char c : file) quoted += c == '\'' ? "''" : std::string(1, c);
    return {fmt::format("{{mesh: {{file: '{}', scale: {}}}}}", quoted, formatPlain(scale))};
}

Shape unite(const std::vector<Shape>& shapes) { return combined("union", shapes); }
Shape intersect(const std::vector<Shape>& shapes) { return combined("intersect", shapes); }
Shape subtract(const std::vector<Shape>& shapes) { return combined("subtract", shapes); }

}  // namespace drench
