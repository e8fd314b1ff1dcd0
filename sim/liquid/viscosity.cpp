#include "sim/liquid/viscosity.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/solvers/block_rows.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

double largestOf(const std::vector<double>& values)
{
    return parallelMax(values.size(), [&](std::size_t b) { return values[b]; });
}

double sumOf(const std::vector<double>& values)
{
    double sum = 0.0;
    for (double v : values) sum += v;
    return sum;
}

double largestLane(Pack v)
{
    double largest = 0.0;
    for (int l = 0; l < kLanes; ++l) largest = v[l] > largest || v[l] != v[l] ? v[l] : largest;
    return largest;
}

class ConjugateGradients {
 public:
    ConjugateGradients(const BlockGrid& grid, ViscosityWorkspace& work, LiquidGrid& liquid) : grid_(grid), work_(work), liquid_(liquid)
    {
        for (BlockArray<double, 3>* v : {&work.residual, &work.direction, &work.applied}) v->resize(grid.count());
        for (std::vector<double>* v : {&work.sums, &work.largest, &work.largestRhs}) v->resize(grid.count());
    }

    SolveReport solve(const ObstacleField& obstacles, double tolerance, int maxIterations)
    {
        start(obstacles);
        SolveReport report;
        const double scale = largestOf(work_.largestRhs);
        double residual = largestOf(work_.largest);
        if (scale == 0.0 || residual == 0.0) return report;
        double rho = 0.0;
        while (residual > tolerance * scale && report.iterations < maxIterations) {
            rho = turn(rho);
            const double alpha = rho / applyToDirection();
            if (!std::isfinite(alpha) || alpha <= 0.0) break;
            residual = advance(alpha);
            ++report.iterations;
        }
        report.converged = residual <= tolerance * scale;
        report.residual = residual / scale;
        return report;
    }

 private:
    /// Residual of the velocities as they are, with those of the walls around them.
    void start(const ObstacleField& obstacles)
    {
        const ViscousSystem& system = work_.system;
        forEachBlock(grid_.count(), [&](int b) {
            for (int a = 0; a < kAxes; ++a)
                for (int row = 0; row < kBlockCells; row += kLanes) {
                    const PackMask is = maskOfBits(system.unknown.block(b, a)[row >> 6] >> (row & 63));
                    const PackMask given = maskOfBits(obstacles.closed(b, a)[row >> 6] >> (row & 63));
                    const Pack other = select(given, loadPack(obstacles.wallVelocity(b, a) + row), broadcast(0.0));
                    storePack(work_.direction.block(b, a) + row, select(is, loadPack(liquid_.faces.velocity.block(b, a) + row), other));
                    storePack(work_.residual.block(b, a) + row, broadcast(0.0));
                }
        });
        forEachBlock(grid_.count(), [&](int b) {
            system.multiply(grid_, work_.direction, b, work_.applied);
            Pack largest = broadcast(0.0), largestRhs = broadcast(0.0);
            system.forEachUnknownRow(b, [&](int a, int row) {
                const PackMask is = loadPack(system.diagonal.block(b, a) + row) > 0.0;
                Pack rhs = loadPack(liquid_.faces.sums.block(b, FaceFields::kMass + a) + row) * loadPack(liquid_.faces.velocity.block(b, a) + row);
                if (system.wall.size() > 0) rhs += loadPack(system.wall.block(b, a) + row) * loadPack(obstacles.wallVelocity(b, a) + row);
                rhs = select(is, rhs, broadcast(0.0));
                const Pack r = rhs - loadPack(work_.applied.block(b, a) + row);
                storePack(work_.residual.block(b, a) + row, r);
                largest = maxPack(largest, absPack(r));
                largestRhs = maxPack(largestRhs, absPack(rhs));
            });
            work_.largest[b] = largestLane(largest);
            work_.largestRhs[b] = largestLane(largestRhs);
        });
        forEachBlock(grid_.count(), [&](int b) { std::fill_n(work_.direction.block(b), BlockArray<double, 3>::kStride, 0.0); });
    }

    /// direction = multigrid applied to the residual + beta direction; returns the product of the first with the
    /// residual.
    double turn(double rho)
    {
        work_.multigrid.cycle(work_.residual);
        const BlockArray<double, 3>& z = work_.multigrid.solution();
        const ViscousSystem& system = work_.system;
        forEachBlock(grid_.count(), [&](int b) {
            Pack sum = broadcast(0.0);
            system.forEachUnknownRow(b, [&](int a, int row) { sum += loadPack(work_.residual.block(b, a) + row) * loadPack(z.block(b, a) + row); });
            work_.sums[b] = sumLanes(sum);
        });
        const double next = sumOf(work_.sums), beta = rho > 0.0 ? next / rho : 0.0;
        forEachBlock(grid_.count(), [&](int b) {
            system.forEachUnknownRow(b, [&](int a, int row) {
                double* direction = work_.direction.block(b, a) + row;
                storePack(direction, loadPack(z.block(b, a) + row) + beta * loadPack(direction));
            });
        });
        return next;
    }

    /// applied = A direction; returns their product.
    double applyToDirection()
    {
        const ViscousSystem& system = work_.system;
        forEachBlock(grid_.count(), [&](int b) {
            system.multiply(grid_, work_.direction, b, work_.applied);
            Pack sum = broadcast(0.0);
            system.forEachUnknownRow(
                b, [&](int a, int row) { sum += loadPack(work_.direction.block(b, a) + row) * loadPack(work_.applied.block(b, a) + row); });
            work_.sums[b] = sumLanes(sum);
        });
        return sumOf(work_.sums);
    }

    /// A step of length alpha along the direction; returns the largest residual.
    double advance(double alpha)
    {
        const ViscousSystem& system = work_.system;
        forEachBlock(grid_.count(), [&](int b) {
            Pack largest = broadcast(0.0);
            system.forEachUnknownRow(b, [&](int a, int row) {
                double *u = liquid_.faces.velocity.block(b, a) + row, *residual = work_.residual.block(b, a) + row;
                const Pack r = loadPack(residual) - alpha * loadPack(work_.applied.block(b, a) + row);
                storePack(u, loadPack(u) + alpha * loadPack(work_.direction.block(b, a) + row));
                storePack(residual, r);
                largest = maxPack(largest, absPack(r));
            });
            work_.largest[b] = largestLane(largest);
        });
        return largestOf(work_.largest);
    }

    const BlockGrid& grid_;
    ViscosityWorkspace& work_;
    LiquidGrid& liquid_;
};

}  // namespace

SolveReport solveViscosity(const CutGrid& cut, const LiquidSettings& settings, const SolverSettings& solver, double dt, ViscosityWorkspace& work,
                           LiquidGrid& liquid)
{
    const double part = dt / settings.viscositySubsteps;
    work.system.assemble(cut, liquid, part * settings.viscosity, settings.wallFriction);
    work.multigrid.build(cut.grid, work.system, part * settings.viscosity / (settings.density * cut.grid.dx * cut.grid.dx));
    ConjugateGradients solve(cut.grid, work, liquid);
    SolveReport all = solve.solve(cut.field, solver.viscosityTolerance, solver.maxIterations);
    for (int n = 1; n < settings.viscositySubsteps; ++n) {
        const SolveReport next = solve.solve(cut.field, solver.viscosityTolerance, solver.maxIterations);
        all.iterations += next.iterations;
        all.residual = std::max(all.residual, next.residual);
        all.converged = all.converged && next.converged;
    }
    return all;
}

}  // namespace sim
