#include "sim/fabric/grid/slope_forms.h"

#include "sim/core/parallel.h"
#include "sim/fabric/triple.h"

// Rows of K add up to 0, so that wᵀ K w = −½ Σ_pq K_pq (w_p − w_q)²: each vertex takes half of what it has with each neighbour.

namespace sim {

namespace {

constexpr double kFarthest = 1.1;  ///< neighbours of which slopes tell, in cells

/// Half of what ties two vertices d apart: add(number, part) of their forms, or of their values where d² > `farthest`².
template <class T>
void halve(const Triple<T>& d, const Triple<T>& k, double farthest, auto&& add)
{
    const T square[6] = {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
    const auto isFar = square[0] + square[1] + square[2] > constant<T>(farthest * farthest);
    const T zero = constant<T>(0.0);
    for (int a = 0; a < kAxes; ++a) {
        const T near = isFar ? zero : -0.5 * k[a];
        for (int i = 0; i < 6; ++i) add(6 * a + i, near * square[i]);
        add(18 + a, isFar ? -k[a] : zero);
    }
}

}  // namespace

void SlopeForms::addCloth(std::span<const int> vertices, const BlockMatrix& cloth, std::span<const Vec3> x)
{
    parallelFor(vertices.size(), 128, [&](std::size_t n) {
        const int row = static_cast<int>(n), v = vertices[n];
        const auto addNeighbour = [&](int column, int entry) {
            const double* k = cloth.block(entry);
            halve<double>(toTriple(x[vertices[column]] - x[v]), {k[0], k[4], k[8]}, farthest_, [&](int i, double part) { form_.of[i][v] += part; });
        };
        for (int e = cloth.begin(row) + 1; e < cloth.begin(row + 1); ++e) addNeighbour(cloth.column(e), e);
        for (const BlockMatrix::Mirror& m : cloth.left(row)) addNeighbour(m.column, m.entry);
    });
}

void SlopeForms::findOnStrands(const StrandLayout::Group& group, const StrandLayout& layout, const StrandMatrix& strands,
                               std::span<const Vec3> x)
{
    constexpr int kReach = 2, kUnknowns = 4;         // neighbours that a vertex is tied to, unknowns from one to the next
    std::array<PackTriple, kReach + 1> at{};  // the last positions
    for (int j = 0; j < group.vertices; ++j) {
        const int packed = group.firstVertex + j;
        std::array<Pack, kNumbers>& own = onStrands_[packed];
        own.fill(Pack{});
        at = {PackTriple{}, at[0], at[1]};
        for (int l = 0; l < kLanes; ++l)
            if (layout.vertex[packed][l] >= 0) setLane(at[0], l, x[layout.vertex[packed][l]]);
        for (int back = 1; back <= std::min(j, kReach); ++back) {
            PackTriple k;
            for (int a = 0; a < kAxes; ++a) k[a] = loadPack(strands.lanes(group.firstRow + kUnknowns * j + a, kUnknowns * back));
            halve(at[0] - at[back], k, back * farthest_, [&](int i, Pack part) {
                own[i] += part;
                onStrands_[packed - back][i] += part;
            });
        }
    }
}

void SlopeForms::assemble(const StrandLayout& layout, const StrandMatrix& strands, std::span<const int> vertices,
                          const BlockMatrix& cloth, std::span<const Vec3> x, double cell)
{
    farthest_ = kFarthest * cell;
    form_.resize(x.size());
    for (AlignedArray<double>& component : form_.of) component.fill(0.0);
    addCloth(vertices, cloth, x);
    onStrands_.resize(layout.vertex.size());
    parallelFor(layout.groups.size(), [&](std::size_t g) { findOnStrands(layout.groups[g], layout, strands, x); });
    parallelFor(kNumbers, [&](std::size_t i) {
        for (std::size_t n = 0; n < layout.vertex.size(); ++n)
            for (int l = 0; l < kLanes; ++l)
                if (layout.vertex[n][l] >= 0) form_.of[i][layout.vertex[n][l]] += onStrands_[n][i][l];
    });
}

}  // namespace sim
