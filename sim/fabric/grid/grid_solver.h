#pragma once

#include "sim/fabric/energies.h"
#include "sim/fabric/grid/face_system.h"
#include "sim/fabric/groups.h"
#include "sim/fabric/liquid_loads.h"
#include "sim/fabric/obstacle_contact.h"
#include "sim/fabric/solids/guard.h"
#include "sim/forces.h"
#include "sim/scene/scene.h"

#include <span>
#include <vector>

namespace sim {

/// `fabric.solver: grid`: fabric as the PolyPIC paper solves for it (fabric/grid/README.md, Contact law; Linear system); nothing of it ever crosses
/// the surface of a solid. The vertices are particles of a MAC grid whose face velocities are the unknowns of one linearised backward Euler step;
/// contact is a continuum that the grid resolves to a cell, so that nothing keeps yarns from crossing within one. Contact is implicit and acts on
/// the mesh too, and twist angles are unknowns of their own.
class GridFabricSolver {
 public:
    /// @param meetsLiquid  is there any in the scene?
    GridFabricSolver(const Fabric& fabric, const Settings& settings, std::span<const ObstacleSettings> obstacles,
                     bool meetsLiquid = false);
    GridFabricSolver(const GridFabricSolver&) = delete;  // its parts refer to each other
    GridFabricSolver& operator=(const GridFabricSolver&) = delete;

    /// From t to t + h [s]. h must keep within time.maxCflFabric (chooseTimeStep in step.h).
    FabricReport step(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock)
    {
        spread(state, clock);
        return advance(t, h, gravity, state, clock, nullptr);
    }
    /// The same in two parts: the fabric's masses and velocities on the grid, then all the rest.
    /// @param loads  of the liquid on the same cells, or null
    void spread(FabricState& state, StageClock& clock);
    FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock,
                         const FaceLoads* loads);
    /// Velocities on the grid: those that the vertices brought after spread, those at the end of the step after
    /// advance.
    FabricFaces faces() const { return {particles_.grid(), particles_.faces().velocity}; }
    /// From now on reports tell where energy goes: takes as long as some iterations of the solve.
    void bookEnergy() { booksEnergy_ = true; }
    /// From now on steps add there what acts between the fabric and solids, pins and liquid. What fabrics do to each other on faces that both
    /// reach is not told apart.
    void tellForces(Forces& forces) { forces_ = &forces; }
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const;
    /// Energy that contact on the grid held at the start of the last step [erg].
    double contactEnergy() const { return contact_.energy(); }
    /// Deepest reach of the fabric into an obstacle at the end of the last step [cm].
    double deepestInObstacles(const FabricState& state) const { return obstacles_.deepest(fabric_, state.x); }

 private:
    void begin(FabricState& state);
    std::span<const ObstacleContact> touchObstacles(double t, double h, const Vec3& gravity, const FabricState& state);
    FabricObstacles::Start obstacleStart(double h, const FabricState& state) const
    {
        return {from_, mass_, state.onObstacles, h, state.springStep};
    }
    /// Of the fabric [erg].
    struct Mechanical {
        double free, elastic;  ///< free: kinetic and potential
        double sum() const { return free + elastic; }
    };
    Mechanical energyAfter(double part, double h, const Vec3& gravity, const FabricState& state);
    double partWithoutGain(double limit, double h, const Vec3& gravity, const FabricState& state);
    void moveVertices(double t, double h, const Vec3& gravity, FabricState& state, FabricReport& report);
    void startVelocities(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads);
    void solve(double h, double kinetic, const FaceTolerance& tolerance, const FabricState& state, FabricReport& report);
    void solveOnce(const FaceTolerance& tolerance, const BlockArray<double, 3>* expected, FabricReport& report);
    void solveAgain(const FaceTolerance& tolerance, const FabricState& state, FabricReport& report);
    void meetUnforeseen(double h, double kinetic, const FaceTolerance& tolerance, const FabricState& state, FabricReport& report);
    double kineticOfChange();
    double tryMove(double h, const AlignedArray<double>& u, const FabricState& state);
    StepOutlook outlookOn(double h, const FaceTolerance& tolerance) const;
    void findGroups(std::span<const ObstacleContact> touching);
    void keepMomentum(std::span<const ObstacleContact> touching);
    const BlockArray<double, 3>* expectedChange(const FabricState& state);
    void keepChange(FabricState& state) const;
    void keepAccelerations(double h, FabricState& state);
    void bookSolve(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads,
                   EnergyChanges& changes);
    void bookVertices(const Vec3& gravity, const ContactEnergy& before, const FabricState& state, EnergyChanges& changes) const;
    double facesKinetic(const BlockArray<double, 3>& velocity) const;
    void tellSprings(double h, const FabricState& state, std::span<const ObstacleContact> touching);
    void tellGuard(double h, const FabricState& state) const;
    void tellLiquid(const FabricState& state, const FaceLoads& loads);

    /// Energy that contact may come to hold without having been solved for, relative to that of the motion and of a step's fall [-].
    static constexpr double kUnforeseen = 0.01;

    const Fabric& fabric_;
    FabricSettings settings_;
    VertexStiffness stiffness_;
    ElementContact contact_;
    FabricParticles particles_;
    FaceSystem system_;
    FabricObstacles obstacles_;
    SolidGuard guard_;
    FabricGroups groups_;                           ///< of the step under way …
    std::vector<int> groupOfBlock_, nearBlock_;     ///< … and of blocks (findGroups)
    FaceVector velocity_;
    bool meetsLiquid_, booksEnergy_ = false;
    Forces* forces_ = nullptr;  ///< where they are wanted
    std::vector<double> mass_;  ///< of each vertex, with what it has absorbed [g]
    // On the faces: velocities before the solve, the change to start it with [cm/s], what the fabric's own forces did
    // [cm/s^2].
    BlockArray<double, 3> start_, expected_, acceleration_;
    std::vector<Vec3> points_;  ///< quadrature points of the elements [cm]
    std::vector<Vec3> from_, expectedMove_;  ///< of each vertex: position at the start of the step, its move if forces act on as they did [cm]
    std::vector<Vec3> predicted_,
        reached_;  ///< of each vertex without forces: velocity [cm/s], position at the end of the step [cm]
    std::vector<Vec3> move_, wanted_;  ///< of each vertex in the step, and but for solids [cm]
    std::vector<Vec3> byLiquid_;       ///< of each vertex: impulse per mass [cm/s]
    FabricState trial_;                ///< places and frames where a move would take the fabric
    FabricMotion motion_;
    mutable ElasticEnergies elastic_;
};

}  // namespace sim
