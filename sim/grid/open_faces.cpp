#include "sim/grid/open_faces.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Places this near to a surface are on it, whatever the last bit of the distance says.
constexpr double kOnSurface = 1.0e-6;     ///< [cells]
constexpr double kAlmostClosed = 1.0e-3;  ///< open fractions below only hurt the conditioning (grid/README.md, Open fractions)
constexpr double kAlmostOpen = 1.0 - 1.0e-6;
constexpr double kPlane =
    1.0e-3;  ///< a part in whose middles distances differ less from the means of its corners has one plane surface [lengths of its edge]
constexpr int kHalvings = 3;  ///< halvings of a face that has no plane surface: what is missed of a corner is less than its smallest part

}  // namespace

double openFraction(const std::array<double, 4>& distance, const std::array<double, 4>& crossing)
{
    const auto at = [&](int n) { return distance[n & 3]; };
    // Share of the edge from corner n to the next one or the one before that ends at the surface.
    const auto toNext = [&](int n) { return crossing[n & 3]; };
    const auto toLast = [&](int n) { return 1.0 - crossing[(n + 3) & 3]; };
    int inside = 0, outside = 0;
    for (double v : distance) {
        inside += v < 0.0;
        outside += v > 0.0;
    }
    if (outside == 0) return 0.0;
    if (inside == 0) return 1.0;
    if (inside == 1 || inside == 3) {
        int odd = 0;
        while ((at(odd) < 0.0) != (inside == 1)) ++odd;
        const double triangle = 0.5 * toNext(odd) * toLast(odd);
        return inside == 1 ? 1.0 - triangle : triangle;
    }
    for (int n = 0; n < 4; ++n)
        if (at(n) < 0.0 && at(n + 1) < 0.0) return 1.0 - 0.5 * (toLast(n) + toNext(n + 1));
    // Two opposite corners inside: two corners cut off, of the solid or of the open part, as the mean decides.
    const int first = distance[0] < 0.0 ? 0 : 1;
    const bool solidMiddle = distance[0] + distance[1] + distance[2] + distance[3] < 0.0;
    const int corner = solidMiddle ? first + 1 : first;
    const double cut = 0.5 * (toNext(corner) * toLast(corner) + toNext(corner + 2) * toLast(corner + 2));
    return solidMiddle ? cut : 1.0 - cut;
}

OpenFaces::OpenFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, int solid)
    : grid_(grid), obstacles_(obstacles), solid_(solid), corner_(grid.lowerCorner(block))
{
    for (int k = 0; k < kEdge; ++k)
        for (int j = 0; j < kEdge; ++j)
            for (int i = 0; i < kEdge; ++i) distance_[index(i, j, k)] = distanceAt(corner_ + grid.dx * Vec3(i, j, k));
}

double OpenFaces::distanceAt(const Vec3& x) const
{
    const double d = obstacles_.distance(x, solid_);
    return std::abs(d) < kOnSurface * grid_.dx ? 0.0 : d;
}

double OpenFaces::open(int axis, int i, int j, int k) const
{
    constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};
    const double* n = distance_.data() + index(i, j, k);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, u = kStep[a], v = kStep[b];
    const Part face{corner_ + grid_.dx * Vec3(i, j, k), grid_.dx * Vec3::Unit(a), grid_.dx * Vec3::Unit(b), {n[0], n[u], n[u + v], n[v]}};
    const double fraction = openPart(face, kHalvings);
    return fraction < kAlmostClosed ? 0.0 : fraction > kAlmostOpen ? 1.0 : fraction;
}

double OpenFaces::openPart(const Part& part, int depth) const
{
    const auto& d = part.distance;
    const auto [least, most] = std::minmax_element(d.begin(), d.end());
    const double length = part.u.norm();
    // Around each corner nothing changes within its distance; four such discs cover the part.
    if (*least > std::sqrt(0.5) * length) return 1.0;
    if (*most < -std::sqrt(0.5) * length) return 0.0;
    if (depth == 0) return openWithin(part);
    const Vec3 middle = part.low + 0.5 * (part.u + part.v);
    const double atMiddle = distanceAt(middle);
    const std::array<double, 4> beside = {distanceAt(part.low + 0.5 * part.u), distanceAt(part.low + part.u + 0.5 * part.v),
                                          distanceAt(part.low + 0.5 * part.u + part.v), distanceAt(part.low + 0.5 * part.v)};
    double bend = std::abs(atMiddle - 0.25 * (d[0] + d[1] + d[2] + d[3]));
    for (int n = 0; n < 4; ++n) bend = std::max(bend, std::abs(beside[n] - 0.5 * (d[n] + d[(n + 1) % 4])));
    if (bend < kPlane * length) return openWithin(part);
    const Vec3 u = 0.5 * part.u, v = 0.5 * part.v;
    return 0.25 * (openPart({part.low, u, v, {d[0], beside[0], atMiddle, beside[3]}}, depth - 1) +
                   openPart({part.low + u, u, v, {beside[0], d[1], beside[1], atMiddle}}, depth - 1) +
                   openPart({middle, u, v, {atMiddle, beside[1], d[2], beside[2]}}, depth - 1) +
                   openPart({part.low + v, u, v, {beside[3], atMiddle, beside[2], d[3]}}, depth - 1));
}

/// A corner on a surface may be on the seam of two solids, with nothing but solid around it: the part is then seen a little within its rim.
double OpenFaces::openWithin(const Part& part) const
{
    constexpr double kRim = 1.0e-5;  // [cells]
    std::array<double, 4> d = part.distance;
    const double rim = std::count(d.begin(), d.end(), 0.0) > 0 ? kRim * grid_.dx / part.u.norm() : 0.0, near = rim, far = 1.0 - rim;
    const std::array<Vec3, 4> x = {part.low + near * part.u + near * part.v, part.low + far * part.u + near * part.v,
                                   part.low + far * part.u + far * part.v, part.low + near * part.u + far * part.v};
    if (rim > 0.0)
        for (int n = 0; n < 4; ++n) d[n] = distanceAt(x[n]);
    std::array<double, 4> cut{};
    for (int n = 0; n < 4; ++n)
        if (const int next = (n + 1) % 4; (d[n] < 0.0) != (d[next] < 0.0)) cut[n] = crossing(x[n], x[next], d[n], d[next]);
    return openFraction(d, cut);
}

/// Share of the way from one place to another, on two sides of the surface, where it is: as the distances say if it is plane, and else where the
/// secants lead, of which one that keeps its end counts for half there (Dowell and Jarratt 1971, "A modified regula falsi method", Illinois).
double OpenFaces::crossing(const Vec3& from, const Vec3& to, double first, double last) const
{
    constexpr int kSecants = 30;
    constexpr double kFound = 1.0e-9;  // [cells], and of the way
    double low = 0.0, high = 1.0;
    for (int n = 0, kept = 0; n < kSecants && high - low > kFound; ++n) {
        const double share = low + (high - low) * first / (first - last);
        const double d = obstacles_.distance(from + share * (to - from), solid_);
        if (std::abs(d) < (n == 0 ? kOnSurface : kFound) * grid_.dx) return share;
        const bool isFirst = (d < 0.0) == (first < 0.0);
        if (isFirst) low = share, first = d, last *= kept == 1 ? 0.5 : 1.0;
        else high = share, last = d, first *= kept == -1 ? 0.5 : 1.0;
        kept = isFirst ? 1 : -1;
    }
    return 0.5 * (low + high);
}

}  // namespace sim
