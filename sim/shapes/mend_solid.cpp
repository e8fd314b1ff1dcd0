#include "sim/shapes/mend_solid.h"

#include "sim/core/check.h"
#include "sim/shapes/triangle_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace sim {

namespace {

constexpr double kWeld = 1.0e-6;  ///< distance of corners that are one, relative to the mesh's size: below what single precision tells apart [-]

using Edge = std::pair<int, int>;  ///< the smaller number first

/// A face at an edge, and whether it runs along it from the smaller number.
struct Side {
    int face;
    bool forward;
};

using Edges = std::map<Edge, std::vector<Side>>;

Edges edgesOf(const std::vector<Vec3i>& faces)
{
    Edges edges;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int c = 0; c < 3; ++c) {
            const int a = faces[f][c], b = faces[f][(c + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}].push_back({static_cast<int>(f), a < b});
        }
    return edges;
}

Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (const Vec3i& f : mesh.triangles)
        for (const int corner : f) box.extend(mesh.vertices[corner]);
    return box;
}

void turnOver(Vec3i& face) { std::swap(face[1], face[2]); }

/// Gives corners at one place the number of the first of them; faces that have no three are left out.
void weld(TriangleMesh& mesh)
{
    const std::vector<int> number = weldedNumbers(mesh.vertices, kWeld * boundsOf(mesh).sizes().maxCoeff());
    for (Vec3i& f : mesh.triangles)
        for (int& corner : f) corner = number[corner];
    std::erase_if(mesh.triangles, [](const Vec3i& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
}

/// Do as many faces run along an edge forward as backward? Then the whole goes around every place a whole number of times.
bool isBalanced(const std::vector<Side>& sides) { return 2 * std::ranges::count_if(sides, &Side::forward) == std::ssize(sides); }

bool isBalanced(const Edges& edges)
{
    return std::ranges::all_of(edges, [](const auto& edge) { return isBalanced(edge.second); });
}

/// Leaves one of the faces with the same corners. Returns the number of those dropped.
std::size_t dropDoubled(std::vector<Vec3i>& faces)
{
    std::set<std::array<int, 3>> seen;
    return std::erase_if(faces, [&](const Vec3i& f) {
        std::array<int, 3> corners = {f[0], f[1], f[2]};
        std::ranges::sort(corners);
        return !seen.insert(corners).second;
    });
}

/// The part to which each face belongs, through edges of two faces.
class Parts {
 public:
    Parts(const std::vector<Vec3i>& faces, const Edges& edges) : parent_(faces.size())
    {
        for (std::size_t f = 0; f < faces.size(); ++f) parent_[f] = static_cast<int>(f);
        for (const auto& [edge, sides] : edges)
            if (sides.size() == 2) parent_[find(sides[0].face)] = find(sides[1].face);
        for (std::size_t f = 0; f < faces.size(); ++f) members_[find(static_cast<int>(f))].push_back(static_cast<int>(f));
    }
    const std::map<int, std::vector<int>>& members() const { return members_; }

 private:
    int find(int f)
    {
        while (parent_[f] != f) f = parent_[f] = parent_[parent_[f]];
        return f;
    }
    std::vector<int> parent_;
    std::map<int, std::vector<int>> members_;
};

/// Turns faces alike from each part's first one on; the smaller half of a part is what is turned. Returns the number of faces turned.
int turnAlike(std::vector<Vec3i>& faces, const Edges& edges)
{
    std::vector<std::vector<std::pair<int, bool>>> neighbours(faces.size());  // and: is it turned against this one?
    for (const auto& [edge, sides] : edges) {
        if (sides.size() != 2) continue;
        const bool isAgainst = sides[0].forward == sides[1].forward;
        neighbours[sides[0].face].emplace_back(sides[1].face, isAgainst);
        neighbours[sides[1].face].emplace_back(sides[0].face, isAgainst);
    }
    int turned = 0;
    std::vector<int> sense(faces.size(), 0);
    for (std::size_t first = 0; first < faces.size(); ++first) {
        if (sense[first] != 0) continue;
        std::vector<int> part = {static_cast<int>(first)};
        sense[first] = 1;
        for (std::size_t n = 0; n < part.size(); ++n)
            for (const auto& [other, isAgainst] : neighbours[part[n]]) {
                const int wanted = isAgainst ? -sense[part[n]] : sense[part[n]];
                if (sense[other] == -wanted) throw InputError("a mesh has one side only, like a Möbius strip; a solid's surface has two");
                if (sense[other] != 0) continue;
                sense[other] = wanted;
                part.push_back(other);
            }
        const auto against = std::ranges::count_if(part, [&](int f) { return sense[f] < 0; });
        const int least = 2 * against <= std::ssize(part) ? -1 : 1;
        for (const int f : part)
            if (sense[f] == least) {
                turnOver(faces[f]);
                ++turned;
            }
    }
    return turned;
}

std::string pointText(const TriangleMesh& mesh, int v)
{
    return fmt::format("{} ({:.6g}, {:.6g}, {:.6g})", v + 1, mesh.vertices[v][0], mesh.vertices[v][1], mesh.vertices[v][2]);
}

[[noreturn]] void failAt(const TriangleMesh& mesh, const Edge& edge, const std::string& what)
{
    throw InputError(fmt::format("{} at the edge from vertex {} to vertex {} cm", what, pointText(mesh, edge.first), pointText(mesh, edge.second)));
}

/// The largest connected outline of holes [cm], by the longest side of its bounds.
double largestOutline(const TriangleMesh& mesh, const Edges& edges)
{
    std::map<int, int> parent;
    const auto find = [&](int v) {
        while (parent.at(v) != v) v = parent.at(v);
        return v;
    };
    for (const auto& [edge, sides] : edges) {
        if (sides.size() != 1) continue;
        parent.try_emplace(edge.first, edge.first);
        parent.try_emplace(edge.second, edge.second);
        parent[find(edge.first)] = find(edge.second);
    }
    std::map<int, Eigen::AlignedBox3d> outlines;
    for (const auto& [v, above] : parent) outlines[find(v)].extend(mesh.vertices[v]);
    double largest = 0.0;
    for (const auto& [v, box] : outlines) largest = std::max(largest, box.sizes().maxCoeff());
    return largest;
}

/// Returns the number of open edges, all of small holes.
std::size_t requireClosed(const TriangleMesh& mesh, const Edges& edges, double largestHole)
{
    std::size_t open = 0;
    const bool isSolid = largestOutline(mesh, edges) <= std::min(largestHole, 0.5 * boundsOf(mesh).sizes().maxCoeff());
    for (const auto& [edge, sides] : edges) {
        if (sides.size() == 1 && !isSolid)
            failAt(mesh, edge, "a mesh is not closed, so it has no inside; close it, or give its faces a thickness (a box is a wall). It is open");
        if (sides.size() != 1 && sides.size() % 2 == 1)
            failAt(mesh, edge, fmt::format("a mesh has {} faces; a solid's surface has two at every edge. They meet", sides.size()));
        open += sides.size() == 1;
    }
    return open;
}

struct Part {
    TriangleTree tree;
    Eigen::AlignedBox3d box;
    double volume;  ///< [cm^3], negative inside out
};

std::vector<Part> partsOf(const TriangleMesh& mesh, const Parts& parts)
{
    std::vector<Part> all;
    TriangleMesh own{mesh.vertices, {}};
    for (const auto& [root, faces] : parts.members()) {
        own.triangles.clear();
        for (const int f : faces) own.triangles.push_back(mesh.triangles[f]);
        TriangleTree tree(own);
        const double volume = tree.empty() ? 0.0 : tree.signedVolume();
        all.push_back({std::move(tree), boundsOf(own), volume});
    }
    return all;
}

/// The largest part around a part, or the part itself.
std::size_t outermost(const std::vector<Part>& parts, std::size_t n, const Vec3& x)
{
    std::size_t around = n;
    for (std::size_t m = 0; m < parts.size(); ++m)
        if (m != n && std::abs(parts[m].volume) > std::abs(parts[around].volume) && parts[m].box.contains(x) &&
            std::abs(parts[m].tree.windingNumber(x)) > 0.5)
            around = m;
    return around;
}

/// Returns the number of parts that were turned.
int turnOutward(TriangleMesh& mesh, const Edges& edges)
{
    const Parts members(mesh.triangles, edges);
    const std::vector<Part> parts = partsOf(mesh, members);
    int turned = 0;
    std::size_t n = 0;
    for (const auto& [root, faces] : members.members()) {
        const std::size_t outer = outermost(parts, n, mesh.vertices[mesh.triangles[faces.front()][0]]);
        ++n;
        if (!(parts[outer].volume < 0.0)) continue;
        for (const int f : faces) turnOver(mesh.triangles[f]);
        ++turned;
    }
    return turned;
}

void add(std::string& text, std::size_t count, const char* what)
{
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
}

}  // namespace

std::vector<int> weldedNumbers(const std::vector<Vec3>& vertices, double distance)
{
    std::vector<int> number(vertices.size());
    std::map<std::tuple<std::int64_t, std::int64_t, std::int64_t>, std::vector<int>> cells;
    const double pitch = std::max(distance, 1.0e-300);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        number[v] = static_cast<int>(v);
        const Vec3 place = (vertices[v] / pitch).array().floor().max(-4.0e18).min(4.0e18);
        const auto cell = [&](int i) { return static_cast<std::int64_t>(place[i]); };
        for (int n = 0; n < 27; ++n) {
            const auto found = cells.find({cell(0) + n % 3 - 1, cell(1) + n / 3 % 3 - 1, cell(2) + n / 9 - 1});
            if (found == cells.end()) continue;
            for (const int other : found->second)
                if (other < number[v] && (vertices[other] - vertices[v]).norm() <= distance) number[v] = other;
        }
        if (number[v] == static_cast<int>(v)) cells[{cell(0), cell(1), cell(2)}].push_back(static_cast<int>(v));
    }
    return number;
}

std::string mendSolid(TriangleMesh& mesh, double largestHole)
{
    weld(mesh);
    std::string done;
    Edges edges = edgesOf(mesh.triangles);
    if (!isBalanced(edges)) {
        add(done, dropDoubled(mesh.triangles), "doubled faces left out");
        edges = edgesOf(mesh.triangles);
        add(done, requireClosed(mesh, edges, largestHole), "edges open at holes smaller than a cell");
        add(done, static_cast<std::size_t>(turnAlike(mesh.triangles, edges)), "faces turned over");
        edges = edgesOf(mesh.triangles);
    }
    add(done, static_cast<std::size_t>(turnOutward(mesh, edges)), "parts turned outward");
    return done;
}

}  // namespace sim
