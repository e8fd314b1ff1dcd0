#pragma once

#include "sim/core/aligned_array.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/rods/strand_matrix.h"
#include "sim/fabric/vec3t.h"
#include "sim/settings.h"

#include <array>
#include <span>
#include <vector>

namespace sim {

/// All yarns as discrete elastic rods, side by side in packs. What is constant in a run is built once; the strains at the start of a
/// step, against which the damping acts, are noted by startStep, which forces are to be had from.
class Rods {
 public:
    Rods() = default;
    /// The rest shape, also of the frames, is that of `rest` (restState of the fabric).
    Rods(const Fabric& fabric, const FabricState& rest, const FabricSettings& settings);

    const StrandLayout& layout() const { return layout_; }
    bool empty() const { return layout_.groups.empty(); }

    /// Carries tangents, reference frames and reference twists along to the present positions (fabric/rods/README.md, Kinematics).
    void transportFrames(FabricState& state) const;
    /// The rods in a step whose start they know, until the next startStep.
    class Step {
     public:
        const Rods& rods() const { return *rods_; }
        /// Gradient of the elastic and viscous energy at the present positions, whose frames are up to date, added to `gradient` (laid out
        /// as StrandLayout, [dyn] and [dyn cm]); if a matrix is given, its Gauss-Newton Hessian, with the tensile part of the stretching's
        /// geometric stiffness and with what opposes the turning of straightened yarns, replaces what the matrix held. h: length of the step
        /// [s], read by the damping only.
        void forces(const FabricState& state, double h, std::span<Pack> gradient, StrandMatrix* matrix) const
        {
            rods_->forces(state, h, gradient, matrix);
        }

     private:
        friend Rods;
        explicit Step(const Rods& rods) : rods_(&rods) {}
        const Rods* rods_;
    };
    /// Notes the state's lengths, curvatures and twists, if anything is damped.
    Step startStep(const FabricState& state);

    /// From now on the matrix has the torque's part too, the second derivatives of the twist: without it Newton overshoots on rods
    /// that are twisted hard. It may be indefinite.
    void includeTwistHessian();
    /// Rods that have a 0 in `keep`, of each group as in StrandMatrix::definite, lose that part again.
    void excludeTwistHessian(const std::vector<Pack>& keep);
    /// Elastic energy [erg]: stretching, bending, twisting.
    std::array<double, 3> energies(const FabricState& state) const;

 private:
    struct InnerVertex;
    void forces(const FabricState& state, double h, std::span<Pack> gradient, StrandMatrix* matrix) const;
    /// @param gradient  rows of the group
    /// @param band      rows of its Hessian; empty without
    void addStretching(int g, const FabricState& state, double h, std::span<Pack> gradient, std::span<Pack> band) const;
    void addBendingAndTwisting(int g, const FabricState& state, double h, std::span<Pack> gradient, std::span<Pack> band) const;
    template <class Visit>
    void forEachInnerVertex(int g, const FabricState& state, Visit&& visit) const;

    /// One per group: of each of its strands, with the packing factor.
    struct Stiffness {
        Pack stretch;                                    ///< χ k_s [dyn]
        Pack bend00, bend01, bend11;                     ///< χ B [dyn cm^2]
        Pack twist;                                      ///< χ k_t [dyn cm^2]
        Pack stretchDamping, bendDamping, twistDamping;  ///< time by which the rate of strain counts: 3η/E, η/G [s]
    };
    /// One per packed vertex that has an edge on either side.
    struct Bend {
        Pack perLength;                 ///< 1 / Voronoi length; 0 in unused lanes [1/cm]
        std::array<Pack, 4> curvature;  ///< curvatures at rest [-]
    };

    StrandLayout layout_;
    std::vector<Stiffness> stiffness_;
    std::vector<Pack> perRestLength_;  ///< inverse rest length of each packed edge; 0 in unused lanes [1/cm]
    std::vector<Bend> bends_;
    bool damped_ = false;
    std::vector<Pack> startStretch_;              ///< l / l̄ of each packed edge
    std::vector<Pack> twistHessianShare_;         ///< per group: 1 in lanes of rods whose torque has its part in the matrix, else 0
    std::vector<std::array<Pack, 5>> startBend_;  ///< curvatures and twist of each packed vertex
};

}  // namespace sim
