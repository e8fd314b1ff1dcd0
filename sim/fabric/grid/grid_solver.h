#pragma once

#include "sim/fabric/energies.h"
#include "sim/fabric/grid/face_system.h"
#include "sim/fabric/groups.h"
#include "sim/fabric/integrator.h"
#include "sim/fabric/solids/obstacle_contact.h"
#include "sim/fabric/solids/solid_limiter.h"
#include "sim/forces.h"
#include "sim/obstacle_settings.h"

#include <span>
#include <vector>

namespace sim {

/// `fabric.solver: grid`: fabric as the PolyPIC paper solves for it (fabric/grid/README.md, Contact law; Linear system); nothing of it ever crosses
/// the surface of a solid. The vertices are particles of a MAC grid whose face velocities are the unknowns of one linearised backward Euler step;
/// contact is a continuum that the grid resolves to a cell, so that nothing keeps yarns from crossing within one. Contact is implicit and acts on
/// the mesh too, and twist angles are unknowns of their own.
class GridFabricSolver final : public FabricIntegrator {
 public:
    /// @param meetsLiquid  is there any in the scene?
    GridFabricSolver(const Fabric& fabric, const Settings& settings, std::span<const ObstacleSettings> obstacles, bool meetsLiquid = false);

    /// The fabric's masses and velocities on the grid.
    void prepare(FabricState& state, StageClock& clock) override;
    /// h must keep within time.maxCflFabric (chooseTimeStep); loads are on the faces of a grid with the same cells.
    FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads) override;
    std::optional<FabricFaces> faces() const override { return FabricFaces{particles_.grid(), particles_.faces().velocity}; }
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const override;
    double deepestInObstacles(const FabricState& state) const override { return obstacles_.deepest(fabric_, state.x); }

 private:
    void begin(FabricState& state);
    FabricObstacles::Found touchObstacles(double t, double h, const Vec3& gravity, const FabricState& state);
    FabricObstacles::Start obstacleStart(double h, const FabricState& state) const { return {from_, mass_, state.onObstacles, h, state.springStep}; }
    /// Mechanical energy of the fabric [erg].
    struct Mechanical {
        double free, elastic;  ///< free: kinetic and potential
        double sum() const { return free + elastic; }
    };
    Mechanical energyAfter(double part, double h, const Vec3& gravity, const FabricState& state);
    double partWithoutGain(double limit, double h, const Vec3& gravity, const FabricState& state);
    void moveVertices(double t, double h, const Vec3& gravity, FabricState& state, FabricReport& report);
    void startVelocities(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads);
    /// A solve of one step: what it goes by and what acts on the fabric.
    struct Solve {
        double h;  ///< [s]
        const Vec3& gravity;
        const FabricState& state;  ///< state at the start of the step
        const FaceLoads* loads;
        FaceTolerance tolerance;
        FaceSystem::Begun begun;
        VertexStiffness::Assembled stiffness;
        ElementContact::Assembled contact;
        double kinetic;  ///< energy of the fabric's motion, or of one that is not felt [erg]
    };
    void solve(const Solve& of, FabricReport& report);
    double gainOfMotion(const Solve& of, double before);
    void shortenMotion(const Solve& of, double before);
    void solveOnce(const FaceTolerance& tolerance, const BlockArray<double, 3>* expected, FabricReport& report);
    void solveAgain(const FaceTolerance& tolerance, const FabricState& state, FabricReport& report);
    ElementContact::Assembled addOmittedContacts(const Solve& of, const FaceTolerance& tolerance, const VertexStiffness::Assembled& stiffness,
                                                 ElementContact::Assembled contact, FabricReport& report);
    double kineticOfChange();
    double tryMove(double h, const AlignedArray<double>& u, const FabricState& state);
    PredictedMotion predictionOn(double h, const FaceTolerance& tolerance) const;
    void findGroups(std::span<const ObstacleContact> touching);
    void conserveMomentum(std::span<const ObstacleContact> touching);
    const BlockArray<double, 3>* expectedChange(const FabricState& state);
    void storeChange(FabricState& state) const;
    void storeAccelerations(double h, FabricState& state);
    void bookSolve(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads, EnergyChanges& changes);
    void bookVertices(const Vec3& gravity, const ContactEnergy& before, const FabricState& state, EnergyChanges& changes) const;
    /// What the solve did with the fabric on its faces, and with its twist [erg].
    struct OnFaces {
        double kineticBefore = 0.0, kineticAfter = 0.0;
        double ofChange = 0.0;  ///< kinetic energy of the change of velocities; liquid's drag is no mass here
        double fall = 0.0;      ///< work of weight
        double drag = 0.0;      ///< work of the liquid
    };
    OnFaces workOnFaces(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads);
    void reportSprings(double h, const FabricState& state, std::span<const ObstacleContact> touching);
    void reportSolidLimiter(double h, const FabricState& state) const;
    void reportLiquid(const FabricState& state, const FaceLoads& loads);

    /// Energy that contact may come to hold without having been solved for, relative to that of the motion and of a step's fall [-].
    static constexpr double kOmittedEnergy = 0.01;

    const Fabric& fabric_;
    FabricSettings settings_;
    VertexStiffness stiffness_;
    ElementContact contact_;
    FabricParticles particles_;
    FaceSystem system_;
    FabricObstacles obstacles_;
    SolidLimiter solidLimiter_;
    FabricGroups groups_;                        ///< groups of pieces in the step under way
    std::vector<int> groupOfBlock_, nearBlock_;  ///< each block's group, and a block that it belongs to (findGroups)
    FaceVector velocity_, leastGain_;            ///< last velocities of the solve under way, and those that gave the fabric least energy [cm/s, 1/s]
    bool isSolved_ = false;                      ///< the error of the last linear solve is acceptable
    double errorWork_ = 0.0;                     ///< energy that the error of the last linear solve gave [erg]
    bool meetsLiquid_;
    std::vector<double> mass_;  ///< mass of each vertex with what it has absorbed [g]
    // On the faces: velocities before the solve, the change to start it with [cm/s], what the fabric's own forces did
    // [cm/s^2].
    BlockArray<double, 3> start_, expected_, acceleration_;
    std::vector<Vec3> points_;               ///< quadrature points of the elements [cm]
    std::vector<Vec3> from_, expectedMove_;  ///< each vertex' position at the start of the step, and its move if forces act on as they did [cm]
    std::vector<Vec3> predicted_,
        reached_;                      ///< each vertex' velocity [cm/s] and position [cm] at the end of the step without forces
    std::vector<Vec3> move_, wanted_;  ///< move of each vertex in the step, and what it would be but for solids [cm]
    std::vector<Vec3> byLiquid_;       ///< impulse of the liquid on each vertex per mass [cm/s]
    FabricState trial_;                ///< places and frames where a move would take the fabric
    FabricMotion motion_;
    mutable ElasticEnergies elastic_;
};

}  // namespace sim
