#include "sim/fabric/pieces/generators.h"

#include <cmath>
#include <cstdlib>

namespace sim {

namespace {

void addPoint(FabricGeometry& out, const Vec3& x, int column, int row)
{
    out.points.push_back(x);
    out.lattice.emplace_back(column, row);
}

/// Numbers of `count` vertices from `first`, `step` apart.
std::vector<int> numbers(int first, int count, int step = 1)
{
    std::vector<int> all(count);
    for (int i = 0; i < count; ++i) all[i] = first + step * i;
    return all;
}

/// A border yarn: from one corner through the ends of the yarns it holds to the next.
std::vector<int> borderYarn(int corner, const std::vector<int>& ends, int nextCorner)
{
    std::vector<int> yarn = {corner};
    yarn.insert(yarn.end(), ends.begin(), ends.end());
    yarn.push_back(nextCorner);
    return yarn;
}

}  // namespace

std::vector<int> firstInFile(const FabricGeometry& geometry)
{
    if (geometry.ofFile.empty()) return {};
    std::vector<int> first(geometry.points.size(), 0);
    for (int vertex = static_cast<int>(geometry.ofFile.size()) - 1; vertex >= 0; --vertex)
        if (const int point = geometry.ofFile[vertex]; point >= 0) first[point] = vertex;
    return first;
}

FabricGeometry clothGrid(const ClothGrid& grid)
{
    FabricGeometry out;
    const int n = grid.nodes[0], m = grid.nodes[1];
    out.latticeSize = grid.nodes;
    for (int j = 0; j < m; ++j) {
        for (int i = 0; i < n; ++i) addPoint(out, grid.origin + grid.spacing[0] * i * grid.u + grid.spacing[1] * j * grid.v, i, j);
    }
    for (int j = 0; j + 1 < m; ++j) {
        for (int i = 0; i + 1 < n; ++i) {
            const int a = j * n + i;
            out.faces.emplace_back(a, a + 1, a + n);
            out.faces.emplace_back(a + 1, a + n + 1, a + n);
        }
    }
    return out;
}

bool isAbove(Weave weave, int j, int k)
{
    if (weave == Weave::Plain) return (j + k) % 2 == 0;
    // The herringbone's offsets are 2, 1, 0, −1, −1, 0, 1, 2 and so on; |k − 3.5| − 1.5 in whole numbers.
    const int offset = weave == Weave::Herringbone ? (std::abs(2 * (k % 8) - 7) - 3) / 2 : 2 - k % 4;
    return (j + offset + 4) % 4 < 2;
}

FabricGeometry wovenYarns(const WovenYarns& cloth)
{
    FabricGeometry out;
    const int lines = cloth.yarns[0], columns = cloth.yarns[1];  // a yarn along u crosses every column
    out.latticeSize = Vec2i(columns, lines);
    const Vec3 up = cloth.v.cross(cloth.u).normalized();
    const auto place = [&](int column, int row) -> Vec3 { return cloth.origin + cloth.spacing * column * cloth.u + cloth.spacing * row * cloth.v; };
    const auto height = [&](int column, int row) { return isAbove(cloth.weave, column, row) ? cloth.amplitude : -cloth.amplitude; };
    for (int k = 1; k + 1 < lines; ++k) {
        out.strands.push_back(numbers(static_cast<int>(out.points.size()), columns));
        for (int j = 0; j < columns; ++j) addPoint(out, place(j, k) + height(j, k) * up, j, k);
    }
    const int firstAcross = static_cast<int>(out.points.size());
    for (int m = 1; m + 1 < columns; ++m) {
        out.strands.push_back(numbers(static_cast<int>(out.points.size()), lines));
        for (int i = 0; i < lines; ++i) addPoint(out, place(m, i) - height(m, i) * up, m, i);
    }
    if (!cloth.borders) return out;

    const int corner = static_cast<int>(out.points.size());
    for (const int row : {0, lines - 1}) {
        for (const int column : {0, columns - 1}) addPoint(out, place(column, row), column, row);
    }
    const auto endsAlong = [&](int first) { return numbers(first, lines - 2, columns); };
    const auto endsAcross = [&](int first) { return numbers(first, columns - 2, lines); };
    out.strands.push_back(borderYarn(corner, endsAlong(0), corner + 2));
    out.strands.push_back(borderYarn(corner, endsAcross(firstAcross), corner + 1));
    out.strands.push_back(borderYarn(corner + 1, endsAlong(columns - 1), corner + 3));
    out.strands.push_back(borderYarn(corner + 2, endsAcross(firstAcross + lines - 1), corner + 3));
    return out;
}

FabricGeometry strand(std::span<const Vec3> points)
{
    FabricGeometry out;
    const int count = static_cast<int>(points.size());
    out.latticeSize = Vec2i(count, 1);
    for (int i = 0; i < count; ++i) addPoint(out, points[i], i, 0);
    out.strands.push_back(numbers(0, count));
    return out;
}

FabricGeometry strand(const Vec3& from, const Vec3& to, int segments)
{
    std::vector<Vec3> points;
    for (int i = 0; i <= segments; ++i) points.emplace_back(from + (to - from) * (static_cast<double>(i) / segments));
    return strand(points);
}

double pointCount(const ClothGrid& grid) { return static_cast<double>(grid.nodes[0]) * grid.nodes[1]; }

double pointCount(const WovenYarns& cloth)
{
    const double lines = cloth.yarns[0], columns = cloth.yarns[1];
    return (lines - 2.0) * columns + (columns - 2.0) * lines + (cloth.borders ? 4.0 : 0.0);
}

}  // namespace sim
