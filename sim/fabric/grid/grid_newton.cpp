#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"

#include <algorithm>
#include <limits>

// One linear solve goes by the forces where a step begins. Where it moves fabric about as far as its edges are long, because liquid strikes or
// draws it, other forces act where it gets to, and energy would come from nothing: then these are solved for, by Newton's method. Where that does
// not come to a solution either, the fabric makes as much of the move as gives it no energy.

namespace sim {

namespace {

/// Elastic energy from nothing that a step may leave, relative to that of the motion: more asks for another iteration [-].
constexpr double kNegligibleGain = 1.0e-3;
constexpr double kTighter = 0.1;  ///< what the errors of the next solve must keep within, relative to those of one that gave energy [-]
constexpr int kMostNewton = 8;    ///< iterations
constexpr int kMostRepeats = 3;   ///< repeats of a solve at most, to take contact in that was not expected

}  // namespace

void GridFabricSolver::solveOnce(const FaceTolerance& tolerance, const BlockArray<double, 3>* expected, FabricReport& report)
{
    const FaceSolveReport solve = system_.solve(tolerance, velocity_, expected);
    ++report.newton;
    report.iterations += solve.iterations;
    report.speedError = solve.speedError;
    isSolved_ = solve.speedError <= tolerance.after(solve.iterations);
    errorWork_ = solve.errorWork;
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
ElementContact::Assembled GridFabricSolver::addOmittedContacts(const Solve& of, const FaceTolerance& tolerance,
                                                               const VertexStiffness::Assembled& stiffness, ElementContact::Assembled contact,
                                                               FabricReport& report)
{
    for (int repeat = 0;; ++repeat) {
        system_.findMotion(of.begun, velocity_.faces, motion_);
        const PredictedMotion found = predictionOn(of.h, tolerance);
        if (repeat == kMostRepeats || contact_.omittedEnergy(found) <= kOmittedEnergy * of.kinetic) return contact;
        contact = contact_.activate(contact, of.state, found);
        system_.assemble(of.begun, stiffness, contact);
        solveAgain(tolerance, of.state, report);
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

/// Energy that the solved motion would give the fabric beyond what weight, liquid, pins and solids do [erg].
/// @param before  elastic energy at the start of the step [erg]
double GridFabricSolver::gainOfMotion(const Solve& of, double before)
{
    AlignedArray<double>& u = system_.vertexVelocities(velocity_);
    const double elastic = tryMove(of.h, u, of.state) - before;
    const VertexStiffness::Work holds = stiffness_.workOfConstraints(of.h, u);
    double contact = 0.0;
    if (settings_.contact) {
        system_.findMotion(of.begun, velocity_.faces, motion_);
        contact = contact_.gain(predictionOn(of.h, of.tolerance));
    }
    const OnFaces onFaces = workOnFaces(of.h, of.gravity, of.state, of.loads);
    return onFaces.kineticAfter - onFaces.kineticBefore + elastic + contact - onFaces.fall - onFaces.drag - holds.pins - holds.obstacles;
}

/// Velocities become the largest share of themselves that gives the fabric no energy. Standing still gives none.
void GridFabricSolver::shortenMotion(const Solve& of, double before)
{
    const FaceVector whole = velocity_;
    for (const double share : {1.0, 0.5, 0.25, 0.125, 0.0}) {
        for (std::size_t i = 0; i < whole.faces.size(); ++i) velocity_.faces.block(0)[i] = share * whole.faces.block(0)[i];
        for (std::size_t e = 0; e < whole.twist.size(); ++e) velocity_.twist[e] = share * whole.twist[e];
        if (gainOfMotion(of, before) <= kNegligibleGain * of.kinetic) return;
    }
}

void GridFabricSolver::solve(const Solve& of, FabricReport& report)
{
    const double h = of.h, kinetic = of.kinetic;
    const FabricState& state = of.state;
    FaceTolerance tolerance = of.tolerance;
    VertexStiffness::Assembled stiffness = of.stiffness;
    ElementContact::Assembled contact = of.contact;
    double least = std::numeric_limits<double>::infinity();
    start_ = velocity_.faces;
    solveOnce(tolerance, expectedChange(state), report);
    const double before = elastic_.at(state, stiffness_.rods(), stiffness_.shells()).elastic();
    for (int n = 1;; ++n) {
        if (settings_.contact) contact = addOmittedContacts(of, tolerance, stiffness, contact, report);
        AlignedArray<double>& u = system_.vertexVelocities(velocity_);
        const double reached = tryMove(h, u, state);
        // What elastic forces gave, against what they had, and what the solve's error did; backward Euler loses the energy of the change of
        // velocities beside.
        const double gain = reached - before + stiffness_.internalWork(h, u) - kineticOfChange() + errorWork_;
        if (isSolved_ && gain <= kNegligibleGain * kinetic) return;
        if (errorWork_ > kNegligibleGain * kinetic) tolerance.target *= kTighter, tolerance.acceptable *= kTighter;
        if (isSolved_ && gain < least) least = gain, leastGain_ = velocity_;
        if (n == kMostNewton) break;
        stiffness = stiffness_.assembleAt(stiffness, trial_, h, u);
        system_.assemble(of.begun, stiffness, contact);
        solveAgain(tolerance, state, report);
    }
    if (least < std::numeric_limits<double>::infinity()) velocity_ = leastGain_;
    shortenMotion(of, before);
    ++report.truncatedSubsteps;
}

}  // namespace sim
