#pragma once

#include "sim/fabric/block_matrix.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/shells/shell_kernel.h"
#include "sim/settings.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sim {

/// All cloth as thin shells (fabric/shells/README.md, Membrane): triangles in packs as the faces follow each other, so that what they add to is
/// near in memory; packs by tasks, and tasks in colours of which no two touch the same vertex.
class Shells {
 public:
    Shells() = default;
    Shells(const Fabric& fabric, const FabricSettings& settings);

    bool empty() const { return vertices_.empty(); }
    /// Vertices of cloth, ascending; their number in this list is their row in matrices.
    const std::vector<int>& vertices() const { return vertices_; }
    /// A matrix with the pattern of the Hessian, all zero.
    BlockMatrix matrix() const { return BlockMatrix(pattern_); }
    /// Rows of each row's vertex and of those that share a face with it, ascending: a part of the Hessian's pattern.
    const std::vector<std::vector<int>>& neighbors() const { return neighbors_; }

    /// The shells in a step whose start they know, until the next startStep.
    class Step {
     public:
        const Shells& shells() const { return *shells_; }
        /// Gradient of the elastic and viscous energy added to `gradient`, where vertex v has its x at slot[v], y and z kLanes further each
        /// [dyn]; if a matrix is given, its Gauss-Newton Hessian with the tensile part of the membrane's geometric stiffness is added to it.
        /// h: length of the step [s], read by the damping only.
        void forces(std::span<const Vec3> x, double h, std::span<const int> slot, std::span<double> gradient, BlockMatrix* matrix) const
        {
            shells_->forces(x, h, slot, gradient, matrix);
        }

     private:
        friend Shells;
        explicit Step(const Shells& shells) : shells_(&shells) {}
        const Shells* shells_;
    };
    /// Notes strains and angles at x, if anything is damped.
    Step startStep(std::span<const Vec3> x);

    /// Elastic energy [erg]: membrane, bending.
    std::array<double, 2> energies(std::span<const Vec3> x) const;

    /// Hessian blocks of a triangle's six vertices as a pack has them: upper half, row by row.
    static constexpr int kBlocks = kShellVertices * (kShellVertices + 1) / 2;

 private:
    void forces(std::span<const Vec3> x, double h, std::span<const int> slot, std::span<double> gradient, BlockMatrix* matrix) const;

    static constexpr std::size_t kBatchesPerTask = 16;
    /// Number of the block (i, j), i ≤ j, of the upper half.
    static constexpr int blockOf(int i, int j) { return i * kShellVertices - i * (i - 1) / 2 + j - i; }

    using Lanes = std::array<int, kLanes>;
    /// kLanes triangles of one colour.
    struct Batch {
        std::array<Lanes, kShellVertices> vertex;  ///< −1 where there is none
        ShellRest<Pack> rest{};
        Pack damping{};                                  ///< 3η/E of the membrane if it is damped, else 0 [s]
        Pack bendDamping{};                              ///< 3η/E of bending if it is damped, else 0 [s]
        std::array<Lanes, kBlocks> entry;                ///< where a block, or its transpose, stands in the matrix; −1 for no block
        std::array<unsigned, kBlocks> isTransposed;      ///< bit l: of lane l it is the transpose
        std::array<Pack, 3> startGreen{}, startAngle{};  ///< Green's strains and angles at the start of the step
    };
    void fill(const Fabric& fabric, const FabricSettings& settings, std::size_t begin, std::size_t end, const BlockMatrix& pattern,
              Batch& batch) const;
    void colorTasks(std::size_t vertices);
    struct Forces;
    Forces forcesOf(const Batch& batch, std::span<const Vec3> x, double h) const;
    void addGradient(const Batch& batch, const Forces& forces, std::span<const int> slot, std::span<double> gradient) const;
    void addHessian(const Batch& batch, const Forces& forces, BlockMatrix& matrix) const;
    /// Whether the Hessian has a block of vertices i and j of a triangle: hinges tie none that lie across different edges.
    bool areTied(int i, int j) const { return i == j || std::min(i, j) < 3 || settings_.bending != BendingModel::Hinge; }
    void addBlock(const Batch& batch, int n, const std::array<Pack, 9>& block, BlockMatrix& matrix) const;
    MembraneStress<Pack> stressOf(const Batch& batch, const MembraneStrain<Pack>& strain) const;
    /// Φ(θ) − Φ(θ̄), Φ' and the factor of the Gauss-Newton matrix by the chosen measure, for each edge.
    struct BendMeasure {
        std::array<Pack, 3> change, slope, curvature;
    };
    BendMeasure measured(const Batch& batch, const ShellBend<Pack>& bend) const;

    FabricSettings settings_;
    std::vector<int> vertices_, row_;         ///< row of each vertex of the fabric; −1 for those without cloth
    std::vector<std::array<int, 3>> across_;  ///< vertices across each face's edges; −1 on the boundary
    std::vector<std::vector<int>> pattern_, neighbors_;
    std::vector<Batch> batches_;
    std::vector<std::vector<int>> tasks_;  ///< tasks of each colour: kBatchesPerTask batches from number · kBatchesPerTask on
    bool damped_ = false;
};

/// Vertices across the edges of each face, −1 on the boundary. Throws InputError where more than two faces meet at an edge, or two with
/// opposite orientation.
std::vector<std::array<int, 3>> verticesAcross(std::span<const Vec3i> faces);

}  // namespace sim
