#pragma once

#include "sim/fabric/components.h"
#include "sim/fabric/contact/contact.h"
#include "sim/fabric/energies.h"
#include "sim/fabric/rods/rods.h"
#include "sim/fabric/shells/shells.h"
#include "sim/fabric/solids/obstacle_contact.h"
#include "sim/fabric/vertex/cloth_preconditioner.h"
#include "sim/fabric/vertex/pair_pack.h"
#include "sim/fabric/vertex_unknowns.h"

#include <span>
#include <vector>

namespace sim {

/// What a Newton iteration looks at: the fabric's state and where it would go without forces.
struct NewtonPoint {
    const ElasticStep& step;
    const FabricState& state;
    std::span<const Vec3> freePositions;  ///< position of each vertex without forces [cm]
    std::span<const double> freeAngles;   ///< twist of each yarn edge without forces [rad]
    std::span<const Vec3> inertia;        ///< mass of each vertex, and drag of liquid times the step, by components [g]
    double h;                             ///< length of the step [s]
    double twistInertia = 1.0;            ///< inertia of twist angles in the step, relative to their own [-]
};

/// When a component is solved for well enough: √(rᵀz / its mass), the rms error of its speeds, below `share` of what it was at first, 0.3 of
/// that in the step's first iteration, or `speed`; and below `most` in any case. Of what is small enough from the start `left` remains at most.
struct LinearTolerance {
    double share;           ///< [-]
    double speed, most;     ///< [cm/s]
    double left = 1.0;      ///< [-]
    double roundOff = 0.0;  ///< slower errors are of rounding and stay [cm/s]
};

/// Linear solve of one Newton iteration.
struct LinearReport {
    int iterations = 0;
    double speedError = 0.0;    ///< √(rᵀz / total mass) at the end [cm/s]
    bool isIndefinite = false;  ///< a component has been left as soon as a direction of negative curvature was met
};

/// The Newton system in vertex space, A = S + K + C: S the strands with their inertia, the same-side part of their contacts and
/// obstacles, factored exactly; K the cloth; C contact between different strands, and what shared vertices tie together.
/// Solved by conjugate gradients with S and a block-incomplete factor of K as preconditioner, each connected component by itself
/// (fabric/vertex/README.md, Linear solve).
class VertexSystem {
 public:
    VertexSystem(const Fabric& fabric, const FabricSettings& settings);

    const Rods& rods() const { return rods_; }
    const Shells& shells() const { return shells_; }
    const VertexUnknowns& unknowns() const { return unknowns_; }

    /// A step begins at the state.
    ElasticStep startStep(const FabricState& state) { return {rods_.startStep(state), shells_.startStep(state.x)}; }
    /// Gradient and matrix at a point, with its factors.
    void assemble(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts);
    /// Assembles anew after a solve that met an indefinite component, there without the part of the twist that can be: strands are factored one by
    /// one, without what they share, and together may be indefinite where each is not.
    void assembleDefinite(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts);
    /// Newton's move. `isFirst`: in the step's first iteration.
    LinearReport solve(const LinearTolerance& tolerance, bool isFirst, int maxIterations);

    Vec3 move(int vertex) const;                                                  ///< move of the last solve [cm]
    double turn(int edge) const { return solution_[unknowns_.twistSlot[edge]]; }  ///< [rad]
    const AlignedArray<double>& gradient() const { return gradient_; }
    /// What would be the gradient of the held unknowns at the last assembly, if they were not: 3 numbers of each pin [dyn], then one of each
    /// held twist angle, by edges [dyn cm].
    std::span<const double> heldGradient() const { return heldGradient_; }

 private:
    static constexpr int kNextVertex = 4 * kLanes;  ///< how far the next vertex of a strand is in a vector

    /// A vertex's rows in a strand that does not own it: they are emptied, and what they held acts through this.
    struct Link {
        int vertex, strandRow, lane;
        std::array<int, 16> slot;  ///< slots of the unknowns that its rows were coupled to; −1 for none
        std::array<std::array<double, 16>, 3> coupling;
    };

    /// Conjugate gradients of one component.
    struct Component {
        double mass = 0.0;          ///< mass of what is not pinned, with drag [g]
        double energy = 0.0;        ///< rᵀz [erg]
        double next = 0.0;          ///< rᵀz after the step that is being made [erg]
        double curvature = 0.0;     ///< pᵀA p [erg]
        double step = 0.0;          ///< along p [-]
        double ratio = 0.0;         ///< share of p in the next p [-]
        double target = 0.0;        ///< rᵀz that is small enough, after an iteration [erg]
        double roundOff = 0.0;      ///< rᵀz that is small enough for none [erg]
        bool isActive = true;       ///< whether it is still solved for
        bool isIndefinite = false;  ///< a direction of negative curvature was met
    };
    /// Pieces that the lanes of a pack belong to; −1 for none.
    struct PieceLanes {
        std::array<int, kLanes> piece;
        int common;  ///< component of all lanes that belong to one; −1 if there are several
        void findCommon();
    };

