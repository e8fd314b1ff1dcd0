#pragma once

#include "sim/core/units.h"
#include "tests/sim/fabric/solids/solid_crossings.h"

namespace sim::testing {

/// A solid anywhere about the origin, turned: thin, pointed or round.
inline ObstacleSettings anySolid(Noise& noise)
{
    ObstacleSettings solid;
    const int kind = static_cast<int>(2.5 * (1.0 + noise()));
    const double size = 0.6 + 0.4 * noise();
    if (kind == 0) solid.shape = Shape::box(Vec3::Zero(), {size, 0.01, size});
    if (kind == 1) solid.shape = Shape::box(Vec3::Zero(), {0.01, size, 0.02});
    if (kind == 2) solid.shape = Shape::capsule({0.0, -size, 0.0}, {0.0, size, 0.0}, 0.03);
    if (kind == 3) solid.shape = Shape::ball(Vec3::Zero(), 0.5 * size);
    if (kind >= 4)
        solid.shape =
            Shape::subtract({Shape::box(Vec3::Zero(), Vec3::Constant(size)), Shape::box({0.0, 0.1, 0.0}, {size - 0.05, size, size - 0.05})});
    const Vec3 axis = noise.vector().normalized();
    solid.shape = solid.shape.moved(Eigen::Isometry3d(Eigen::AngleAxisd(kPi * noise(), axis)));
    return solid;
}

inline FabricPiece anyFabric(Noise& noise)
{
    FabricPiece piece;
    if (noise() < 0.3) {
        ClothGrid grid;
        grid.nodes = Vec2i(9, 9);
        const double pitch = 0.12 + 0.08 * noise();
        grid.spacing = {pitch, pitch};
        piece = pieceOf(clothGrid(grid), wool(), {0.0165, 0.0165});
        piece.material.poisson = 0.2;
    } else {
        piece = pieceOf(strand(Vec3(-0.8, 0.0, 0.1 * noise()), Vec3(0.8, 0.1 * noise(), 0.0), 12), wool(), {0.03, 0.03});
    }
    return piece;
}

inline void moveTo(FabricPiece& piece, const Vec3& middle, const Mat3& turn)
{
    Vec3 mean = Vec3::Zero();
    for (const Vec3& x : piece.points) mean += x / static_cast<double>(piece.points.size());
    for (Vec3& x : piece.points) x = middle + turn * (x - mean);
}

/// Fabric in front of a solid that goes through it, if nothing keeps it from that.
struct Encounter {
    explicit Encounter(unsigned seed, double speed)
    {
        Noise noise(seed);
        solid = anySolid(noise);
        const Mat3 turn = Eigen::AngleAxisd(kPi * noise(), noise.vector().normalized()).toRotationMatrix();
        FabricPiece piece = anyFabric(noise);
        const Vec3 way = noise.vector().normalized();
        moveTo(piece, Vec3::Zero(), turn);
        // Out of the solid along the way, until no vertex or middle is within it.
        for (double ahead = 0.0; clearance(assembleFabric({&piece, 1}), piece.points, solid.shape) < 0.1; ahead += 0.05)
            moveTo(piece, ahead * way, turn);
        solid.motion.addTranslation(0.0, 1.0, 0.5 * speed * way + 0.1 * speed * noise.vector(), 0.0, 0.0);
        solid.motion.addRotation(0.0, 1.0, {noise.vector().normalized(), Vec3::Zero(), Motion::Frame::Local}, 20.0 * noise(), 0.0, 0.0);
        piece.velocity = -0.5 * speed * way;
        pieces = {piece};
    }
    ObstacleSettings solid;
    std::vector<FabricPiece> pieces;
};

}  // namespace sim::testing
