#pragma once

#include "sim/fabric/grid/block_points.h"
#include "sim/fabric/grid/contact_response.h"
#include "sim/fabric/grid/element_contact.h"
#include "sim/fabric/grid/vertex_stiffness.h"

#include <vector>

namespace sim {

/// Elements of one kind whose contact is active, laid out for products with the system's matrix: packed in the order of the blocks.
/// @tparam Contact  EdgeContact<Pack> or FaceContact<Pack>
template <class Contact>
class ActiveElements {
 public:
    static constexpr int kCorners = Contact::kCorners, kDirections = Contact::kDirections;
    using Directions = PointArray<3 * kDirections>;

    /// @param missing     of each element: ∇u of a 1 on faces with mass, times the cell size; 0 where all faces have mass [-]
    /// @param dx          cell size [cm]
    /// @param firstForce  index of this kind's first force in the array of all nodal forces
    void assemble(const ElementContact& contact, const VertexStiffness& stiffness, const BlockPoints& elements, const std::vector<Mat3>& missing,
                  double dx, int firstForce);

    const BlockPoints& points() const { return points_; }
    /// Number of nodal forces: one for each corner of each element.
    std::size_t forceCount() const { return kCorners * points_.size(); }
    /// Sets first[e] to the index of the first nodal force of element e, for all elements of these.
    void listFirstForces(std::vector<int>& first) const
    {
        for (std::size_t s = 0; s < points_.size(); ++s) first[points_.id[s]] = firstForce_ + kCorners * static_cast<int>(s);
    }
    /// Material directions across the fabric, d, over the cell size [1/cm].
    const Directions& across() const { return across_; }
    /// Rates of the directions on the grid, G d [1/s]: the input of multiply, which is overwritten by stresses.
    Directions& directionRates() { return rateOrStress_; }
    /// Stresses on the faces [erg/s, or erg]: the output of multiply and impulses.
    const Directions& stresses() const { return rateOrStress_; }

    /// Product of contact's Hessian with a motion, in place: directionRates() become stresses().
    /// @param moves        velocities of the vertices, by VertexUnknowns [cm/s]
    /// @param nodalForces  out: forces of the elements on their corners
    void multiply(const AlignedArray<double>& moves, std::vector<Vec3>& nodalForces);
    /// Stresses and nodal forces at the state itself: minus the energy gradient.
    void impulses(const ElementContact& contact, std::vector<Vec3>& nodalForces);

 private:
    using Across = typename Contact::Across;
    using Corners = typename Contact::Corners;
    /// An element whose stencil reaches faces without mass.
    struct PartialStencil {
        std::array<double, kCorners> share;     ///< share of each corner in the quadrature point [-]
        std::array<Vec3, kDirections> missing;  ///< rate of the directions for a 1 on faces with mass [1/cm]
    };
    Across ratesAt(std::size_t pack, const Corners& u) const;
    void store(std::size_t pack, const Across& stress, Corners nodalResponse, std::vector<Vec3>& nodalForces);
    void lanesOf(std::size_t pack, auto&& body) const;

    int firstForce_ = 0;
    BlockPoints points_;
    Directions across_, rateOrStress_;
    std::vector<Contact> contact_;                       ///< contact of each pack
    std::vector<std::array<int, kCorners>> cornerSlot_;  ///< slots of each element's corners in a vector of VertexUnknowns
    std::vector<int> partial_;                           ///< place of each element in partialElements_, or −1
    std::vector<char> anyPartial_;                       ///< whether each pack has any in partialElements_
    std::vector<PartialStencil> partialElements_;
};

}  // namespace sim
