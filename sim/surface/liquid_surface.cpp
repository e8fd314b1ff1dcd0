#include "sim/surface/liquid_surface.h"

#include "sim/surface/surface_field.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Farthest that the surface is moved either way for the sake of the volume [spacing].
constexpr double kLargestOffset = 0.5;
constexpr double kVolumeTolerance = 1.0e-3;
constexpr int kMostExtractions = 8;

}  // namespace

const SurfaceMesh& LiquidSurface::find(const LiquidParticles& liquid, double density, const SurfaceSettings& settings)
{
    const double spacing = surfaceSpacing(liquid, density);
    offset_ = 0.0;
    mesh_ = {};
    grid_.dx = spacing > 0.0 ? settings.cell * spacing : 1.0;
    const auto reach = static_cast<float>(settings.reach / settings.cell);
    sortForSurface(liquid, density, reach + 1.0, grid_, particles_);
    surfaceField(grid_, particles_, reach, depth_);
    keepVolume(reach, settings);
    findNormals(grid_, depth_, contour_.crossings(), mesh_.normals);
    return mesh_;
}

void LiquidSurface::keepVolume(float reach, const SurfaceSettings& settings)
{
    const double spacing = grid_.dx / settings.cell;
    for (int n = 0; n < kMostExtractions; ++n) {
        contour_.extract(grid_, depth_, reach - static_cast<float>(offset_ / settings.cell), mesh_);
        const double lack = particles_.volume - enclosedVolume(mesh_), area = surfaceArea(mesh_);
        if (!settings.keepsVolume || std::abs(lack) <= kVolumeTolerance * particles_.volume || !(area > 0.0)) return;
        offset_ = std::clamp(offset_ + lack / (area * spacing), -kLargestOffset, kLargestOffset);
    }
}

}  // namespace sim
