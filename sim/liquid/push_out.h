#pragma once

#include "sim/grid/obstacle_field.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// As far in front of the surface [cells]: in a wall that mirrors the liquid the velocity towards it is 0, and what was
/// put right there, under a lid, would never fall while the velocities around it grow.
inline constexpr double kPushedInFront = 0.01;

/// Move particles that are inside an obstacle out along the gradient of its distance, to just in front of its surface, at
/// their final positions (model-fluid, D3).
/// @param order      the order of the positions before they moved
/// @param farthest   how far a particle can have moved since the sort [cm]
void pushOutOfObstacles(const ParticleOrder& order, const BlockGrid& grid, const ObstacleField& field, const Obstacles& obstacles,
                        double farthest, LiquidParticles& particles);

}  // namespace sim
