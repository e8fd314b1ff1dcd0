#pragma once

#include "sim/fabric/grid/block_points.h"
#include "sim/fabric/grid/contact_push.h"
#include "sim/fabric/grid/element_contact.h"
#include "sim/fabric/grid/vertex_stiffness.h"

#include <vector>

namespace sim {

/// The pressed elements of one kind as products with the system's matrix want them: packed in the order of the blocks.
/// Contact is EdgeContact<Pack> or FaceContact<Pack>.
template <class Contact>
class PressedElements {
 public:
    static constexpr int kCorners = Contact::kCorners, kDirections = Contact::kDirections;
    using Directions = PointArray<3 * kDirections>;

    /// @param firstPush  where this kind's pushes begin in the array of all
    void assemble(const ElementContact& contact, const VertexStiffness& stiffness, const BlockPoints& elements, const std::vector<Mat3>& missing,
                  double dx, int firstPush);

    const BlockPoints& points() const { return points_; }
    std::size_t pushes() const { return kCorners * points_.size(); }
    /// first[e] = an element's first push.
    void tellPushes(std::vector<int>& first) const
    {
        for (std::size_t s = 0; s < points_.size(); ++s) first[points_.id[s]] = firstPush_ + kCorners * static_cast<int>(s);
    }
    /// Directions across over the cell size [1/cm].
    const Directions& across() const { return across_; }
    /// How the grid carries the directions [1/s]; then the stresses that the faces feel.
    Directions& carried() { return carried_; }

    /// From how the grid carries the directions and the moves of the vertices to what the elements push with: in carried
    /// and `pushes`.
    void multiply(const AlignedArray<double>& moves, std::vector<Vec3>& pushes);
    /// What the elements push with by themselves: minus the energy gradient.
    void impulses(const ElementContact& contact, std::vector<Vec3>& pushes);

 private:
    using Across = typename Contact::Across;
    using Corners = typename Contact::Corners;
    /// An element that reaches faces without mass.
    struct Loose {
        std::array<double, kCorners> share;
        std::array<Vec3, kDirections> missing;  ///< how a 1 on faces with mass carries the directions [1/cm]
    };
    Across carriedAt(std::size_t pack, const Corners& u) const;
    void store(std::size_t pack, const Across& stress, Corners onCorners, std::vector<Vec3>& pushes);
    void lanesOf(std::size_t pack, auto&& body) const;

    int firstPush_ = 0;
    BlockPoints points_;
    Directions across_, carried_;
    std::vector<Contact> contact_;                       ///< of each pack
    std::vector<std::array<int, kCorners>> cornerSlot_;  ///< of each element: in a vector of VertexUnknowns
    std::vector<int> loose_;                             ///< of each element: in looseElements_, or −1
    std::vector<char> anyLoose_;                         ///< of each pack
    std::vector<Loose> looseElements_;
};

}  // namespace sim
