#pragma once

#include "sim/step_context.h"

// The stages of a step, in the order in which runStages (sim/step.cpp) calls them. Each opens the scope of its Stage, and returns first of all where
// the scene does not need it; what it did to momentum and energy it books last.

namespace sim {

// liquid_particles.cpp: the particles of the liquid before they go to the grid.

/// Sources emit particles.
void emit(StepContext& c);
/// Sort the particles by cell, delete those outside the domain, and make the blocks of the grid that the others need.
void sort(StepContext& c);
/// Solids on the grid: open fractions of faces, room in cells, velocities of walls.
void findObstacles(StepContext& c);
/// Fabric takes up liquid that touches it (exchange.cpp).
void capture(StepContext& c);
/// Find displacements that push particles apart where they are too dense.
void relax(StepContext& c);

// liquid_on_grid.cpp: velocities of the faces before the pressure.

/// P2G: mass and momentum of the faces.
void particlesToGrid(StepContext& c);
/// Velocities of the faces, on which gravity acts.
void applyGravity(StepContext& c);
/// What weight and the pressure against it do to velocities together is no shear. Viscosity in front of the pressure would take the weight for
/// one wherever walls hold the liquid, and set a pool at rest in motion (liquid/README.md, Viscosity). So both are taken off first (pressure.cpp).
void withholdPressure(StepContext& c);
/// Viscosity of the liquid; afterwards what withholdPressure took off is given back.
void applyViscosity(StepContext& c);
/// The fabric on its own grid, where its integrator solves there (fabric.cpp).
void fabricToGrid(StepContext& c);
/// The faces that liquid and fabric share, with drag and suction on them (fabric.cpp).
void findMixture(StepContext& c);
/// Which cells are liquid, and which are at its surface.
void findCells(StepContext& c);

// pressure.cpp: what makes the velocities of liquid and fabric free of divergence.

/// Steps of the pressure at the surface by its curvature.
void findSurfaceTension(StepContext& c);
void assemblePressure(StepContext& c);
/// Take the noise out of the weight of liquid that solids hold.
void levelWeight(StepContext& c);
void applySurfaceTension(StepContext& c);
/// Openings of the domain drive the liquid, or press on it.
void driveOpenings(StepContext& c);
/// Solve for the pressure and subtract its gradient.
void project(StepContext& c);
/// Stretching within the reach of a B-spline is no inertia: what the pressure did, without it.
void correctStrain(StepContext& c);
/// Work of sources that press liquid into liquid.
void bookInflowWork(StepContext& c);
/// Beyond outlets velocities go on as in their planes; work of openings.
void passOpenings(StepContext& c);
/// Displacements of the faces that bring the liquid back to its volume.
void correctVolume(StepContext& c);
/// Pressure and surface tension leave free liquid the momentum that it has, and walls add no energy to it.
void conserveMomentum(StepContext& c);
/// What the first of two steps reflected belongs to the pressure of the second, which finds none of it.
void completePressure(StepContext& c);

// fabric.cpp: the fabric, with what the liquid does to it.

void advanceFabric(StepContext& c);
/// The liquid's own velocities on faces that it shares with the fabric.
void separateMixture(StepContext& c);
/// Book what liquid and fabric got by being solved for.
void bookSolution(StepContext& c);
/// Masses of the liquid's faces are those of the liquid alone again, where volume of the fabric counted as filled.
void removeDisplaced(StepContext& c);

// back_to_particles.cpp: from the faces to the particles.

/// Cells of the liquid that solids and fabric hold, and how fast these move: those are not moved by the midpoint rule.
void findHeld(StepContext& c);
/// Reflect the velocities before the pressure about those after it, in the first of two steps.
void reflect(StepContext& c);
/// Velocities of faces behind walls.
void applyWalls(StepContext& c);
/// Impulses of the liquid's faces on solids, and of openings on the liquid.
void pushSolids(StepContext& c);
/// G2P: particles get their velocities and move, and stay out of solids.
void gridToParticles(StepContext& c);

// exchange.cpp: liquid that enters fabric, moves in it and leaves it.

/// Delete particles that fabric has taken up as a whole.
void deleteCaptured(StepContext& c);
void wick(StepContext& c);
void drip(StepContext& c);

}  // namespace sim
