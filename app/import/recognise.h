#pragma once

#include "sim/fabric/pieces/generators.h"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace app {

inline constexpr double kSameShape = 1.0e-9;  ///< how far a generator's vertices may be from the file's [cm]

/// Cloth or yarns as a file lists them.
struct ListedFabric {
    std::vector<sim::Vec3> points;          ///< [cm]
    std::vector<std::vector<int>> strands;  ///< points in order
    std::vector<sim::Vec3i> faces;
};

/// Cloth or yarns by a generator of scene files.
struct GeneratedFabric {
    std::string kind;                                         ///< "cloth_grid"
    std::vector<std::pair<std::string, std::string>> fields;  ///< keys and values as YAML, but material and radius
    std::string summary;                                      ///< "99 × 99 vertices, 0.144 cm apart"
    sim::FabricGeometry geometry;
    std::vector<int> pointOf;  ///< listed vertex of each generated one
    double deviation = 0.0;    ///< largest distance of a listed and a generated vertex [cm]
};

/// A sheet of triangles on a lattice, wherever the numbering starts and however it runs; nothing if it is none.
std::optional<GeneratedFabric> recogniseClothGrid(const ListedFabric& fabric);

/// Yarns over and under each other, with a border or without, in the order of our generator (fabric/README.md, Weaves).
std::optional<GeneratedFabric> recogniseWeave(const ListedFabric& fabric);

/// One yarn: straight, or of a few points.
std::optional<GeneratedFabric> recogniseStrand(const ListedFabric& fabric);

/// "[0, 1, 0]"
std::string yamlList(const sim::Vec3& x);

}  // namespace app
