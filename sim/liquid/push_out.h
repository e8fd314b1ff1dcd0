#pragma once

#include "sim/grid/obstacle_field.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// Move particles that are inside an obstacle to its surface along the gradient of its distance, at their final positions
/// (model-fluid, D3).
/// @param order      the order of the positions before they moved
/// @param farthest   how far a particle can have moved since the sort [cm]
void pushOutOfObstacles(const ParticleOrder& order, const BlockGrid& grid, const ObstacleField& field, const Obstacles& obstacles,
                        double farthest, LiquidParticles& particles);

}  // namespace sim
