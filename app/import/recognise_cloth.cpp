#include "app/import/lattice_fit.h"
#include "app/import/recognise.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace app {

using sim::ClothGrid;
using sim::FabricGeometry;
using sim::Vec2i;
using sim::Vec3;
using sim::Vec3i;

namespace {

/// A way to number the vertices of an n × m lattice: mirrored along either axis, and the axes exchanged.
struct Numbering {
    bool mirrorsColumns = false, mirrorsRows = false, exchanges = false;

    Vec2i place(int number, const Vec2i& listed) const
    {
        int column = number % listed[0], row = number / listed[0];
        if (mirrorsColumns) column = listed[0] - 1 - column;
        if (mirrorsRows) row = listed[1] - 1 - row;
        return exchanges ? Vec2i(row, column) : Vec2i(column, row);
    }
    Vec2i size(const Vec2i& listed) const { return exchanges ? Vec2i(listed[1], listed[0]) : listed; }
};

using Corners = std::array<int, 3>;

/// The corners from the lowest one on, in the order in which they go round.
Corners fromLowest(int a, int b, int c)
{
    if (b < a && b < c) return {b, c, a};
    if (c < a && c < b) return {c, a, b};
    return {a, b, c};
}

std::vector<Corners> sorted(std::span<const Vec3i> faces, std::span<const int> numberOf)
{
    std::vector<Corners> all;
    for (const Vec3i& f : faces)
        all.push_back(numberOf.empty() ? fromLowest(f[0], f[1], f[2]) : fromLowest(numberOf[f[0]], numberOf[f[1]], numberOf[f[2]]));
    std::ranges::sort(all);
    return all;
}

/// Columns that the lattice may have: neighbours of a first face differ by 1, and by one row or one row and 1.
std::set<int> possibleColumns(const ListedFabric& fabric)
{
    const auto [low, high] = std::minmax({fabric.faces[0][0], fabric.faces[0][1], fabric.faces[0][2]});
    std::set<int> all;
    const int count = static_cast<int>(fabric.points.size());
    for (const int columns : {high - low, high - low - 1})
        if (columns >= 2 && count % columns == 0 && count / columns >= 2) all.insert(columns);
    return all;
}

/// The generator with its numbers rounded to what a file would say.
std::optional<ClothGrid> gridThrough(const ListedFabric& fabric, std::span<const Vec2i> places, const Vec2i& nodes)
{
    const LatticeFit fit = fitLattice(fabric.points, places, {});
    ClothGrid grid;
    grid.nodes = nodes;
    grid.spacing = {shortest(fit.u.norm()), shortest(fit.v.norm())};
    if (!(grid.spacing[0] > 0.0 && grid.spacing[1] > 0.0)) return std::nullopt;
    grid.origin = shortest(fit.origin);
    grid.u = shortest(Vec3(fit.u.normalized()));
    grid.v = shortest(Vec3(fit.v.normalized()));
    return grid;
}

GeneratedFabric generated(const ClothGrid& grid)
{
    GeneratedFabric out;
    out.kind = "cloth_grid";
    const bool isSquare = grid.spacing[0] == grid.spacing[1];
    out.fields = {{"nodes", fmt::format("[{}, {}]", grid.nodes[0], grid.nodes[1])},
                  {"spacing", isSquare ? sim::formatPlain(grid.spacing[0])
                                       : fmt::format("[{}, {}]", sim::formatPlain(grid.spacing[0]), sim::formatPlain(grid.spacing[1]))},
                  {"origin", yamlList(grid.origin)},
                  {"u", yamlList(grid.u)},
                  {"v", yamlList(grid.v)}};
    out.summary = fmt::format("{} by {} vertices, {} cm apart", grid.nodes[0], grid.nodes[1], out.fields[1].second);
    out.geometry = sim::clothGrid(grid);
    return out;
}

std::optional<GeneratedFabric> recogniseAs(const ListedFabric& fabric, const Vec2i& listed, const Numbering& numbering)
{
    const Vec2i nodes = numbering.size(listed);
    const int count = static_cast<int>(fabric.points.size());
    std::vector<Vec2i> places;
    std::vector<int> numberOf;
    for (int i = 0; i < count; ++i) {
        places.push_back(numbering.place(i, listed));
        numberOf.push_back(places.back()[1] * nodes[0] + places.back()[0]);
    }
    if (sorted(fabric.faces, numberOf) != sorted(sim::clothGrid({.nodes = nodes}).faces, {})) return std::nullopt;
    const std::optional<ClothGrid> grid = gridThrough(fabric, places, nodes);
    if (!grid) return std::nullopt;
    GeneratedFabric out = generated(*grid);
    out.pointOf.resize(fabric.points.size());
    std::vector<Vec3> listedPoints(fabric.points.size());
    for (int i = 0; i < count; ++i) {
        out.pointOf[numberOf[i]] = i;
        listedPoints[numberOf[i]] = fabric.points[i];
    }
    out.deviation = largestDistance(listedPoints, out.geometry.points);
    if (!(out.deviation < kSameShape)) return std::nullopt;
    return out;
}

}  // namespace

std::string yamlList(const Vec3& x) { return fmt::format("[{}, {}, {}]", sim::formatPlain(x[0]), sim::formatPlain(x[1]), sim::formatPlain(x[2])); }

std::optional<GeneratedFabric> recogniseClothGrid(const ListedFabric& fabric)
{
    if (fabric.faces.empty() || !fabric.strands.empty()) return std::nullopt;
    const int count = static_cast<int>(fabric.points.size());
    for (const int columns : possibleColumns(fabric)) {
        if (fabric.faces.size() != 2 * static_cast<std::size_t>(columns - 1) * (count / columns - 1)) continue;
        for (int way = 0; way < 8; ++way) {
            const Numbering numbering{(way & 1) != 0, (way & 2) != 0, (way & 4) != 0};
            if (auto out = recogniseAs(fabric, {columns, count / columns}, numbering)) return out;
        }
    }
    return std::nullopt;
}

}  // namespace app
