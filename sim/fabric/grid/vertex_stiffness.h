#pragma once

#include "sim/fabric/energies.h"
#include "sim/fabric/grid/twist_elimination.h"
#include "sim/fabric/rods/rods.h"
#include "sim/fabric/shells/shells.h"
#include "sim/fabric/solids/obstacle_contact.h"
#include "sim/fabric/vertex_unknowns.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace sim {

/// Forces on the vertices and twist angles and their Gauss-Newton derivatives K: rods, shells, the springs of pins (fabric/grid/README.md, Linear
/// system) and obstacles; where a step begins, or as they are elsewhere told by moves from there. Vectors are laid out by VertexUnknowns; what
/// shared vertices have in strands that do not own them is filled in by multiply.
class VertexStiffness {
 public:
    VertexStiffness(const Fabric& fabric, const FabricSettings& settings);
    VertexStiffness(const VertexStiffness&) = delete;  // step_ refers to its parts

    const Rods& rods() const { return rods_; }
    const Shells& shells() const { return shells_; }
    const VertexUnknowns& unknowns() const { return unknowns_; }

    /// Token that forces and K are assembled for a step, until it is assembled anew.
    class Assembled {
        friend VertexStiffness;
        Assembled() = default;
    };
    /// Elastic and viscous forces at the state, which is that at the start of the step, and pins where they are at time
    /// t + h [s]. The contacts with obstacles must be those of positions x + h v of the `predicted` velocities [cm/s].
    Assembled assemble(const FabricState& state, double t, double h, std::span<const ObstacleContact> obstacles, std::span<const Vec3> predicted);

    /// Assembles anew with the material's own forces as they are at `there`, which velocities u lead to in that step; relative to the start they
    /// are told nevertheless. `there` must stay until the next assemble.
    Assembled assembleAt(const Assembled&, const FabricState& there, double h, AlignedArray<double>& u);

    /// Energy gradient [dyn, dyn cm].
    const AlignedArray<double>& gradient() const { return gradient_; }
    /// out = K in, forces per displacement. `in` is completed for shared vertices.
    void multiply(AlignedArray<double>& in, AlignedArray<double>& out) const;
    /// Work of all forces on moves h u, −u·(h gradient + h² K u), in assemble's step of h [s]: of the material's internal forces, its damping,
    /// obstacles and pins. Elastic work is separate, as its energy stays in the fabric. Products afterwards are undamped, until the next
    /// assemble.
    struct Work {
        double elastic = 0.0, damping = 0.0, obstacles = 0.0, pins = 0.0;  ///< [erg]
    };
    Work work(double h, AlignedArray<double>& u);
    /// Work of pins and obstacles alone.
    Work workOfConstraints(double h, const AlignedArray<double>& u) const;
    /// Work of the material's internal forces and its damping alone, by the assembled gradient and K [erg].
    double internalWork(double h, AlignedArray<double>& u) const;
    /// Reaction impulses h gradient + h² K u of the constraints at velocities u of the vertices: calls onPin(number among Fabric::Pins, impulse),
    /// onEdge(held edge, impulse on its twist) and onObstacle(number among assemble's contacts, impulse).
    void forEachReaction(double h, const AlignedArray<double>& u, auto&& onPin, auto&& onEdge, auto&& onObstacle) const
    {
        for (std::size_t i = 0; i < springs_.size(); ++i) {
            const Spring& s = springs_[i];
            const Vec3 impulse = h * (s.gradient + h * (s.stiffness * atPoint(u, s)));
            if (i < pinStiffness_.size()) onPin(i, impulse);
            else onObstacle(i - pinStiffness_.size(), impulse);
        }
        for (std::size_t i = 0; i < heldEdges_.size(); ++i) {
            const double rate = u[unknowns_.twistSlot[heldEdges_[i]]];
            onEdge(heldEdges_[i], h * (heldTorque_[i] + h * heldStiffness_[i] * rate));
        }
    }
    /// Factors the equations of twist for steps of h [s].
    /// @param inertia  of each edge [g cm^2]
    void factorTwist(std::span<const double> inertia, double h);
    /// Back substitution: sets the rates of twist in u to those that the vertices' velocities bring about. u is completed for shared vertices.
    void backSubstituteTwist(AlignedArray<double>& u) const;
    /// Solves for the rates of twist under impulses on it, with the vertices at rest; in place.
    void solveTwist(AlignedArray<double>& u) const;

