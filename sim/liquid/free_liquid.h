#pragma once

#include "sim/liquid/pressure.h"

#include <vector>

namespace sim {

/// Pieces of liquid that nothing holds: what acts within them moves neither their centre of mass nor changes their momentum.
struct FreeLiquid {
    /// Liquid that is one component of the pressure system.
    struct Body {
        Vec3 mass = Vec3::Zero();  ///< mass of its faces, by axes [g]
        Vec3 sum = Vec3::Zero();   ///< sum of mass times value over its faces [g times the value's unit]
        bool isHeld = false;       ///< a solid is on one of its faces, or what else was told
    };
    BlockBits<3> unheld;        ///< faces on which there is nothing that holds liquid
    bool hasFabric = false;     ///< whether any face is shared with fabric
    BlockBits<3> bare;          ///< faces not shared with fabric
    std::vector<Body> bodies;   ///< pieces by their number among all components
    std::vector<Body> ofBlock;  ///< sums over blocks that belong to one body
    /// What holds a body.
    struct Holder {
        Vec3 velocity = Vec3::Zero();  ///< mean over the faces of the body that solids are on; until all are known, their sum [cm/s]
        int faces = 0;
    };
    std::vector<Holder> holders;   ///< holders of the bodies, by number
    std::vector<Vec3> frames;      ///< velocities of what holds the liquid of each block, and of the next blocks where it has none [cm/s]
    BlockBits<> inHeld, inFree;    ///< cells of bodies that something holds, and of others
    BlockBits<> held;              ///< cells in and beside those that something holds, but not in others
    BlockArray<double, 3> change;  ///< change of velocities by what acts within the liquid [cm/s]
};

/// Token that the faces are known on which nothing holds the liquid, until the next findUnheldFaces in the same workspace.
class UnheldFaces {
    friend UnheldFaces findUnheldFaces(const CutGrid& cut, FreeLiquid& work);
    friend class HeldBodies;
    explicit UnheldFaces(FreeLiquid& work) : work_(&work) {}

    FreeLiquid* work_;
};

/// Token that it is known which bodies, components of the pressure's matrix, something holds.
class HeldBodies : public PressureComponents {
 public:
    const FreeLiquid& free() const { return *work_; }

 private:
    friend HeldBodies findHeldBodies(const BlockGrid& grid, const PressureComponents& system, const UnheldFaces& unheld);
    HeldBodies(const BlockGrid& grid, const PressureComponents& system, const UnheldFaces& unheld);

    const FreeLiquid* work_;
};

/// Faces that no solid closes, not even in part. The caller takes out those on which something else holds the liquid.
UnheldFaces findUnheldFaces(const CutGrid& cut, FreeLiquid& work);

/// Which bodies something holds, on faces that are not among these.
HeldBodies findHeldBodies(const BlockGrid& grid, const PressureComponents& system, const UnheldFaces& unheld);

/// Take the mean of others, by mass, from values on the faces of each free piece: in sum over it, these then did nothing. What gradients
/// of a potential that is 0 around the piece do sums up to nothing by itself; of shortened ones, of those on faces that are taken to be fuller
/// than they are, and of the jumps of surface tension something is left.
/// @param others  on the faces, of values' unit; may be the values
/// @param work    workspace that the bodies are in
void takeMeans(const BlockGrid& grid, const HeldBodies& bodies, const BlockArray<double, 3>& others, FreeLiquid& work, BlockArray<double, 3>& values);

/// Finds by blocks how fast that moves which holds the bodies. What flows past a solid that moves does so as
/// it would past the same solid at rest.
/// @param otherwise  velocity of what else holds bodies on which there is no solid [cm/s]
/// @param work       workspace that the bodies are in
void findFrames(const CutGrid& cut, const HeldBodies& bodies, const Vec3& otherwise, FreeLiquid& work);

/// Finds the cells of those bodies that are held.
/// @param work  workspace that the bodies are in
void findHeldCells(const BlockGrid& grid, const HeldBodies& bodies, FreeLiquid& work);

}  // namespace sim
