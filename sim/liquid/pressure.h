#pragma once

#include "sim/grid/rows.h"
#include "sim/liquid/cells.h"
#include "sim/settings.h"
#include "sim/solvers/poisson.h"

#include <span>

namespace sim {

/// A cell into which a source presses liquid.
struct InflowCell {
    std::size_t source;
    int block, cell;
    double rate;  ///< volume per that of the cell [1/s]
};

/// Buffers of the projection kept between steps; accessed through PressureFaces, PressureComponents and PressureSystem.
struct PressureWorkspace {
    PoissonMatrix matrix;
    BlockArray<double> rhs;             ///< right-hand side of one solve at a time: for a pressure [1/s], for displacements [-]
    BlockArray<double, 3> coefficient;  ///< ω dt / (ρ dx² fill) of each lower face beside a liquid cell [cm s/g]
    double ofFull = 0.0;                ///< coefficient of a face that is full and open, dt / (ρ dx²) [cm s/g]
    PoissonSolver solver;
};

/// Token that the faces of the system are known, and their coefficients, until the next findPressureFaces in the same workspace.
class PressureFaces : public SurfaceCells {
 public:
    const BlockArray<double, 3>& coefficient() const { return work_->coefficient; }
    /// For those that change coefficients before the matrix of them is assembled.
    BlockArray<double, 3>& coefficient() { return work_->coefficient; }
    double ofFull() const { return work_->ofFull; }

 private:
    friend PressureFaces findPressureFaces(const CutGrid& cut, const LiquidSettings& settings, double dt, const SurfaceCells& cells,
                                           PressureWorkspace& work);
    friend class PressureMatrix;
    friend class PressureComponents;
    friend class PressureSystem;
    PressureFaces(const SurfaceCells& cells, PressureWorkspace& work) : SurfaceCells(cells), work_(&work) {}

    PressureWorkspace* work_;
};

/// Token that the system's matrix is assembled.
class PressureMatrix : public PressureFaces {
    friend PressureMatrix assembleMatrix(const PressureFaces& faces, const BlockGrid& grid);
    PressureMatrix(const PressureFaces& faces, const BlockGrid& grid);
};

/// The components of that are known.
class PressureComponents : public PressureMatrix {
 public:
    const ConnectedComponents& components() const { return work_->solver.components(); }

 private:
    friend PressureComponents findComponents(const PressureMatrix& matrix, const BlockGrid& grid);
    PressureComponents(const PressureMatrix& matrix, const BlockGrid& grid);
};

/// The system is ready to be solved.
class PressureSystem : public PressureComponents {
 public:
    /// Where the right-hand side is put before solve(): of a pressure [1/s], of displacements [-].
    BlockArray<double>& rightHandSide() const { return work_->rhs; }
    /// Potential of which the gradient on the faces has that divergence, as by PoissonSolver::solve.
    SolveReport solve(const BlockGrid& grid, SolveTolerance tolerance, int maxIterations, BlockArray<double>& potential) const;

 private:
    friend PressureSystem buildHierarchy(const PressureMatrix& matrix, const PressureComponents& components, const BlockGrid& grid);
    PressureSystem(const PressureComponents& components, const BlockGrid& grid);
};

/// The faces of the pressure system and their coefficients ω dt β / dx², with β = 1 / (ρ fill). Fabric may change them (Mixture::eliminateDrag).
///
/// The fill of a face is the mass that P2G put there relative to a face amid liquid. At the surface it takes the place of the ghost fluid's
/// fraction: both are the share of liquid between two cell middles. Only the mass makes this the projection that is orthogonal
/// in the kinetic energy of the particles, so that it gains no energy and conserves momentum and angular momentum.
PressureFaces findPressureFaces(const CutGrid& cut, const LiquidSettings& settings, double dt, const SurfaceCells& cells, PressureWorkspace& work);

/// The matrix of these faces, with the coefficients that they have now.
PressureMatrix assembleMatrix(const PressureFaces& faces, const BlockGrid& grid);

/// Finds the matrix's components, which other coefficients of the same faces do not change.
PressureComponents findComponents(const PressureMatrix& matrix, const BlockGrid& grid);

/// All that a solve needs.
/// @param matrix  of the same faces as the components, last assembled
PressureSystem buildHierarchy(const PressureMatrix& matrix, const PressureComponents& components, const BlockGrid& grid);

/// The three at once.
PressureSystem preparePressure(const PressureFaces& faces, const BlockGrid& grid);

/// Make the velocities divergence-free: solve div(ω u + (1 − ω) v_S) = 0 for the pressure in all cells inside the liquid, with p = 0 in the
/// others, and subtract dt β grad p (liquid/README.md, Pressure). All faces with liquid that are not closed are valid
/// afterwards.
/// @param inflow    cells whose divergence is to be their rates instead; where a cell is named more than once, the sum
/// @param pressure  in: a guess, out: the solution [dyn/cm²]
SolveReport solvePressure(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                          LiquidGrid& liquid, BlockArray<double>& pressure);

/// u −= dt grad p / (ρ fill) on the faces of the system; they and all others that are open and wet become valid.
void subtractGradient(const CutGrid& cut, const PressureFaces& faces, const BlockArray<double>& pressure, LiquidGrid& liquid);

/// Right-hand side of the system for other velocities on the faces: −div(ω u + (1 − ω) v_S), and the inflow [1/s].
void findRightHandSide(const CutGrid& cut, const LiquidCells& cells, const BlockArray<double, 3>& velocity, std::span<const InflowCell> inflow,
                       BlockArray<double>& rhs);

/// Faces are taken to be at least this full, for the sake of the conditioning.
inline constexpr double kLeastFill = 0.01;

/// For the faces of the pressure system normal to one axis in one block: call f(row, known, change) with the change of velocity [cm/s]
/// that the potential p, in dyn/cm², makes: −dt grad p / (ρ fill), 0 where `known` is false.
template <class F>
void forEachPressureFace(const CutGrid& cut, const PressureFaces& faces, const BlockArray<double>& p, int block, int axis, F&& f)
{
    const RowAccess rows(cut.grid, block);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j) {
            const int row = cellInBlock(0, j, k);
            const Pack coefficient = loadPack(faces.coefficient().block(block, axis) + row);
            const PackMask known = coefficient > 0.0;
            if (maskBits(known) == 0) continue;
            const Pack step = rows.row(p, 0, j, k) - rows.below(p, 0, axis, j, k);
            const Pack change = -cut.grid.dx * coefficient / loadPack(cut.field.open(block, axis) + row) * step;
            f(row, known, select(known, change, broadcast(0.0)));
        }
}

/// pressure += share more, in all blocks.
void addPressure(double share, const BlockArray<double>& more, const BlockGrid& grid, BlockArray<double>& pressure);

/// Largest |div(ω u + (1 − ω) v_S)| over the cells with a pressure [1/s].
double largestDivergence(const CutGrid& cut, const LiquidGrid& liquid);

}  // namespace sim
