#pragma once

#include "sim/core/simd.h"
#include "sim/fabric/contact/points.h"

#include <bit>
#include <span>
#include <vector>

namespace sim::contact {

/// Where all vertices are, and how far they are about to move from there [cm].
struct Sweep {
    Points from, move;
};

/// Around a primitive, or some, and all the places where a partner could touch them; and around their displacements. Single precision,
/// rounded outwards [cm].
struct SweptBox {
    std::array<float, 3> lo, hi, moveLo, moveHi;
};

/// Sixteen of them, to be looked at together.
struct SweptBoxes {
    std::array<FloatPack, 3> lo, hi, moveLo, moveHi;

    void set(int lane, const SweptBox& box);
    SweptBox box(int lane) const;
    /// The smallest box around the lanes whose bits are set.
    SweptBox around(unsigned lanes) const;

    /// Bit l of the result: may `box` and lane l meet while both move? Common motion of the two cancels.
    [[gnu::always_inline]] unsigned touching(const SweptBox& box) const
    {
        FloatMask meet = firstFloatLanes(kFloatLanes);
        for (std::size_t k = 0; k < 3; ++k) {
            const FloatPack nearer = box.moveLo[k] - moveHi[k], further = box.moveHi[k] - moveLo[k];
            const FloatPack zero = {};
            const FloatPack least = (box.lo[k] - hi[k]) + (nearer < zero ? nearer : zero);
            const FloatPack most = (box.hi[k] - lo[k]) + (further > zero ? further : zero);
            meet &= (least <= zero) & (most >= zero);
        }
        return floatMaskBits(meet);
    }
};

/// Boxes of primitives of one kind in a tree that never changes: sixteen to a group, in Morton order of the rest shape.
class BoxTree {
 public:
    BoxTree() = default;
    /// @param corners  vertices of all primitives, `perPrimitive` each
    /// @param reach    of each primitive: partners meet when their boxes do, grown by the reach of both [cm]
    BoxTree(std::vector<int> corners, int perPrimitive, std::span<const Vec3> rest, std::vector<double> reach);

    bool empty() const { return order_.empty(); }
    /// Boxes around the swept points; primitives of dirty vertices become dirty themselves.
    void refit(const Sweep& sweep, std::span<const char> dirtyVertices);

    /// Leaf groups hold the primitives; bit l of a mask is lane l.
    int leaves() const { return levels_.empty() ? 0 : static_cast<int>(levels_[0].size()); }
    const SweptBoxes& leaf(int i) const { return levels_[0][i]; }
    int primitive(int leaf, int lane) const { return order_[leaf * kFloatLanes + lane]; }
    unsigned lanes(int leaf) const;
    unsigned dirtyLanes(int leaf) const { return dirty_[leaf]; }

    /// visit(leaf group) for all in reach of the box.
    template <class Visit>
    void forEachLeafNear(const SweptBox& box, Visit&& visit) const
    {
        if (levels_.size() == 1) return visit(0);
        if (levels_.size() > 1) descend(box, static_cast<int>(levels_.size()) - 1, 0, visit);
    }

 private:
    template <class Visit>
    void descend(const SweptBox& box, int level, int group, Visit& visit) const
    {
        for (unsigned bits = levels_[level][group].touching(box); bits != 0; bits &= bits - 1) {
            const int child = group * kFloatLanes + std::countr_zero(bits);
            if (level == 1) visit(child);
            else descend(box, level - 1, child, visit);
        }
    }
    void refitLeaf(const Sweep& sweep, std::span<const char> dirtyVertices, int leaf);

    int perPrimitive_ = 0;
    std::vector<int> corners_;                     ///< in the order of the tree
    std::vector<int> order_;                       ///< primitives
    std::vector<double> reach_;                    ///< in the order of the tree
    std::vector<std::vector<SweptBoxes>> levels_;  ///< leaf groups first; lanes of a level are the groups of the one before
    std::vector<unsigned> dirty_;                  ///< lanes of each leaf
};

}  // namespace sim::contact
