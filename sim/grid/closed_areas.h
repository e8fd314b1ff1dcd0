#pragma once

#include "sim/grid/open_faces.h"

#include <array>
#include <optional>

namespace sim {

/// What two solids have of a face's closed area [-]; where more close it the second has what those after it do.
struct FaceOcclusion {
    static constexpr int kNone = -1;
    int first = kNone, second = kNone;  ///< numbers of the solids
    double ofFirst = 0.0, ofSecond = 0.0;
};

/// Which solids close the faces of one block, where more than one is near. Of a place in several the one has it that cuts the face, not the one in
/// whose surface the face is: liquid at a piston ends at the cylinder around it, however deep that reaches into the piston.
class ClosedAreas {
 public:
    ClosedAreas(const BlockGrid& grid, int block, const Obstacles& obstacles);

    bool areShared() const { return count_ > 1; }
    /// Who closes the face normal to `axis` at the lower side of a cell.
    /// @param closed  area that all solids together close
    /// @param owner   the solid that has what none is found to close
    FaceOcclusion occlusion(int axis, const Vec3i& cell, double closed, int owner) const;

 private:
    static constexpr int kMost = 8;  ///< solids that are told apart: what others close is the nearest one's

    const BlockGrid& grid_;
    const Obstacles& obstacles_;
    Vec3 corner_;
    int count_ = 0;                                      ///< solids near, kMost at most
    std::array<int, kMost> solid_{};                     ///< numbers of the solids
    std::array<std::optional<OpenFaces>, kMost> faces_;  ///< open parts of the faces as if each solid were alone
};

}  // namespace sim
