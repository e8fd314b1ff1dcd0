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
    /// @param cohesion  liquid bridges of wet fabric; null: none
    VertexSolver(const Fabric& fabric, const FabricSettings& settings, std::span<const ObstacleSettings> obstacles,
                 std::optional<Cohesion> cohesion = std::nullopt);

    /// A rejected step is split recursively; each substep gets its share of the loads, which are on vertices.
    FabricReport advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads) override;
    FabricEnergies energies(const FabricState& state, const Vec3& gravity) const override;
    double deepestInObstacles(const FabricState& state) const override { return obstacles_.deepest(fabric_, state.x); }
    /// Active contacts of the last Newton iteration.
    const ActiveContacts* contacts() const override { return contacts_ ? &contacts_->pairs() : nullptr; }
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
        double wanted = 0.0, taken = 0.0;  ///< mass-weighted squared norms of the Newton step and of its accepted part [g cm^2]
        double gain = 0.0;                 ///< spurious energy gain relative to the kinetic energy, after the last iteration [-]
        bool hasConverged = false, isNearSolution = false, hasNegligibleChange = false;
    };

    /// A step or a part of one, and what it works on.
    struct Part {
        double t, h;  ///< start and length [s]
        int level;    ///< how often the step was halved for it
        FabricState& state;
        FabricReport& report;
        StageClock& clock;
        /// Half of this part, from a time on.
        Part half(double from) const { return {from, 0.5 * h, level + 1, state, report, clock}; }
    };
    /// What limit made of move_.
    struct LimitedMove {
        bool isSafe = false;                                       ///< always, where solids rest
        std::optional<FabricContact::LimitedMoves> betweenFabric;  ///< limits between fabric and fabric, where there is contact
    };
    /// One attempt at a part; false if it should be redone in halves.
    bool trySubstep(const Part& part);
    void advanceInParts(const Part& part);
    bool beginAttempt(const Part& part, bool isLast);
    void predict(const Part& part);
    std::span<const ObstacleContact> touching() const
    {
        return solids_ ? std::span<const ObstacleContact>(solids_->contacts()) : std::span<const ObstacleContact>();
    }
    void findContacts(double h, std::span<const Vec3> x, std::span<const Vec3> expected, StageClock& clock);
    void updateContacts(double h, FabricState& state, StageClock& clock);
    void solve(const Part& part, Newton& newton);
    void checkConvergence(double h, Newton& newton) const;
    void applyStep(const Part& part, Newton& newton);
    void commit(const LimitedMove& move, FabricState& state, StageClock& clock);
    double rmsInRadii(std::span<const Vec3> move) const;
    bool followSolids(const Part& part, bool isLast);
    LimitedMove limit(const FabricState& state, FabricReport& report, StageClock& clock);
    LimitedMove limitAlternately(const FabricState& state, StageClock& clock);
    SolidLimiter::Limited limitAtSolids(const FabricState& state);
    void turnHeldEdges(double t, FabricState& state) const;
    double meanForceLag(double h) const;
    /// a0 of a step of h but for gravity, times the mass [dyn].
    Vec3 meanForceBefore(std::size_t v, double h) const
    {
        const FabricState::VertexSolverPart& before = start_.vertexSolver;
        if (before.force.empty()) return Vec3::Zero();
        return before.force[v] + meanForceLag(h) * (before.meanForce[v] - before.force[v]);
    }
    bossak::Vertex bossakOf(std::size_t v, double h) const;
    double stepOfInertia(double h) const;
    Vec3 limiterForce(std::size_t v, double h) const;
    /// What a contact does to its vertices; of those that it does not have four of, the last forces are 0.
    struct ActingContact {
        std::array<int, 4> vertices;
        std::array<Vec3, 4> force;  ///< [dyn]
        Vec3 velocity;              ///< velocity of a solid's surface there; 0 between fabric [cm/s]
        double abrupt = 0.0;        ///< abruptShare [-]
    };
    void findContactForces(double h, std::vector<Vec3>& sum);
    double abruptShare(double h, const ActingContact& contact, std::span<const Vec3> all, const FabricState& state) const;
    void findAbrupt(double h, FabricState& state);
    void findRates(double h, FabricState& state);
    void findMeanRates(double h, FabricState& state) const;
    void findSecondOrderRates(double h, FabricState& state);
    void storeContacts(double h, FabricState& state);
    /// Velocity by which an impulse from outside works [cm/s].
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
    double bearableGain(double h) const;
    double gainSoFar(const FabricState& state, const FabricGroups& groups) const;
    double aheadOfWay(double h, const FabricState& state, const FabricGroups& groups) const;
    std::optional<EnergyChanges> dissipateGain(double h, FabricState& state);
    void removeSpuriousGain(const Part& part);
    /// Displacement of a substep: vertices, rigid drift of groups, twist.
    struct SubstepDisplacement {
        std::vector<Vec3> moves;          ///< displacement of each vertex [cm]
        std::vector<Vec3> drift;          ///< displacement of each piece's group, where nothing holds it, else 0 [cm]
        std::vector<Vec3> driftVelocity;  ///< velocity of it at the end of the attempt [cm/s]
        std::vector<double> turns;        ///< twist of each yarn edge [rad]
    };
    void applyFraction(const Part& part, const SubstepDisplacement& displacement, double share);
    void findGroups(FabricGroups& groups) const;
    void findMomenta(const FabricState& state);
    void conserveMomentum(double h, FabricState& state);
    void conserveForces(FabricState& state);
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
    bool isSecondOrder_ = false;  ///< fabric.integrator, but for steps of fabric that owes energy: backward Euler takes some
    VertexSystem system_;
    std::optional<ElasticStep> elasticStep_;  ///< rods and shells in the attempt under way
    std::optional<Cohesion> cohesion_;
    std::optional<FabricContact> contact_;
    FabricObstacles obstacles_;
    SolidLimiter solidLimiter_;
    FabricGroups groups_, attemptGroups_;  ///< groups of pieces in the step under way, and in its last attempt alone
    std::vector<Vec3> momentum_;           ///< momentum of each piece at the start of the step [g cm/s]
    std::vector<Vec3> missing_;            ///< momentum that each group lacks at the end of the step [g cm/s]; in conserveForces: force [dyn]
    std::vector<Vec3> correction_;         ///< velocity that makes up for missing_, of each group [cm/s]
    std::vector<Vec3> groupInertia_;       ///< mass of each group, with drag [g]
    std::vector<Vec3> restReference_;      ///< reference direction of each yarn edge at rest
    std::vector<int> nearestPin_;          ///< nearestPins of each vertex

    mutable ElasticEnergies elastic_;
    std::optional<FabricContact::Active> contacts_;  ///< contacts of fabric with fabric in the last Newton iteration, where any are near
    std::optional<FabricObstacles::Found> solids_;   ///< contacts of fabric with obstacles in the last Newton iteration
    LimitReport limits_;                             ///< limits of contact between fabric in the attempt under way
    SolidLimitReport solidLimits_;                   ///< limits of contact with solids in the attempt under way
    bool solidLimiterActed_ = false;                 ///< solids have changed the last move
    std::vector<Vec3> limitedMove_, unlimitedMove_;  ///< move of each vertex after solids changed it, and before, where forces are wanted [cm]
    std::vector<Vec3> wholeMove_;                    ///< move_ of the whole step, while it is made in halves [cm]
    const LiquidLoads* loads_ = nullptr;             ///< loads of the step under way
    double wholeStep_ = 0.0;                         ///< length of the step under way [s]
    double placeRounding_ = 0.0;                     ///< rounding of positions in the step under way [cm]
    double referenceAcceleration_ = 0.0;             ///< referenceAcceleration of the step under way [cm/s^2]
    FabricState start_;                              ///< state at the start of the attempt, to go back to
    double startTime_ = 0.0;                         ///< time at the start of the attempt [s]
    FabricEnergies startEnergies_;                   ///< energies at the start of the attempt
    double undetectedAtStart_ = 0.0;                 ///< energy of contacts at the start that the step before has not detected [erg]
    bool startIsChecked_ = false;                    ///< whether undetectedAtStart_ is known
    bool solidsMove_ = false;                        ///< whether solids near the fabric move in the attempt
    bool isDriven_ = false;                          ///< whether solids or pins that move drive the fabric in the attempt under way
    bool hasMovedSinceDetection_ = false;            ///< whether the fabric has moved along system_'s last move
    double springStep_ = 0.0;                        ///< springStepFor of the attempt [s]
    std::vector<double> mass_;                       ///< mass of each vertex with what it has absorbed [g]
    std::vector<Vec3> inertia_;                      ///< inertia of each vertex (NewtonPoint) [g]
    std::vector<Vec3> free_, move_;                  ///< move of each vertex without forces, and the present one [cm]
    std::vector<Vec3> expected_;                     ///< move of each vertex if forces act on as they did [cm]
    std::vector<double> freeAngle_;                  ///< twist of each yarn edge without forces [rad]
    std::vector<Vec3> abrupt_;                       ///< F of contact and the limiter on each vertex (bossak.h), integrator second_order [dyn]
    std::vector<Vec3> pinForce_;                     ///< the fabric's own on each pinned vertex, once it is known at the end [dyn]
    std::vector<ActingContact> acting_;              ///< contacts at the end of Newton's last move, integrator second_order
    Vec3 gravity_ = Vec3::Zero();                    ///< gravity of the step under way [cm/s^2]
    double made_ = 0.0;                              ///< energy that the attempt has beyond what it may have; negative: what it lost [erg]
    double totalMass_ = 0.0;                         ///< [g]
    double meanRadius_ = 0.0;                        ///< weighted by mass [cm]
};

}  // namespace sim