    void layOutPieces();
    void findComponents(const NewtonPoint& at, const ActiveContacts* contacts);
    void beginComponents();
    void setTargets(const LinearTolerance& tolerance, bool isFirst);
    bool findUnsolved(int iterations);
    void findSteps();
    void findRatios();
    double speedError() const;
    std::vector<Pack> lanesNotIndefinite() const;
    void sumDots(double Component::*to);
    Component& componentOf(int vertex) { return conjugate_[components_.of(vertex)]; }
    bool isActive(const PieceLanes& lanes) const;
    bool isAnyRowActive(int begin, int end) const;
    Pack scalarsOf(const PieceLanes& lanes, double Component::*which) const;
    void assembleFactored(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts);
    void assembleSums(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts);
    void findLinks();
    void addInertia(const NewtonPoint& at);
    void emptySharedRows();
    void addToDiagonal(int vertex, const Mat3& block);
    void addObstacles(std::span<const ObstacleContact> obstacles);
    bool addCoupling(int a, int b, const Mat3& block);
    Eigen::Map<Mat3> asBlock(int entry) { return Eigen::Map<Mat3>(cloth_.block(entry)); }
    void copyPairs(const ActiveContacts* contacts);
    void addContacts(const ActiveContacts& contacts);
    void layOutPairs(const ActiveContacts* contacts);
    void copyPair(const ActiveContacts& contacts, std::size_t i);
    std::size_t edgePacks() const;
    std::size_t slotOfPair(std::size_t i) const;
    bool isAnyActive(const PairPack& pairs);
    bool isInStrands(const ActiveContacts& contacts, std::size_t i, int which) const;
    HalfPack sumOfPairs(int vertex) const;
    void sortIncidence(const ActiveContacts* contacts);
    void holdPins();
    void copyByVertex(const double* p, int group);
    void applyPairs();
    void multiply();
    void multiplyStrands();
    void multiplyCloth();
    void applyLinks();
    void precondition();
    void preconditionCloth();
    void nextDirection();
    void findFreePieces();
    void weighFreePieces(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts);
    void balanceFreePieces();

    const Fabric& fabric_;
    Rods rods_;
    Shells shells_;
    VertexUnknowns unknowns_;
    StrandMatrix strands_;
    BlockMatrix cloth_;
    ClothPreconditioner clothFactor_;
    std::vector<char> ownsDiagonal_;                   ///< whether each row of cloth is on a strand: S has its diagonal block instead of K
    std::vector<int> clothRow_;                        ///< row of each vertex; −1 without cloth
    std::vector<Mat3> clothExtra_;                     ///< contact's part of the diagonal, for the preconditioner [dyn/cm]
    mutable AlignedArray<double> clothIn_, clothOut_;  ///< vectors by rows of cloth, 4 numbers each
    std::vector<Link> links_;

    /// A pair of a vertex.
    struct Incidence {
        int pair;   ///< number among the contacts
        int place;  ///< number of the vertex among the pair's
    };
    /// A vertex on a strand whose side of a pair is not in S but for its own diagonal, which is that block.
    struct UncoupledVertex {
        int vertex;
        Mat3 block;
    };

    std::vector<PairPack> pairs_;  ///< pairs of edges, and from a new pack on of vertices with faces
    std::size_t edgePairs_ = 0;    ///< pairs of edges among them
    std::vector<int> incidenceBegin_, cursor_;
    std::vector<Incidence> incidence_;  ///< incidences of each vertex, in the order of the pairs
    std::vector<UncoupledVertex> uncoupled_;
    AlignedArray<double> pairForce_;    ///< C p on each vertex of each pair, as in incidence_, 4 numbers each
    AlignedArray<double> pOfVertex_;    ///< p of each vertex, 4 numbers each
    std::vector<int> heldSlots_;        ///< slots of the unknowns that are pinned
    std::vector<double> heldGradient_;  ///< gradient of the pinned unknowns before it is removed [dyn, dyn cm]
    std::vector<int> freePieceOf_;      ///< each vertex's piece of cloth, if that hangs on no pin and no yarn; else −1
    std::vector<Mat3> pieceStiffness_;  ///< stiffness of each of these pieces, moved as a whole [dyn/cm]
    std::vector<Vec3> pieceForce_;      ///< what is left of the forces on it [dyn]

    FabricComponents components_;
    std::vector<Component> conjugate_;              ///< conjugate gradients of each component
    std::vector<double> pieceMass_, pieceAtFirst_;  ///< mass of each piece, with drag, less pins [g]; rᵀz per mass in the first iteration [erg/g]
    std::vector<PieceLanes> strandPieces_;          ///< pieces of each group of strands
    std::vector<PieceLanes> clothPieces_;           ///< pieces of kLanes vertices each that are on cloth only
    std::vector<int> runOfRow_, runPiece_;          ///< runs of rows of cloth, of one piece and in one range that is worked on together
    std::vector<Pack> laneDot_;                     ///< dot products of each group of strands
    std::vector<double> runDot_;                    ///< dot product of each run
    AlignedArray<double> gradient_, solution_, residual_, z_, p_, sp_, q_;
};

}  // namespace sim
