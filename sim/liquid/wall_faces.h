#pragma once

#include "sim/liquid/slanted_walls.h"

#include <array>
#include <vector>

namespace sim {

/// The closed faces that particles reach, slaves of the open ones in front of them: u_c = E u_o + the wall's part. E carries the velocity past
/// the wall component by component: in each of three sweeps a face takes the mean of its known neighbours, times the share that friction
/// leaves; the component along the normal of a wall along the grid is the wall's own. E takes means, so its rows are positive and sum
/// to 1 at most. It acts transposed on what particles gave to the closed faces before the step (fold), and as it is after it (extend). Then, by
/// Cauchy and Schwarz, P_o^2 / M_o <= sum p^2 / m when masses and momenta fold to M_o and P_o, and sum m u^2 <= M_o u_o^2 when velocities
/// extend: walls never add energy, however little mass a face in front has.
class WallFaces {
 public:
    /// Find the closed faces with mass and their E, from the masses after P2G.
    void find(const CutGrid& cut, double friction, const FaceFields& faces);
    bool empty() const { return count_ == 0; }

    /// Moving walls and the part of the closed faces' liquid that follows them while the rest follows open faces: it gets their velocity.
    struct WallDriven {
        double work = 0.0;          ///< impulse of the walls on it, without that which holds its weight, times their velocity [erg]
        Vec3 heavy = Vec3::Zero();  ///< momentum that it gets, of what has weight [g cm/s]
        WallDriven operator+(const WallDriven& o) const { return {work + o.work, heavy + o.heavy}; }
    };
    /// Part that walls drive, from masses and momenta after find, before fold takes it off the faces. Faces that keep all of theirs are not in it.
    /// @param weightless  mass of each face whose weight nothing feels [g]
    WallDriven drivenByWalls(const ObstacleField& field, const FaceFields& faces, const BlockArray<double, 3>& weightless) const;
    WallDriven driven;  ///< part that walls drive in this step; nothing where all walls rest

    /// Move mass, momentum and room of the closed faces to those that they follow, and of the mass what nothing feels the weight of. What follows no
    /// open face keeps its own. Then open faces at slanted walls pass on what is more than their open part (SlantedWalls).
    /// @param weightless  as for drivenByWalls
    void fold(const CutGrid& cut, ObstacleField& field, FaceFields& faces, BlockArray<double, 3>& weightless);

    BlockBits<3> mirrored;  ///< faces that plane walls give a velocity to, one wall after another

    /// Give the closed faces their velocities [cm/s]; `valid` gets those that follow an open face.
    void extend(const CutGrid& cut, BlockBits<3>& valid, BlockArray<double, 3>& velocity);

 private:
    /// A face is at most three neighbours behind the last one in front of a wall in the stencil of a particle.
    static constexpr int kLayers = 3;
    /// A closed face with mass, and its velocity: `share` of what is carried past the wall, and of the wall's own the rest.
    struct Follower {
        std::uint16_t face;
        std::uint8_t axis;
        double share;  ///< [-], 0 … 1
    };
    /// Mass [g], momentum [g cm/s], room [-] and weightless mass [g] of the faces of one block that come from behind walls.
    static constexpr int kMass = 0, kMomentum = 3, kRoom = 6, kWeightless = 9, kFolded = 12;

    void findLayers(const CutGrid& cut, const FaceFields& faces);
    void findFollowers(const BlockGrid& grid, const Obstacles& obstacles, double friction, const FaceFields& faces);

    std::size_t count_ = 0;                         ///< number of followers
    std::array<BlockBits<3>, kLayers + 1> known_;   ///< faces with a velocity after so many sweeps; 0: open faces with mass
    std::vector<std::vector<Follower>> followers_;  ///< followers of each block near a solid
    ColoredBlocks near_;                            ///< blocks near a solid
    SlantedWalls slanted_;                          ///< open faces at walls that go slanted through the grid
    BlockArray<double, kFolded> folded_;            ///< what images fold onto the faces of each block near a solid
};

}  // namespace sim
