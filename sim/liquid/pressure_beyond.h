#pragma once

#include "sim/liquid/free_liquid.h"
#include "sim/liquid/liquid_on_solids.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace sim {

/// Pressure in the cells just beyond the surface of liquid that solids hold, of the weight of the faces above them (liquid/README.md, Beyond the
/// surface). It acts along the axis of the grid that gravity is nearest to, and to the sides of that.
class PressureBeyond {
 public:
    /// @param gravityStep  velocity that weight has given to all faces in this step [cm/s]
    void begin(int blocks, const Vec3& gravityStep);
    /// A cell bears the face above it, which is normal to the axis that gravity is nearest to and has no weight any more.
    /// @param impulse  what the cell's pressure does in this step to a face that nothing closes [g cm/s]
    /// @param level    height of the surface there above a plane that lies so many cells below the cell, more than 0 [cells]
    void bear(const CellRef& cell, double impulse, double level);
    /// Pushes the faces at the sides of columns. Those between two such cells have more mass than the pressure there is of: they get what the slope
    /// of the surface asks for, the rest of it from the faces below them.
    /// @param told  of what each face, and the solids at it, get
    void push(const CutGrid& cut, const HeldBodies& bodies, LiquidGrid& liquid, const std::optional<LiquidOnSolids::Levelling>& told);

 private:
    struct Faces {
        const CutGrid& cut;
        const BlockArray<double, 3>& coefficient;  ///< of the pressure system
        const BlockBits<3>* bare;                  ///< faces without fabric; null if all are
        LiquidGrid& liquid;
        const std::optional<LiquidOnSolids::Levelling>& told;
    };
    bool hasAny(int block) const { return hasAny_[block] != 0; }
    void pushBlock(const Faces& faces, int block);
    void pushRow(const Faces& faces, int block, int axis, int j, int k);
    void handDown(const Faces& faces, int block) const;

    int axis_ = 1, up_ = 1;                        ///< axis that gravity is nearest to, and the direction along it against gravity
    double fall_ = 0.0;                            ///< what weight makes of velocities along it [cm/s]
    Vec3 tilt_ = Vec3::Zero();                     ///< slopes along the axes of a surface at rest [-]
    BlockArray<double> impulse_, level_;           ///< of each cell, as by bear(); 0 between steps
    BlockArray<double, 3> handed_;                 ///< what a face gets from the one below it [g cm/s]; 0 between steps
    std::vector<std::uint8_t> hasAny_, isPushed_;  ///< whether each block has such cells, and faces that they push
};

}  // namespace sim