    Vec3 at(const AlignedArray<double>& u, int vertex) const
    {
        const double* p = u.data() + unknowns_.slot[vertex];
        return {p[0], p[kLanes], p[2 * kLanes]};
    }
    void set(AlignedArray<double>& u, int vertex, const Vec3& value) const
    {
        double* p = u.data() + unknowns_.slot[vertex];
        p[0] = value[0], p[kLanes] = value[1], p[2 * kLanes] = value[2];
    }
    void add(AlignedArray<double>& u, int vertex, const Vec3& value) const { set(u, vertex, at(u, vertex) + value); }

 private:
    /// A vertex in a strand that does not own it.
    struct Shared {
        int slot, ownerSlot;
    };
    /// What acts on a point: a vertex, or one of an edge or a face.
    struct Spring {
        std::array<int, 3> vertices;
        std::array<double, 3> shares;  ///< shares of the vertices in the point [-]
        Mat3 stiffness;                ///< [dyn/cm]
        Vec3 gradient;                 ///< gradient of the energy at the state [dyn]
    };
    void findShared();
    void findPinStiffness(const Fabric& fabric);
    void addToOwners(AlignedArray<double>& u) const;
    void copyFromOwners(AlignedArray<double>& u) const;
    void forEachGroup(AlignedArray<double>& u, auto&& body) const;
    void multiplyCloth(const AlignedArray<double>& in, AlignedArray<double>& out) const;
    void assembleInternal(const FabricState& at, double h);
    void addConstraints();
    void extrapolateToStart(double h);
    double workOfProduct(double h, const AlignedArray<double>& u) const;
    void multiplyInternal(AlignedArray<double>& in, AlignedArray<double>& out) const;
    void findPins(const FabricState& state, double end);
    /// Value at a spring's point of what the vertices have.
    Vec3 atPoint(const AlignedArray<double>& u, const Spring& s) const
    {
        return s.shares[0] * at(u, s.vertices[0]) + s.shares[1] * at(u, s.vertices[1]) + s.shares[2] * at(u, s.vertices[2]);
    }
    void addToPoint(AlignedArray<double>& u, const Spring& s, const Vec3& value) const
    {
        for (int k = 0; k < 3; ++k)
            if (s.shares[k] != 0.0) add(u, s.vertices[k], s.shares[k] * value);
    }

    const Fabric& fabric_;
    Rods rods_;
    Shells shells_;
    VertexUnknowns unknowns_;
    StrandMatrix strands_;
    TwistElimination twist_;
    BlockMatrix cloth_;
    mutable AlignedArray<double> clothIn_;  ///< product's input by rows of cloth, three numbers and 0 each
    std::vector<Shared> shared_;
    std::vector<Spring> springs_;       ///< springs, those of pins first
    std::vector<Vec3> restReference_;   ///< reference direction of each yarn edge at rest
    std::vector<double> pinStiffness_;  ///< stiffness of each pin [dyn/cm]
    std::vector<int> heldEdges_;
    std::vector<double> heldStiffness_;  ///< stiffness of each held edge's pin against twist [dyn cm]
    std::vector<double> heldTorque_;     ///< energy gradient of each held edge's pin at the state [dyn cm]
    AlignedArray<double> gradient_;
    std::optional<ElasticStep> step_;  ///< rods and shells in the step of the last assemble
    const FabricState* at_ = nullptr;  ///< state at which the internal forces are assembled
    AlignedArray<double> reached_;     ///< velocities that lead there in the step, by VertexUnknowns [cm/s, 1/s]
    mutable AlignedArray<double> product_;
};

}  // namespace sim
