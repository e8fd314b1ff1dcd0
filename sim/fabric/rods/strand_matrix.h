#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/simd.h"
#include "sim/fabric/fabric.h"

#include <array>
#include <span>
#include <vector>

namespace sim {

/// Where strands stand in packs. Strands of similar length form groups of kLanes; the unknowns of a strand of n vertices are
/// x0 y0 z0 θ0 x1 … z(n−1), 4n − 1 rows of one lane. Unused lanes have vertex and edge −1.
struct StrandLayout {
    using Lanes = std::array<int, kLanes>;
    struct Group {
        int vertices = 0;     ///< number of vertices of its longest strand
        int firstVertex = 0;  ///< first vertex of the group in `vertex`
        int firstEdge = 0;    ///< first edge of the group in `edge`
        int firstRow = 0;     ///< first row among all groups'
        int edges() const { return vertices - 1; }
        int rows() const { return 4 * vertices - 1; }
    };
    std::vector<Group> groups;
    std::vector<Lanes> strand;  ///< strands of each group
    std::vector<Lanes> vertex;  ///< vertices of the fabric in each packed vertex
    std::vector<Lanes> edge;    ///< yarn edges of the fabric in each packed edge
    int rows = 0;               ///< number of rows of all groups

    StrandLayout() = default;
    explicit StrandLayout(const Fabric::Strands& strands);
};

/// Symmetric band matrices of all strands, 10 off-diagonals, and their factors L D Lᵀ. Positive definite as soon as masses are on the
/// diagonal; no pivoting.
class StrandMatrix {
 public:
    static constexpr int kBand = 11;  ///< entries stored per row: column r − k at k
    /// Columns before the diagonal in which rows of x, y, z and θ have entries: those of two vertices and their angles before x, y, z,
    /// of one before θ. Factors have none elsewhere either.
    static constexpr std::array<int, 4> kReach = {8, 9, 10, 7};

    void resize(const StrandLayout& layout);
    void clear() { band_.fill(0.0); }
    /// Entry (row, row − k) of one lane; `row` counts through all groups.
    double& at(int row, int k, int lane) { return band_[(static_cast<std::size_t>(row) * kBand + k) * kLanes + lane]; }
    double at(int row, int k, int lane) const { return band_[(static_cast<std::size_t>(row) * kBand + k) * kLanes + lane]; }
    /// Entry (row, row − k) of all lanes.
    const double* lanes(int row, int k) const { return band_.data() + (static_cast<std::size_t>(row) * kBand + k) * kLanes; }
    /// The rows of a group, kBand packs each.
    std::span<Pack> rows(const StrandLayout::Group& group)
    {
        return {packs(band_, static_cast<std::size_t>(group.firstRow) * kBand), static_cast<std::size_t>(group.rows()) * kBand};
    }

    /// A = L D Lᵀ of every strand; false if some are not positive definite: `definite` tells which.
    bool factor(const StrandLayout& layout);
    /// For each group, after factor(): 1 in lanes of strands that are positive definite, else 0.
    const std::vector<Pack>& definite() const { return definite_; }
    /// z = (L D Lᵀ)⁻¹ b for one group, of which b and z are the rows.
    void solve(const StrandLayout::Group& group, const Pack* b, Pack* z) const;
    /// y = A x for one group, of which x and y are the rows.
    void multiply(const StrandLayout::Group& group, const Pack* x, Pack* y) const;

 private:
    static Pack* packs(AlignedArray<double>& a, std::size_t n) { return reinterpret_cast<Pack*>(a.data()) + n; }
    static const Pack* packs(const AlignedArray<double>& a, std::size_t n) { return reinterpret_cast<const Pack*>(a.data()) + n; }

    AlignedArray<double> band_;
    /// The row of L of one of a group's rows: column r − k at k − 1; `group` points at the group's first vertex.
    template <class P>
    static P* lowerRow(P* group, int r)
    {
        constexpr std::array<int, 4> kBegin = {0, kReach[0], kReach[0] + kReach[1], kReach[0] + kReach[1] + kReach[2]};
        return group + (r / 4) * kLowerPerVertex + kBegin[r % 4];
    }
    static constexpr int kLowerPerVertex = kReach[0] + kReach[1] + kReach[2] + kReach[3];

    AlignedArray<double> lower_;    ///< L without its unit diagonal: of each packed vertex its rows, one after the other
    AlignedArray<double> inverse_;  ///< D⁻¹
    std::vector<Pack> definite_;
};

}  // namespace sim
