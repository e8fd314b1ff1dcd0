#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"

#include <algorithm>

// One linear solve goes by the forces where a step begins. Where it moves fabric about as far as its edges are long, because liquid strikes or
// draws it, other forces act where it gets to, and energy would come from nothing: then these are solved for, by Newton's method.

namespace sim {

namespace {

/// Elastic energy from nothing that a step may leave, relative to that of the motion: more asks for another iteration [-].
constexpr double kNoGain = 1.0e-3;
constexpr int kMostNewton = 8;   ///< iterations
constexpr int kMostRepeats = 3;  ///< of a solve, to take such contact in

}  // namespace

void GridFabricSolver::solveOnce(const FaceTolerance& tolerance, const BlockArray<double, 3>* expected, FabricReport& report)
{
    const FaceSolveReport solve = system_.solve(tolerance, velocity_, expected);
    ++report.newton;
    report.iterations += solve.iterations;
    report.speedError = solve.speedError;
}

/// What is assembled has changed: from the start again, by way of what was found.
void GridFabricSolver::solveAgain(const FaceTolerance& tolerance, const FabricState& state, FabricReport& report)
{
    expected_.resize(system_.blocks());
    parallelFor(system_.blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        const double *first = start_.block(block), *last = velocity_.faces.block(block);
        for (int c = 0; c < kAxes * kBlockCells; ++c) expected_.block(block)[c] = last[c] - first[c];
    });
    velocity_.faces = start_;
    std::ranges::copy(state.omega, velocity_.twist.begin());
    solveOnce(tolerance, &expected_, report);
}

/// Elements that are pressed by the solved motion though nobody expected it, by the fabric's own forces, would store energy that nothing has
/// given: with them among the others the step is solved again. Leaves in motion_ what was solved for.
void GridFabricSolver::meetUnforeseen(double h, double kinetic, const FaceTolerance& tolerance, const FabricState& state, FabricReport& report)
{
    for (int repeat = 0;; ++repeat) {
        system_.findMotion(velocity_.faces, motion_);
        const StepOutlook found = outlookOn(h, tolerance);
        if (repeat == kMostRepeats || contact_.unforeseen(found) <= kUnforeseen * kinetic) return;
        contact_.takeIn(state, found);
        system_.assemble();
        solveAgain(tolerance, state, report);
    }
}

/// Where velocities u take the fabric, into trial_. Returns its elastic energy there [erg].
double GridFabricSolver::tryMove(double h, const AlignedArray<double>& u, const FabricState& state)
{
    FabricState& at = trial_;
    at.x.resize(state.x.size());
    at.theta.resize(state.theta.size());
    parallelFor(at.x.size(), 1024, [&](std::size_t v) { at.x[v] = state.x[v] + h * stiffness_.at(u, static_cast<int>(v)); });
    const std::vector<int>& twistSlot = stiffness_.unknowns().twistSlot;
    parallelFor(at.theta.size(), 4096, [&](std::size_t e) { at.theta[e] = state.theta[e] + h * u[twistSlot[e]]; });
    at.tangent = state.tangent, at.reference = state.reference, at.referenceTwist = state.referenceTwist;
    stiffness_.rods().transportFrames(at);
    return elasticEnergies(at, stiffness_.rods(), stiffness_.shells()).elastic();
}

/// ½ Σ m (u − v)² from the velocities v that the fabric brought to the faces, the liquid's drag being no mass [erg].
double GridFabricSolver::kineticOfChange()
{
    return parallelSum(system_.blocks(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        double sum = 0.0;
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = particles_.faces().sums.block(b, FaceFields::kMass + a), *first = particles_.velocity().block(b, a),
                         *last = velocity_.faces.block(b, a);
            for (int c = 0; c < kBlockCells; ++c)
                if (mass[c] > 0.0) sum += 0.5 * mass[c] * (last[c] - first[c]) * (last[c] - first[c]);
        }
        return sum;
    });
}

void GridFabricSolver::solve(double h, double kinetic, const FaceTolerance& tolerance, const FabricState& state, FabricReport& report)
{
    start_ = velocity_.faces;
    solveOnce(tolerance, expectedChange(state), report);
    const double before = elastic_.at(state, stiffness_.rods(), stiffness_.shells()).elastic();
    for (int n = 1;; ++n) {
        if (settings_.contact) meetUnforeseen(h, kinetic, tolerance, state, report);
        AlignedArray<double>& u = system_.onVertices(velocity_);
        const double reached = tryMove(h, u, state);
        // What elastic forces gave, against what they had; backward Euler loses the energy of the change of velocities beside.
        const double gain = reached - before + stiffness_.innerWork(h, u) - kineticOfChange();
        if (gain <= kNoGain * kinetic || n == kMostNewton) return;
        stiffness_.assembleAt(trial_, h, u);
        system_.assemble();
        solveAgain(tolerance, state, report);
    }
}

}  // namespace sim
