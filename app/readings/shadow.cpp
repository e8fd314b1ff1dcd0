#include "app/readings/shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace app {

namespace {

using Point = Eigen::Vector2d;

/// The part of a line on which something lies, and its end.
using Interval = std::pair<double, double>;

/// What a triangle covers of the line at height y: from one of its sides to another.
Interval covered(const std::array<Point, 3>& corners, double y)
{
    Interval part(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (int k = 0; k < 3; ++k) {
        const Point &a = corners[k], &b = corners[(k + 1) % 3];
        if ((a.y() <= y) == (b.y() <= y)) continue;
        const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        part = {std::min(part.first, x), std::max(part.second, x)};
    }
    return part;
}

/// Length of the union; sorts the parts.
double lengthOf(std::vector<Interval>& parts)
{
    std::ranges::sort(parts);
    double length = 0.0, end = -std::numeric_limits<double>::infinity();
    for (const auto& [from, to] : parts) {
        length += std::max(0.0, to - std::max(from, end));
        end = std::max(end, to);
    }
    return length;
}

}  // namespace

/// Along lines a thousandth of the extent apart the lengths are exact.
double shadowArea(std::span<const sim::Vec3> points, std::span<const sim::Vec3i> faces, int axis)
{
    constexpr int kLines = 1000;
    const auto flat = [&](int v) { return Point(points[v][(axis + 1) % 3], points[v][(axis + 2) % 3]); };
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const sim::Vec3i& f : faces)
        for (int k = 0; k < 3; ++k) {
            low = std::min(low, flat(f[k]).y());
            high = std::max(high, flat(f[k]).y());
        }
    if (!(high > low)) return 0.0;
    const double spacing = (high - low) / kLines;
    std::vector<std::vector<Interval>> lines(kLines);
    for (const sim::Vec3i& f : faces) {
        const std::array<Point, 3> corners = {flat(f[0]), flat(f[1]), flat(f[2])};
        const auto [least, most] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
        const int from = std::max(0, static_cast<int>(std::floor((least - low) / spacing)));
        const int to = std::min(kLines - 1, static_cast<int>(std::floor((most - low) / spacing)));
        for (int n = from; n <= to; ++n)
            if (const Interval part = covered(corners, low + (n + 0.5) * spacing); part.second > part.first) lines[n].push_back(part);
    }
    double area = 0.0;
    for (std::vector<Interval>& line : lines) area += spacing * lengthOf(line);
    return area;
}

}  // namespace app
