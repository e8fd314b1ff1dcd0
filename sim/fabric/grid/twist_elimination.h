#pragma once

#include "sim/fabric/rods/strand_matrix.h"

#include <span>
#include <vector>

namespace sim {

/// Elimination of twist from an implicit step: rates ω [1/s] with (I + h² K) ω = −h² K' u for velocities u of the vertices, K the
/// stiffness of the twist angles against each other, K' that against the vertices. It is tridiagonal along a strand.
class TwistElimination {
 public:
    /// Factors I + h² K.
    /// @param inertia   of each yarn edge [g cm^2]
    /// @param stiffness of the rows of the strands [dyn/cm, dyn, dyn cm]
    /// @param held      what holds each edge besides [dyn cm]
    void factor(const StrandLayout& layout, const StrandMatrix& stiffness, std::span<const double> inertia, std::span<const double> held, double h);
    /// Back substitution: sets the rates in the rows of group g to ω for the vertices' velocities there.
    void backSubstitute(std::size_t g, Pack* rows) const;
    /// Applies (I + h² K)⁻¹ to impulses in the rows of group g, in place.
    void solve(std::size_t g, Pack* rows) const;

 private:
    const StrandLayout* layout_ = nullptr;
    const StrandMatrix* stiffness_ = nullptr;
    double h2_ = 0.0;                    ///< h² [s^2]
    std::vector<Pack> lower_, inverse_;  ///< factors L D Lᵀ of the matrix at each packed edge
};

}  // namespace sim
