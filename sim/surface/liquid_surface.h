#pragma once

#include "sim/surface/contour.h"
#include "sim/surface/surface_particles.h"

namespace sim {

/// How the surface is made. Lengths are in the spacing that surfaceSpacing finds, that of a lattice of the particles.
struct SurfaceSettings {
    double cell = 0.5;        ///< of the grid that the surface is found on [spacing]
    double reach = 2.0;       ///< beyond which particles do not count [spacing]; at most 6 cells
    bool keepsVolume = true;  ///< move the surface so that it encloses the volume of the particles
    bool hasVelocities = true;
};

/// The surface of the bulk liquid's particles. Kept from call to call for its storage alone: a result depends on
/// nothing before.
class LiquidSurface {
 public:
    /// Find the surface of particles of this density [g/cm^3]. Valid until the next call.
    const SurfaceMesh& find(const LiquidParticles& liquid, double density, const SurfaceSettings& settings = {});

    const SurfaceMesh& mesh() const { return mesh_; }
    double liquidVolume() const { return particles_.volume; }  ///< of the particles [cm^3]
    double offset() const { return offset_; }                  ///< by which the surface was moved outwards [spacing]
    int blocks() const { return grid_.count(); }               ///< of 8³ nodes, in which the field is known

 private:
    void keepVolume(float reach, const SurfaceSettings& settings);

    BlockGrid grid_;
    SurfaceParticles particles_;
    BlockArray<float> depth_;
    Contour contour_;
    SurfaceMesh mesh_;
    double offset_ = 0.0;
};

}  // namespace sim
