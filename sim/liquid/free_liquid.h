#pragma once

#include "sim/liquid/pressure.h"

#include <vector>

namespace sim {

/// Pieces of liquid that nothing holds: what acts within them moves neither their centre of mass nor changes their momentum.
struct FreeLiquid {
    /// Liquid that is one component of the pressure system.
    struct Body {
        Vec3 mass = Vec3::Zero();  ///< of its faces, by axes [g]
        Vec3 sum = Vec3::Zero();   ///< of mass and value of the faces [g times the value's unit]
        bool isHeld = false;       ///< a solid is on one of its faces, or what else was told
    };
    BlockBits<3> unheld;        ///< faces on which there is nothing that holds liquid
    bool hasFabric = false;     ///< there is fabric on some faces …
    BlockBits<3> bare;          ///< … and these are the others
    std::vector<Body> bodies;   ///< by their number among all components
    std::vector<Body> ofBlock;  ///< sums over blocks that belong to one body
    /// What holds a body.
    struct Holder {
        Vec3 velocity = Vec3::Zero();  ///< its mean over the faces of the body that solids are on [cm/s]; until all are known, their sum
        int faces = 0;
    };
    std::vector<Holder> holders;   ///< of the bodies
    std::vector<Vec3> frames;      ///< velocities of what holds the liquid of each block, and of the next blocks where it has none [cm/s]
    BlockBits<> inHeld, inFree;    ///< cells of bodies that something holds, and of others
    BlockBits<> held;              ///< cells in and beside those that something holds, but not in others
    BlockArray<double, 3> change;  ///< of velocities, by what acts within the liquid [cm/s]
};

/// Faces that no solid closes, not even in part. The caller takes out those on which something else holds the liquid.
void findUnheldFaces(const CutGrid& cut, FreeLiquid& work);

/// Which bodies something holds, by `unheld`. Needs the components of the pressure's matrix.
void findHeldBodies(const BlockGrid& grid, const PressureWorkspace& pressure, const LiquidGrid& liquid, FreeLiquid& work);

/// From values on the faces of each free piece take the mean, by mass, of others: in sum over the piece, these then did nothing. What gradients
/// of a potential that is 0 around the piece do sums up to nothing by itself; of shortened ones, of those on faces that are taken to be fuller
/// than they are, and of the jumps of surface tension something is left.
/// @param others  on the faces, of values' unit; may be the values
void takeMeans(const BlockGrid& grid, const PressureWorkspace& pressure, const LiquidGrid& liquid, const BlockArray<double, 3>& others,
               FreeLiquid& work, BlockArray<double, 3>& values);

/// Once it is known which bodies are held: how fast that moves which holds them, by blocks. What flows past a solid that moves does so as
/// it would past the same solid at rest.
/// @param otherwise  velocity of what else holds bodies on which there is no solid [cm/s]
void findFrames(const CutGrid& cut, const PressureWorkspace& pressure, const LiquidGrid& liquid, const Vec3& otherwise, FreeLiquid& work);

/// Once it is known what holds which body: the cells of those that are held.
void findHeldCells(const BlockGrid& grid, const PressureWorkspace& pressure, const LiquidGrid& liquid, FreeLiquid& work);

}  // namespace sim
