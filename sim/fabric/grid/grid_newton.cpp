#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"

#include <algorithm>
#include <cmath>

// One linear solve goes by the forces where a step begins. Where it moves fabric about as far as its edges are long, because liquid strikes or
// draws it, other forces act where it gets to, and energy would come from nothing: then these are solved for, by Newton's method.

namespace sim {

namespace {

/// Elastic energy from nothing that a step may leave, relative to that of the motion: more asks for another iteration [-].
constexpr double kNoGain = 1.0e-3;
constexpr int kMostNewton = 8;  ///< iterations
constexpr double kNoWay = 1.0e-3;  ///< by which solids change a move without a spring for it [radii]
constexpr int kMostRepeats = 3;  ///< of a solve, to take such contact in, or what solids stop

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

/// Lets go of what no longer presses against the solid that stopped it. Returns the work that the springs did there [erg].
double GridFabricSolver::letGo(double h, const AlignedArray<double>& u)
{
    double work = 0.0;
    std::erase_if(stopped_, [&](const ObstacleContact& contact) {
        const Vec3 move = h * stiffness_.at(u, contact.vertex), pull = contact.stiffness * (from_[contact.vertex] + move - contact.place);
        const bool isPulled = pull.dot(contact.gradient) > 0.0;
        if (isPulled) work += std::abs(pull.dot(move));
        return isPulled;
    });
    return work;
}

/// What solids stop on the way that was solved for stretches what goes on beside it: energy that nothing has given. Where it matters, springs to
/// where solids let it get act from now on, as long as they press. (Where nothing leads the fabric, a part of its way does: moveVertices.) Returns
/// whether the step is to be solved again.
bool GridFabricSolver::holdStopped(double h, double kinetic, const Vec3& gravity, const AlignedArray<double>& u, const FabricState& state)
{
    parallelFor(move_.size(), 1024, [&](std::size_t v) { wanted_[v] = move_[v] = h * stiffness_.at(u, static_cast<int>(v)); });
    GuardReport guarded;
    double matters = letGo(h, u);
    if (guard_.limit(state.x, mass_, move_, guarded) == SolidGuard::Limited::Changed)
        matters += energyAfter(move_, h, gravity, state).sum() - energyAfter(wanted_, h, gravity, state).sum();
    if (matters <= kNoGain * kinetic) return false;
    for (std::size_t v = 0; v < move_.size(); ++v) {
        const Vec3 back = move_[v] - wanted_[v];
        if (back.norm() <= kNoWay * fabric_.radius[v]) continue;
        const FabricMaterial& material = fabric_.materials[fabric_.vertexMaterial[v]];
        const Vec3 away = back.normalized();
        const auto before = std::ranges::find(stopped_, static_cast<int>(v), &ObstacleContact::vertex);
        ObstacleContact& contact = before == stopped_.end() ? stopped_.emplace_back() : *before;
        contact.vertex = static_cast<int>(v);
        contact.place = state.x[v] + move_[v];
        contact.between = {static_cast<int>(v), obstacles_.nearest(contact.place)};
        contact.gradient = away;
        contact.stiffness = (mass_[v] / (h * h) + material.young * std::cbrt(fabric_.volume[v])) * away * away.transpose();
    }
    touching_.resize(felt_);
    touching_.insert(touching_.end(), stopped_.begin(), stopped_.end());
    const std::span<ObstacleContact> held = std::span(touching_).subspan(felt_);
    for (ObstacleContact& contact : held) {
        contact.gradient.setZero();
        reached_[contact.vertex] = contact.place - state.x[contact.vertex];
    }
    stiffness_.hold(felt_, held, reached_);
    return true;
}

void GridFabricSolver::solve(double t, double h, double kinetic, const Vec3& gravity, const FaceTolerance& tolerance, const FabricState& state,
                             FabricReport& report)
{
    const bool mayBeStopped = !guard_.empty() && isDriven(t, h);
    start_ = velocity_.faces;
    solveOnce(tolerance, expectedChange(state), report);
    const double before = elastic_.at(state, stiffness_.rods(), stiffness_.shells()).elastic();
    for (int n = 1, holds = 0;; ++n) {
        if (settings_.contact) meetUnforeseen(h, kinetic, tolerance, state, report);
        AlignedArray<double>& u = system_.onVertices(velocity_);
        const double reached = tryMove(h, u, state);
        // What elastic forces gave, against what they had; backward Euler loses the energy of the change of velocities beside.
        const double gain = reached - before + stiffness_.innerWork(h, u) - kineticOfChange();
        const bool gains = gain > kNoGain * kinetic && n < kMostNewton,
                   isStopped = mayBeStopped && holds < kMostRepeats && holdStopped(h, kinetic, gravity, u, state);
        if (!gains && !isStopped) return;
        holds += isStopped ? 1 : 0;
        std::swap(trial_, solvedAt_);
        stiffness_.assembleAt(solvedAt_, h, u);
        system_.assemble();
        solveAgain(tolerance, state, report);
    }
}

}  // namespace sim
