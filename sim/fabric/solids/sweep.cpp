#include "sim/fabric/solids/sweep.h"

#include <algorithm>
#include <limits>

namespace sim::solids {

namespace {

constexpr int kMostLooks = 400;              ///< after as many the bound is taken as it is: safe, only less sharp
constexpr double kLeastStride = 1.0 / 1024;  ///< share of the way: nearer than this to what is not safe is arrived [-]

/// Part of an element: its corners as weights of those of the whole.
struct Part {
    std::array<Vec3, 3> corners;
};

Part whole() { return {{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}}; }

Vec3 combine(const Vec3& weights, const std::array<Vec3, 3>& x, int corners)
{
    Vec3 sum = Vec3::Zero();
    for (int c = 0; c < corners; ++c) sum += weights[c] * x[c];
    return sum;
}

Vec3 middleOf(const Part& part, int corners)
{
    Vec3 sum = Vec3::Zero();
    for (int c = 0; c < corners; ++c) sum += part.corners[c];
    return sum / corners;
}

/// Parts that are still to be looked at. Halving goes in depth, so that few wait.
class Waiting {
 public:
    bool empty() const { return count_ == 0; }
    bool full() const { return count_ + 2 > kRoom; }
    void push(const Part& part) { parts_[count_++] = part; }
    Part pop() { return parts_[--count_]; }
    /// Takes in both halves of a part, cut across its longest side.
    /// @param x  where its corners are
    void pushHalves(const Part& part, const std::array<Vec3, 3>& x, int corners)
    {
        int a = 0, b = 1;
        double longest = -1.0;
        for (int i = 0; i < corners; ++i)
            for (int j = i + 1; j < corners; ++j)
                if (const double l = (x[i] - x[j]).squaredNorm(); l > longest) longest = l, a = i, b = j;
        const Vec3 middle = 0.5 * (part.corners[a] + part.corners[b]);
        Part one = part, other = part;
        one.corners[b] = other.corners[a] = middle;
        push(one);
        push(other);
    }

 private:
    static constexpr int kRoom = 64;
    std::array<Part, kRoom> parts_;
    int count_ = 0;
};

/// Is it nowhere nearer than `separation` between two parts of the way?
/// @param weights  out: if not, where it may be
bool staysAway(const Shape& solid, const SweptElement& element, double begin, double end, double separation, Vec3& weights)
{
    const int n = element.corners;
    Waiting waiting;
    waiting.push(whole());
    for (int looks = 0; !waiting.empty(); ++looks) {
        const Part part = waiting.pop();
        std::array<Vec3, Shape::kMostCorners> hull;
        std::array<Vec3, 3> first;
        double way = 0.0, size = 0.0;
        for (int c = 0; c < n; ++c) {
            const Vec3 a = combine(part.corners[c], element.from, n), b = combine(part.corners[c], element.to, n);
            first[c] = hull[c] = a + begin * (b - a);
            hull[n + c] = a + end * (b - a);
            way = std::max(way, (hull[n + c] - hull[c]).squaredNorm());
            size = std::max(size, (first[c] - first[0]).squaredNorm());
        }
        const Shape::Look look = solid.over({hull.data(), static_cast<std::size_t>(2 * n)}, separation);
        if (look.least >= separation) continue;
        // What is larger than its way is cut; of what is smaller a part of the way is tried.
        if (look.middle < separation || way >= size || looks >= kMostLooks || waiting.full()) {
            weights = middleOf(part, n);
            return false;
        }
        waiting.pushHalves(part, first, n);
    }
    return true;
}

/// Where an element is nearest to a flat surface.
void lookAtCorners(const Shape& solid, const std::array<Vec3, 3>& x, int corners, Nearest& nearest)
{
    for (int c = 0; c < corners; ++c)
        if (const double d = solid.distance(x[c]); d < nearest.reached) {
            nearest.reached = d;
            nearest.weights = Vec3::Unit(c);
        }
}

}  // namespace

Vec3 SweptElement::at(const Vec3& weights, double part) const
{
    const Vec3 a = combine(weights, from, corners), b = combine(weights, to, corners);
    return a + part * (b - a);
}

Nearest nearestTo(const Shape& solid, std::span<const Vec3> corners, double enough)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const int n = static_cast<int>(corners.size());
    std::array<Vec3, 3> x;
    std::ranges::copy(corners, x.begin());
    Nearest nearest{kInfinity, kInfinity, Vec3::UnitX()};
    Waiting waiting;
    waiting.push(whole());
    for (int looks = 0; !waiting.empty() && nearest.reached > 0.0; ++looks) {
        const Part part = waiting.pop();
        std::array<Vec3, 3> at;
        for (int c = 0; c < n; ++c) at[c] = combine(part.corners[c], x, n);
        const Shape::Look look = solid.over({at.data(), corners.size()}, enough);
        if (look.middle < nearest.reached) {
            nearest.reached = look.middle;
            nearest.weights = middleOf(part, n);
        }
        const double settled = std::min(enough, (1.0 - kNearestError) * nearest.reached);
        if (look.least >= settled || looks >= kMostLooks || waiting.full()) {
            nearest.least = std::min(nearest.least, look.least);
            continue;
        }
        if (looks == 0) lookAtCorners(solid, x, n, nearest);
        waiting.pushHalves(part, at, n);
    }
    nearest.least = std::min(nearest.least, nearest.reached);
    return nearest;
}

SafePart safePart(const Shape& solid, const SweptElement& element, double separation)
{
    SafePart safe{0.0, Vec3::Zero()};
    for (double stride = 1.0; safe.part < 1.0;) {
        const double end = std::min(1.0, safe.part + stride);
        if (staysAway(solid, element, safe.part, end, separation, safe.weights)) {
            safe.part = end;
            stride *= 2.0;
        } else if (stride > kLeastStride) {
            stride *= 0.5;
        } else {
            return safe;
        }
    }
    return safe;
}

}  // namespace sim::solids
