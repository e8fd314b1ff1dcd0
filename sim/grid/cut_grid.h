#pragma once

#include "sim/grid/obstacle_field.h"

namespace sim {

/// The grid as solids cut it: its blocks, what solids leave of cells and faces, and the solids themselves.
struct CutGrid {
    const BlockGrid& grid;
    const ObstacleField& field;  ///< field of these solids on this grid
    const Obstacles& obstacles;
};

}  // namespace sim
