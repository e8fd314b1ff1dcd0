#include "sim/coupling/yarn_flow.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace sim {

namespace {

constexpr double kCreeping = 0.1;     ///< Reynolds number below which drag is linear [-]
constexpr double kReach = 12.0;       ///< reach of a yarn's view of its neighbours [diameters]
constexpr double kMostCovered = 0.9;  ///< share of a view that can be covered: yarns that touch still let liquid through where they cross [-]

/// Length of the part of a segment that lies in a ball [cm].
double lengthIn(const Vec3& a, const Vec3& b, const Vec3& center, double radius)
{
    const double length = (b - a).norm();
    if (!(length > 0.0)) return 0.0;
    const Vec3 along = (b - a) / length;
    const double nearest = along.dot(center - a), square = radius * radius - (a + nearest * along - center).squaredNorm();
    if (!(square > 0.0)) return 0.0;
    const double half = std::sqrt(square);
    return std::max(std::min(nearest + half, length) - std::max(nearest - half, 0.0), 0.0);
}

/// 2 ρ u C_D/(π d).
double acrossAt(const LiquidSettings& liquid, double diameter, double speed)
{
    const double reynolds = liquid.density * speed * diameter / liquid.viscosity;
    return 2.0 * liquid.density * speed / (kPi * diameter) * (1.0 + 10.0 / std::cbrt(reynolds * reynolds));
}

}  // namespace

DragAround dragAround(const LiquidSettings& liquid, DragLaw law, double diameter, double constriction, double speed)
{
    if (law == DragLaw::Off || !(liquid.viscosity > 0.0)) return {0.0, 0.0};
    const double slowest = kCreeping * liquid.viscosity / (liquid.density * diameter);
    const double creeping = acrossAt(liquid, diameter, slowest);
    return {0.5 * creeping, constriction * (law == DragLaw::Linear ? creeping : acrossAt(liquid, diameter, std::max(speed, slowest)))};
}

std::vector<double> yarnDiameters(const Fabric& fabric)
{
    std::vector<double> diameter(fabric.vertexCount(), 0.0);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const auto [a, b] = fabric.strands.radius[fabric.edges.strand[e]];
        for (int v : fabric.edges.vertices[e]) diameter[v] = std::max(diameter[v], 2.0 * std::sqrt(a * b));
    }
    return diameter;
}

std::vector<double> constrictions(const Fabric& fabric, const std::vector<double>& diameter)
{
    std::vector<double> out(fabric.vertexCount(), 1.0);
    if (fabric.edges.size() == 0) return out;
    const double reach = kReach * std::ranges::max(diameter) + 0.5 * std::ranges::max(fabric.edges.restLength);
    std::map<std::tuple<int, int, int>, std::vector<int>> boxes;  // of edges by their middles, as wide as the reach
    const auto middle = [&](int e) { return Vec3(0.5 * (fabric.rest[fabric.edges.vertices[e][0]] + fabric.rest[fabric.edges.vertices[e][1]])); };
    const auto boxOf = [&](const Vec3& x) { return Vec3i((x / reach).array().floor().cast<int>()); };
    for (int e = 0; e < static_cast<int>(fabric.edges.size()); ++e) {
        const Vec3i box = boxOf(middle(e));
        boxes[{box.x(), box.y(), box.z()}].push_back(e);
    }
    std::vector<int> strandOf(fabric.vertexCount(), -1);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e)
        for (int v : fabric.edges.vertices[e]) strandOf[v] = fabric.edges.strand[e];
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
        if (strandOf[v] < 0) continue;
        const double radius = kReach * diameter[v];
        const Vec3i box = boxOf(fabric.rest[v]);
        double shadow = 0.0;  // of others [cm^2]
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const auto found = boxes.find({box.x() + x, box.y() + y, box.z() + z});
                    if (found == boxes.end()) continue;
                    for (int e : found->second) {
                        if (fabric.edges.strand[e] == strandOf[v]) continue;
                        const Vec2i& ends = fabric.edges.vertices[e];
                        shadow += diameter[ends[0]] * lengthIn(fabric.rest[ends[0]], fabric.rest[ends[1]], fabric.rest[v], radius);
                    }
                }
        const double left = std::max(1.0 - 0.5 * shadow / (kPi * radius * radius), 0.0);
        const double open = 1.0 - std::min(1.0 - left * left, kMostCovered);
        out[v] = (1.0 + std::sqrt(open)) * (1.0 + open) / (4.0 * open * open);
    }
    return out;
}

}  // namespace sim
