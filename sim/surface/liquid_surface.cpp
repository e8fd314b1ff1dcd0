#include "sim/surface/liquid_surface.h"

#include "sim/core/check.h"
#include "sim/surface/surface_field.h"
#include "sim/surface/surface_velocity.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Beyond which particles do not count [spacing]. More is smoother, but pulls the surface in where liquid is bulky, so
/// that drops beside it come out too large. Of 2, 2.5 and 3, the surface of a box shaken by a quarter of a pitch is
/// rough by 0.08, 0.07 and 0.06 pitches, and a ball of 81 particles has 1.01, 0.75 and 0.50 of its volume before it is
/// moved.
constexpr double kReach = 2.5;

/// For velocities that is less, but with particles for every vertex: the surface is no farther than 2 from all of them.
constexpr double kVelocityReach = 2.25;

/// The field of which the normals are the gradient is smoothed by these passes: what is left of single particles in the
/// surface, a tenth of a spacing, would catch the eye by its shading alone.
constexpr int kNormalPasses = 8;

constexpr double kLargestOffset = 0.5;  ///< by which the surface may be moved for the sake of the volume [spacing]
constexpr double kVolumeTolerance = 4.0e-3;
constexpr int kMostExtractions = 8;

/// How the search begins: usual offsets are 0.1 to 0.3, and a spacing of offset moves the surface by 1.5 to 1.8.
constexpr double kUsualOffset = 0.15, kUsualRise = 1.6;

}  // namespace

const SurfaceMesh& LiquidSurface::find(const LiquidParticles& liquid, double density, const SurfaceSettings& settings)
{
    const double spacing = surfaceSpacing(liquid, density), reach = kReach / settings.cell;
    SIM_CHECK(reach <= kBlockEdge - 1);
    offset_ = settings.keepsVolume ? kUsualOffset : 0.0;
    grid_.dx = spacing > 0.0 ? settings.cell * spacing : 1.0;
    sortForSurface(liquid, density, reach + 1.0, grid_,
                   particles_);  // one more, so that all nodes inside have neighbours
    surfaceField(grid_, particles_, static_cast<float>(reach), static_cast<float>(1.0 / settings.cell), depth_);
    extract(settings);
    if (settings.keepsVolume) keepVolume(settings);
    smoothField(grid_, kNormalPasses, depth_, scratch_);  // after the surface itself is there
    findNormals(grid_, depth_, contour_.crossings(), mesh_.normals);
    if (settings.hasVelocities)
        surfaceVelocities(grid_, particles_, static_cast<float>(kVelocityReach / kReach * reach), contour_.crossings(), mesh_.velocities);
    return mesh_;
}

void LiquidSurface::extract(const SurfaceSettings& settings)
{
    contour_.extract(grid_, depth_, static_cast<float>((kReach - offset_) / settings.cell), mesh_);
}

/// The secant method, which begins with the area for the derivative; where it leads out of the bracket, halves of that.
void LiquidSurface::keepVolume(const SurfaceSettings& settings)
{
    double tooSmall = -kLargestOffset, tooLarge = kLargestOffset;
    double slope = kUsualRise * grid_.dx / settings.cell * surfaceArea(mesh_), lack = particles_.volume - enclosedVolume(mesh_);
    for (int n = 1; n < kMostExtractions && std::abs(lack) > kVolumeTolerance * particles_.volume; ++n) {
        (lack > 0.0 ? tooSmall : tooLarge) = offset_;
        const double lackBefore = lack, before = offset_,
                     moved = offset_ + lack / slope;  // not finite without a surface
        offset_ = moved > tooSmall && moved < tooLarge ? moved : 0.5 * (tooSmall + tooLarge);
        extract(settings);
        lack = particles_.volume - enclosedVolume(mesh_);
        slope = (lackBefore - lack) / (offset_ - before);
    }
}

}  // namespace sim
