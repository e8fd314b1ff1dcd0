#pragma once

#include "sim/surface/contour.h"
#include "sim/surface/surface_particles.h"

namespace sim {

/// How the surface is made. The unit is the spacing of particles, as surfaceSpacing finds it.
struct SurfaceSettings {
    double cell = 0.6;          ///< cell of the grid that the surface is found on [spacing], 0.43 … 0.8
    bool keepsVolume = true;    ///< move the surface so that it encloses the volume of the particles
    bool hasVelocities = true;  ///< whether vertices get velocities
};

/// The surface of the bulk liquid's particles as a closed mesh; see surfaceField for what the surface is. Kept from
/// call to call for its storage alone: a mesh depends on nothing before, and not on the number of threads.
class LiquidSurface {
 public:
    /// The surface of particles of this density [g/cm^3], valid until the next call.
    ///
    /// The surface encloses the particles' volume, Σ mass / density, to 0.4 %: the whole surface is moved outwards by one distance, at
    /// most half a spacing either way, that changes as smoothly with time as the particles do. Where that is not enough
    /// - `reference` seeds leave 42 % of their region empty - the volume stays as near as it gets; offset() tells. Bulk
    /// liquid and drops share that distance, so that drops of one particle beside a large body come out up to twice
    /// too large, and clumps of a few dozen by up to a quarter too small.
    ///
    /// Drops much smaller than the average particle are missed where they are between the nodes of the grid.
    /// Throws RunError if a particle is out of the range of the grid.
    const SurfaceMesh& find(const LiquidParticles& liquid, double density, const SurfaceSettings& settings = {});

    const SurfaceMesh& mesh() const { return mesh_; }
    double liquidVolume() const { return particles_.volume; }  ///< volume of the particles [cm^3]
    double offset() const { return offset_; }                  ///< distance by which the surface was moved outwards [spacing]
    int blocks() const { return grid_.count(); }               ///< number of blocks of 8³ nodes that the grid has: all its memory

 private:
    void extract(const SurfaceSettings& settings);
    void keepVolume(const SurfaceSettings& settings);

    BlockGrid grid_;
    SurfaceParticles particles_;
    BlockArray<float> depth_, scratch_;
    Contour contour_;
    SurfaceMesh mesh_;
    double offset_ = 0.0;
};

}  // namespace sim
