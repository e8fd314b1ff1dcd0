#pragma once

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/fabric/grid/active_elements.h"
#include "sim/fabric/grid/element_contact.h"
#include "sim/fabric/grid/fabric_particles.h"
#include "sim/fabric/grid/vertex_stiffness.h"
#include "sim/fabric/liquid_loads.h"

#include <span>
#include <vector>

namespace sim {

/// Unknowns of the implicit step: velocities of the faces that have mass [cm/s], rates of the twist angles [1/s].
struct FaceVector {
    BlockArray<double, 3> faces;
    AlignedArray<double> twist;  ///< value of each yarn edge, up to a whole pack

    void resize(int blocks, std::size_t edges)
    {
        faces.resize(blocks);
        twist.resize((edges + kLanes - 1) / kLanes * kLanes);
    }
    /// The pack of faces, or of twist angles, that begins at entry i.
    Pack& pack(bool isFace, std::size_t i) { return *reinterpret_cast<Pack*>((isFace ? faces.block(0) : twist.data()) + i); }
    const Pack& pack(bool isFace, std::size_t i) const { return *reinterpret_cast<const Pack*>((isFace ? faces.block(0) : twist.data()) + i); }
};

/// Stopping criterion of a linear solve on the faces.
struct FaceTolerance {
    double target;         ///< rms error at which the first iterations stop [cm/s]
    int targetIterations;  ///< iterations for which that holds
    double acceptable;     ///< rms error at which later iterations stop [cm/s]
    int maxIterations;
    double after(int iterations) const { return iterations < targetIterations ? target : acceptable; }
};

/// A linear solve on the faces.
struct FaceSolveReport {
    int iterations = 0;
    double speedError = 0.0;  ///< rms in the norm of the system's matrix, weighted by mass; not below what it is [cm/s]
    double errorWork = 0.0;   ///< work of the impulses missing to the balance of forces on the velocities found [erg]
};

/// The linear system of one implicit step on the grid (fabric/grid/README.md, Linear system): A = M + h² (Wᵀ K W + Gᵀ H G), with K
/// the stiffness of the vertices and H that of contact at the elements, W and G the interpolation of velocities and
/// their gradients, matrix-free. Faces that elements reach but no vertex does, or hardly, have no mass or hardly any; elements take
/// them to move as they do themselves.
class FaceSystem {
 public:
    FaceSystem(const Fabric& fabric, VertexStiffness& stiffness, const ElementContact& contact);

    /// Sets the liquid that the yarns hold, which adds to the inertia of their twist.
    /// @param absorbed  of each vertex [g]
    void setAbsorbed(std::span<const double> absorbed);
    /// Token that masses and weights are those of a step, until the next begins.
    class Begun {
        friend FaceSystem;
        Begun() = default;
    };
    /// Takes masses and weights from what toFaces left.
    /// @param loads  of liquid, whose drag then counts as mass; or null
    Begun begin(const FabricParticles& particles, double h, const FaceLoads* loads = nullptr);
    /// Takes stiffness and contact, which stay so until the solve is done.
    void assemble(const Begun&, const VertexStiffness::Assembled&, const ElementContact::Assembled&);

    std::size_t edges() const { return fabric_.edges.size(); }
    int blocks() const { return grid_->count(); }
    const BlockArray<double, 3>& mass() const { return mass_; }

    /// q = A p. Entries of p at faces without mass must be 0.
    void multiply(const FaceVector& p, FaceVector& q);
    /// −h times the energy gradient by the unknowns' displacements: impulses of the forces at the start of the step.
    void impulses(FaceVector& q);
    /// A v = M v0 + impulses by conjugate gradients, preconditioned by the masses, from v = v0 on, with twist
    /// eliminated: it follows the faces. Stops when the error is within the tolerance.
    /// @param expected  a change of the faces' velocities, of which the solve starts with the multiple that comes
    ///                  nearest to the solution in A's norm; or null
    FaceSolveReport solve(const FaceTolerance& tolerance, FaceVector& v, const BlockArray<double, 3>* expected = nullptr);

    /// Restores the momentum of each group of blocks to that of its start and the impulses, by one change of velocity for all its faces. The
    /// fabric's own forces do not change it, but the residual that iterations leave does.
    /// @param start         velocities that the last solve started from [cm/s]
    /// @param groupOfBlock  below `groups`; −1 for blocks that are left alone
    void balanceMomentum(const BlockArray<double, 3>& start, std::span<const int> groupOfBlock, int groups, FaceVector& v);

