#pragma once

#include "sim/fabric/cohesion.h"
#include "sim/fabric/contact/contact.h"
#include "sim/fabric/energies.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/groups.h"
#include "sim/fabric/integrator.h"
#include "sim/fabric/solids/obstacle_contact.h"
#include "sim/fabric/solids/solid_limiter.h"
#include "sim/fabric/vertex/bossak.h"
#include "sim/fabric/vertex/vertex_system.h"
#include "sim/forces.h"
#include "sim/obstacle_settings.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace sim {

/// `fabric.solver: vertex`: an implicit step in vertex space with a pairwise-limited Newton step (fabric/vertex/README.md, The step in
/// vertices). Nothing ever crosses: every move that is made was checked pair by pair along its straight path, and against the solids as they move.
class VertexSolver final : public FabricIntegrator {
 public:
    /// @param cohesion  of wet fabric; none without
    VertexSolver(const Fabric& fabric, const FabricSettings& settings, std::span<const ObstacleSettings> obstacles,
                 std::optional<Cohesion> cohesion = std::nullopt);

    /// A step that could not be taken is redone as two halves, and so on; each then takes its part of the loads, which are on vertices.
    FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads) override;
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const override;
    double deepestInObstacles(const FabricState& state) const override { return obstacles_.deepest(fabric_, state.x); }
    /// Those of the last Newton iteration.
    const ActiveContacts* contacts() const override { return contacts_; }
    double leastDistance() const;

 private:
    static constexpr double kAccelerationTolerance =
        0.01;  ///< rms error at which a linear solve is good enough: less is not felt [referenceAcceleration]
    static constexpr double kNegligibleGain =
        1.0e-3;  ///< energy from nothing that a step may leave, relative to its motion's: more asks for iterations [-]

    /// The Newton iterations of one attempt so far.
    struct Newton {
        int count = 0;
        double lastMove = 0.0;             ///< rms [radii]
        double wanted = 0.0, taken = 0.0;  ///< moves squared, and what the limiter left of them, by mass [g cm^2]
        double gain = 0.0;                 ///< where it ended [-]
        bool hasConverged = false, isNear = false, isQuiet = false;
    };

    /// A step or a part of one, and what it works on.
    struct Part {
        double t, h;  ///< it leads from t to t + h [s]
        int level;    ///< how often the step was halved for it
        FabricState& state;
        FabricReport& report;
        StageClock& clock;
        /// Its half that begins at a time.
        Part half(double from) const { return {from, 0.5 * h, level + 1, state, report, clock}; }
    };
    /// One attempt at a part; false if it should be redone in halves.
    bool attempt(const Part& part);
    void advanceInParts(const Part& part);
    bool beginAttempt(const Part& part, bool isLast);
    void predict(const Part& part);
    void findContacts(double h, std::span<const Vec3> x, std::span<const Vec3> expected, StageClock& clock);
    void updateContacts(double h, FabricState& state, StageClock& clock);
    void solve(const Part& part, Newton& newton);
    void checkConvergence(double h, Newton& newton) const;
    void applyStep(const Part& part, Newton& newton);
    void commit(FabricState& state, StageClock& clock);
    double rmsInRadii(std::span<const Vec3> move) const;
    bool followSolids(const Part& part, bool isLast);
    bool limit(const FabricState& state, FabricReport& report, StageClock& clock);
    bool limitAlternately(const FabricState& state, StageClock& clock);
    SolidLimiter::Limited limitAtSolids(const FabricState& state);
    void turnHeldEdges(double t, FabricState& state) const;
    double lagOf(double h) const;
    /// a0 of a step of h but for gravity, times the mass [dyn].
    Vec3 meanForceBefore(std::size_t v, double h) const
    {
        const FabricState::VertexSolverPart& before = start_.vertexSolver;
        if (before.force.empty()) return Vec3::Zero();
        return before.force[v] + lagOf(h) * (before.meanForce[v] - before.force[v]);
    }
    bossak::Vertex bossakOf(std::size_t v, double h) const;
    double stepOfInertia(double h) const;
    Vec3 limiterForce(std::size_t v, double h) const;
    /// What a contact does to its vertices; of those that it does not have four of, the last forces are 0.
    struct ActingContact {
        std::array<int, 4> vertices;
        std::array<Vec3, 4> force;  ///< [dyn]
        Vec3 velocity;              ///< of a solid's surface there; 0 between fabric [cm/s]
        double abrupt = 0.0;        ///< abruptShare [-]
    };
    void findContactForces(double h, std::vector<Vec3>& sum);
    double abruptShare(double h, const ActingContact& contact, std::span<const Vec3> all, const FabricState& state) const;
    void findAbrupt(double h, FabricState& state);
    void findRates(double h, FabricState& state);
    void findMeanRates(double h, FabricState& state) const;
    void findSecondOrderRates(double h, FabricState& state);
    void storeContacts(double h, FabricState& state);
    /// That by which an impulse from outside works [cm/s].
    Vec3 workingVelocity(std::size_t v, const FabricState& state) const
    {
        return isSecondOrder_ ? Vec3(0.5 * (start_.v[v] + state.v[v])) : state.v[v];
    }
    ContactEnergy contactEnergy(double h, std::span<const Vec3> x, const FabricState& held) const;
    double referenceEnergy(double kinetic, double h) const;
    double gain(double h, const FabricState& state);
    void keepRecoverable(FabricState& state) const;
    double recovered(const FabricState& state, const FabricGroups& groups) const;
    void iterate(const Part& part, Newton& newton);
    double allowedEnergy(double h, const FabricState& state);
    std::optional<EnergyChanges> dissipateGain(double h, FabricState& state);
    void removeSpuriousGain(const Part& part);
    /// What an attempt did.
    struct Way {
        std::vector<Vec3> moves;    ///< of each vertex [cm]
        std::vector<Vec3> drift;    ///< of each piece: that of its group, where nothing holds it, else 0 [cm]
        std::vector<double> turns;  ///< of each yarn edge [rad]
    };
    void goPart(const Part& part, const Way& way, double share);
    void findGroups(FabricGroups& groups) const;
    void findMomenta(const FabricState& state);
    void keepMomentum(double h, FabricState& state);
    void keepForces(FabricState& state);
    std::vector<char> heldBySolids() const;
    InternalGradient gradientAt(const FabricState& state, double length) const;
    void bookOutside(double h, const FabricState& state, InternalGradient& gradient, EnergyChanges& changes);
    Vec3 impulseOfHolder(std::size_t v, double h, const FabricState& state, const Vec3& gradient) const;
    double workOfHolder(std::size_t v, double h, const FabricState& state, const Vec3& impulse) const;
    double workOfPin(std::size_t v, double h, const FabricState& state, const Vec3& byLiquid, const Vec3& gradient, const Vec3& before) const;
    void bookPins(double h, const FabricState& state, std::span<const Vec3> gradient, EnergyChanges& changes);
    double workOutside(double h, const FabricState& state);
    EnergyChanges energyChanges(double h, const FabricState& state);
    FabricObstacles::Start obstacleStart(double h) const { return {start_.x, mass_, start_.onObstacles, stepOfInertia(h), springStep_}; }
    void bookContacts(const FabricState& state, EnergyChanges& changes, std::span<Vec3> gradient) const;
    Vec3 solvedMove(int vertex) const;
    Vec3 forceAtEnd(std::size_t contact) const;
    Vec3 forceAtEnd(const ObstacleContact& contact) const;
    void reportForces(double h, const FabricState& state) const;
    void reportContacts(double h, const FabricState& state) const;
    void reportSolidLimiter(double h, const FabricState& state) const;
    void reportPins(double h, const FabricState& state) const;
    void reportLiquid(const FabricState& state) const;

    const Fabric& fabric_;
    FabricSettings settings_;
    bool isSecondOrder_;  ///< fabric.integrator
    VertexSystem system_;
    std::optional<Cohesion> cohesion_;
    std::optional<FabricContact> contact_;
    FabricObstacles obstacles_;
    SolidLimiter solidLimiter_;
    FabricGroups groups_, attemptGroups_;  ///< groups of pieces in the step under way, and in its last attempt alone
    std::vector<Vec3> momentum_;           ///< of each piece, at the start of the step [g cm/s]
    std::vector<Vec3> missing_;            ///< of each group, at the end of the step: momentum [g cm/s]; integrator second_order, then: force [dyn]
    std::vector<Vec3> correction_;         ///< velocity that makes up for missing_, of each group [cm/s]
    std::vector<Vec3> groupInertia_;       ///< of each group [g]
    std::vector<Vec3> restReference_;      ///< of each yarn edge
    std::vector<int> nearestPin_;          ///< of each vertex (nearestPins)

    mutable ElasticEnergies elastic_;
    const ActiveContacts* contacts_ = nullptr;       ///< contacts of fabric with fabric in the last Newton iteration
    std::span<const ObstacleContact> touching_;      ///< contacts of fabric with obstacles in the last Newton iteration
    LimitReport limits_;                             ///< limits of contact between fabric in the attempt under way
    SolidLimitReport solidLimits_;                   ///< limits of contact with solids in the attempt under way
    bool solidLimiterActed_ = false;                 ///< solids have changed the last move
    std::vector<Vec3> limitedMove_, unlimitedMove_;  ///< of each vertex, where forces are wanted: the move after solids changed it, and before [cm]
    std::vector<Vec3> wholeMove_;                    ///< move_ of the whole step, while it is made in halves [cm]
    const LiquidLoads* loads_ = nullptr;             ///< of the step under way
    double wholeStep_ = 0.0;                         ///< its length [s]
    double placeRounding_ = 0.0;                     ///< by which places of the step under way are rounded [cm]
    double referenceAcceleration_ = 0.0;             ///< referenceAcceleration of the step under way [cm/s^2]
    FabricState start_;                              ///< of the attempt under way, to go back to
    double startTime_ = 0.0;                         ///< time at the start of the attempt [s]
    FabricEnergies startEnergies_;                   ///< energies at the start of the attempt
    double undetectedAtStart_ = 0.0;                 ///< energy of contacts at the start that the step before has not detected [erg]
    bool startIsChecked_ = false;                    ///< that energy is known
    bool solidsMove_ = false;                        ///< those near the fabric, in the attempt
    bool isDriven_ = false;                          ///< by solids, or pins that move in the attempt under way
    bool hasMovedSinceDetection_ = false;            ///< along system_'s last move
    double springStep_ = 0.0;                        ///< of the attempt (springStepFor) [s]
    std::vector<double> mass_;                       ///< of each vertex, with what it has absorbed [g]
    std::vector<Vec3> inertia_;                      ///< of each vertex (NewtonPoint) [g]
    std::vector<Vec3> free_, move_;                  ///< of each vertex [cm]
    std::vector<Vec3> expected_;                     ///< of each vertex: its move if forces act on as they did [cm]
    std::vector<double> freeAngle_;                  ///< of each yarn edge [rad]
    std::vector<Vec3> abrupt_;                       ///< of each vertex, integrator second_order: F of contact and the limiter (bossak.h) [dyn]
    std::vector<Vec3> pinForce_;                     ///< the fabric's own on each pinned vertex, once it is known at the end [dyn]
    std::vector<ActingContact> acting_;              ///< at the end of Newton's last move, integrator second_order
    Vec3 gravity_ = Vec3::Zero();                    ///< of the step under way [cm/s^2]
    double made_ = 0.0;                              ///< energy that the attempt has beyond what it may have; negative: what it lost [erg]
    double totalMass_ = 0.0;                         ///< [g]
    double meanRadius_ = 0.0;                        ///< weighted by mass [cm]
};

}  // namespace sim
