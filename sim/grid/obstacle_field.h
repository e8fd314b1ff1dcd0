#pragma once

#include "sim/grid/closed_areas.h"
#include "sim/grid/face_fields.h"
#include "sim/grid/obstacles.h"
#include "sim/grid/room.h"

#include <span>
#include <vector>

namespace sim {

class OpenFaces;

/// Obstacles on the grid (grid/README.md, Solids on the grid): open fraction, room and velocity of faces, distance of cells. Blocks far from every
/// solid share one set of numbers; those of a block near a resting solid are computed when the block appears, and kept.
class ObstacleField {
 public:
    static constexpr double kExactDistance = 1.5;  ///< all solids that come this near to a block are known in it [cells]

    /// Follow the blocks of the grid and the motion of the obstacles.
    /// @param previous  number each block had at the last update, or BlockGrid::kNone
    /// @param mirrors   plane walls in planes of faces mirror the liquid (mirrorAtWalls): what is behind them counts as room
    void update(const BlockGrid& grid, std::span<const int> previous, const Obstacles& obstacles, bool mirrors);

    /// Whether walls mirror, as the last update was told: nothing of the liquid is left on the faces behind plane walls then.
    bool mirrors() const { return mirrors_; }

    bool nearSolid(int block) const { return slot_[block] != kOpenSlot; }
    /// The blocks for which nearSolid is true.
    const std::vector<int>& blocksNearSolid() const { return nearSolid_; }

    /// Open fraction of each lower face normal to `axis`, 0 … 1. Also for the empty block.
    const double* open(int block, int axis) const { return open_.block(slot_[block], axis); }
    /// Faces of open fraction 0.
    const std::uint64_t* closed(int block, int axis) const { return closed_.block(slot_[block], axis); }
    /// Faces of open fraction 1.
    const std::uint64_t* whole(int block, int axis) const { return whole_.block(slot_[block], axis); }
    /// Have all faces of a block that are not closed just as much room as is open of them?
    bool isEven(int block) const { return !isFolded_ && even_[slot_[block]] != 0; }
    /// Share of each lower face's B-spline that is outside the solids, 0 … 1: a face amid liquid carries that much of ρ dx³.
    /// After foldRoom with what has been added since.
    const double* room(int block, int axis) const { return (isFolded_ ? folded_ : room_).block(slot_[block], axis); }
    /// Until the next update or call, faces may have more room than their own: that of closed ones whose mass they take over.
    void foldRoom(bool isFolded);
    void addRoom(int block, int axis, int face, double room) { folded_.block(slot_[block], axis)[face] += room; }
    /// Cells all of whose faces are closed.
    const std::uint64_t* blocked(int block) const { return blocked_.block(slot_[block]); }
    /// Velocity of the obstacle at each lower face along `axis` [cm/s].
    const double* wallVelocity(int block, int axis) const { return wallVelocity_.block(anyMoved_ ? slot_[block] : kOpenSlot, axis); }
    /// What flows with the solids through what they close of each lower face: their velocities times the areas that they close, over that of the face
    /// [cm/s].
    const double* swept(int block, int axis) const { return swept_.block(anyMoved_ ? slot_[block] : kOpenSlot, axis); }
    /// Are two solids or more so near that they may close a face together?
    bool isShared(int block) const { return shared_[slot_[block]] != 0; }
    /// Who closes a face of a shared block.
    FaceOcclusion occlusion(int block, int axis, int face) const;
    /// Distance from the middle of each cell [cm], at most kExactDistance cells.
    const double* centerDistance(int block) const { return centerDistance_.block(slot_[block]); }
    /// Number of the solid that is nearest to the middle of each cell, where that is nearer than kExactDistance cells.
    const std::uint16_t* owner(int block) const { return owner_.block(slot_[block]); }

 private:
    static constexpr int kOpenSlot = 0;

    int takeSlot();
    void resizeSlots(int count);
    void makeOpenSlot(double dx);
    static bool isNear(const BlockGrid& grid, int block, const Obstacles& obstacles, Obstacles::Which which);
    void computeSlot(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, bool mirrors, RoomScratch& scratch);
    static bool isWallBetween(const BlockGrid& grid, const Obstacles& obstacles, const Vec3& center, double distance, int axis);
    void computeFaces(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const OpenFaces& faces);
    bool isSlotEven(int slot) const;
    void computeClosed(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles);
    void findBlocked(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const OpenFaces& faces);

    std::vector<int> slot_, oldSlot_;  ///< per block, the empty block included
    std::vector<int> nearSolid_;
    bool anyMoved_ = false;  ///< until then wallVelocity_ holds the open slot only
    std::vector<int> freeSlots_;
    std::vector<std::uint8_t> touchedByMoving_;  ///< per slot
    std::vector<int> toCompute_;                 ///< blocks
    std::vector<RoomScratch> roomScratch_;       ///< scratch of each worker
    int slotCount_ = 0;
    bool isFolded_ = false, mirrors_ = false, areSeveral_ = false;
    BlockArray<double, 3> open_, room_, folded_, wallVelocity_, swept_;
    BlockBits<3> closed_, whole_;
    BlockBits<> blocked_;
    BlockArray<double> centerDistance_;
    BlockArray<std::uint16_t> owner_;
    std::vector<std::uint8_t> shared_, even_;  ///< per slot
    BlockArray<std::uint16_t, 6> closer_;      ///< first and second solid that close each face of shared slots, where there is a second
    BlockArray<double, 3> ofSecond_;           ///< area that the second solid closes of each face of shared slots [-]
};

}  // namespace sim