    /// Interpolates u to the vertices: their velocities, with the rates of twist [cm/s, 1/s], laid out by VertexUnknowns.
    AlignedArray<double>& vertexVelocities(const FaceVector& u);
    /// Energy that contact gives to moves h u in the step of assemble, by its stress at the state and its stiffness
    /// [erg].
    double contactWork(const FaceVector& u);
    /// u at the vertices.
    void gatherVertices(const BlockArray<double, 3>& u, std::span<Vec3> atVertices);
    /// What u does to vertices and elements, those without full stencils as in multiply.
    void findMotion(const Begun&, const BlockArray<double, 3>& u, FabricMotion& motion);

 private:
    void clearInactive(BlockArray<double, 3>& u) const;
    void gatherElements(const BlockArray<double, 3>& u, std::vector<Mat3>& gradients);
    void findMissingParts();
    void clearSmallMasses(std::size_t n, FaceTile& tile) const;
    void findNodalForces();
    void gather(const BlockArray<double, 3>& u);
    void spread(FaceVector& q);
    double applySchurComplement(FaceVector& p, FaceVector& q);
    double completeProduct(const FaceVector& p, FaceVector& q);
    void solveTwist(const FaceVector& residual, FaceVector& p);
    void startSolve(FaceVector& v);
    void projectInitialGuess(const BlockArray<double, 3>& expected, FaceVector& v);
    Pack mass(bool isFace, std::size_t i) const { return loadPack((isFace ? mass_.block(0) : inertia_.data()) + i); }
    /// Calls body(active elements of one kind) for edges and for faces.
    void forEachActive(auto&& body)
    {
        body(activeEdges_);
        body(activeFaces_);
    }
    /// body(e, slot of its twist in a vector of VertexUnknowns), in parallel.
    void forEachTwist(auto&& body) const
    {
        const std::vector<int>& slot = stiffness_.unknowns().twistSlot;
        parallelFor(edges(), 4096, [&](std::size_t e) { body(e, slot[e]); });
    }
    template <class Body>
    double forEachPack(Body&& body) const;
    double forEachFacePack(auto&& body) const
    {
        return forEachPack([&](auto isFace, std::size_t i, Pack& sum) {
            if constexpr (isFace) body(i, sum);
        });
    }

    const Fabric& fabric_;
    VertexStiffness& stiffness_;
    const ElementContact& contact_;
    const FabricParticles* particles_ = nullptr;
    const BlockGrid* grid_ = nullptr;
    double h_ = 0.0;  ///< [s]

    BlockArray<double, 3> mass_;    ///< mass of each face with the liquid's drag [g]
    AlignedArray<double> inertia_;  ///< inertia of each twist angle; 1 in unused lanes [g cm^2]
    double totalMass_;              ///< [g]
    FaceRows rows_;

    BlockArray<double, 3> actsOnElements_;  ///< 1 at each face with enough mass to act on elements, else 0 [-]
    std::vector<char> hasSmallMasses_;      ///< whether each occupied block has faces with less mass than that, but some
    std::vector<Mat3> missing_;             ///< gradient at each element of a 1 on faces that act on it; 0 if all do [-]
    ActiveElements<EdgeContact<Pack>> activeEdges_;
    ActiveElements<FaceContact<Pack>> activeFaces_;
    std::vector<Vec3> nodalForces_;          ///< forces of the active elements on their corners
    std::vector<int> forceBegin_, forceOf_;  ///< nodal forces on each vertex, in the order of the blocks, as indices in nodalForces_
    PointArray<3> onVertices_;               ///< values on each vertex, in the order of the blocks
    PointArray<9> onElements_;
    std::vector<int> first_;         ///< index of each element's first nodal force
    AlignedArray<double> in_, out_;  ///< input and output of the stiffness's product, by vertex unknowns
    BlockArray<double, 3> work_;
    FaceVector residual_, p_, q_;      ///< vectors of the solve
    std::vector<Vec3> left_, moving_;  ///< sum of each group's residuals [g cm/s] and of its masses [g]
};

/// Sum over body(isFace, i, sum) for the packs at i of faces with mass, and of twist.
template <class Body>
double FaceSystem::forEachPack(Body&& body) const
{
    const std::size_t faces = rows_.first.size();
    const Chunks chunks(faces + inertia_.size() / kLanes);
    std::array<Pack, kMaxChunks> partial;
    parallelFor(chunks.count(), [&](std::size_t c) {
        Pack sum{};
        for (std::size_t r = chunks.begin(c); r < std::min(chunks.end(c), faces); ++r)
            body(std::true_type(), static_cast<std::size_t>(rows_.first[r]), sum);
        for (std::size_t r = std::max(chunks.begin(c), faces); r < chunks.end(c); ++r) body(std::false_type(), (r - faces) * kLanes, sum);
        partial[c] = sum;
    });
    Pack all{};
    for (std::size_t c = 0; c < chunks.count(); ++c) all += partial[c];
    return sumLanes(all);
}

}  // namespace sim
