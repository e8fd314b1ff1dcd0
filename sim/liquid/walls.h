#pragma once

#include "sim/liquid/wall_faces.h"

namespace sim {

/// Give the closed faces what the walls demand (liquid/README.md, Walls): with friction c, the obstacle's velocity plus (1 − c) of the
/// liquid's relative velocity along the wall, as far as the liquid in front reaches. Behind plane walls that lie in planes of faces it is the
/// mirror image of the liquid in front instead: the normal component odd about the wall, the tangential ones even.
/// @param goesStraight  at walls that liquid sticks to its velocity along them goes on behind them as in front, through that of the wall where
///               the wall is: what particles near it read is then a straight profile, not one bent towards the face behind
/// @param valid  in: the faces in front with a velocity; out: those behind that got one, too
void applyWalls(const CutGrid& cut, double friction, bool goesStraight, WallFaces& followers, BlockBits<3>& valid, BlockArray<double, 3>& velocity);

/// Distance of the lower face of a cell from the obstacles, at most 1.5 cells [cm].
double faceDistance(const CutGrid& cut, int block, int axis, Vec3i cell);

/// Where a wall stands between the open lower face of a cell and the closed one of the cell beside it: share of the way from the open one, (0, 1].
/// No nearer than a tenth: less only hurts the conditioning.
double wallReach(const CutGrid& cut, int block, int axis, const Vec3i& cell, const Vec3i& beside);

/// Do plane walls in planes of faces mirror the liquid? Only where it slips along them.
inline bool usesMirrorBoundary(double friction) { return friction < 1.0; }

/// After P2G: what particles gave to faces behind plane walls in planes of faces goes to the images of these faces in front, as if every
/// particle had its mirror image behind the wall. Without it the faces next to a wall know only half of the liquid around them.
/// @param weightless  mass of each face whose weight nothing feels: images are pulled the other way along the wall's normal [g]
void mirrorAtPlaneWalls(const BlockGrid& grid, const Obstacles& obstacles, FaceFields& faces, BlockArray<double, 3>& weightless);

/// After P2G: mirrors at all walls along which liquid slips. What is behind plane ones goes to images (mirrorAtPlaneWalls), behind others to the
/// faces that it will follow (WallFaces), with its room.
void mirrorAtWalls(const BlockGrid& grid, const Obstacles& obstacles, double friction, ObstacleField& field, WallFaces& followers,
                   LiquidGrid& liquid);

/// After dt of weight on all that faces carry: take back what it did to the weightless part. Then weight does on the faces the work that it does
/// on the particles, which read the velocities of applyWalls: sum (m_f - weightless) g u_f = sum m_p g v_p, where no wall has friction. Along walls
/// that do it acts evenly all the same, for only so can a pressure hold it: friction takes from the particles' motion after it.
void withholdWeightOfImages(const ObstacleField& field, const Vec3& gravity, double dt, LiquidGrid& liquid);

/// Deep faces next to a plane wall bear the same share of their weight. What images hold of it goes by the places of the particles, and is less where
/// another solid stands on the wall; the pressures in the cells at the wall would differ by that, and turn liquid at rest for ever. Together they
/// bear what they did.
/// @param gravityStep  velocity that weight has given to all faces in this step [cm/s]
/// @param bare         faces without fabric, which keep what they have; null if all are
void levelWeightOfImages(const CutGrid& cut, const BlockBits<3>* bare, const Vec3& gravityStep, LiquidGrid& liquid);

}  // namespace sim
