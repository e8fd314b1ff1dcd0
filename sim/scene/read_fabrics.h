#pragma once

#include "sim/fabric/pieces/generators.h"
#include "sim/scene/node.h"
#include "sim/scene/scene.h"

namespace sim {

/// Reads materials; `porous` gives the volume fraction of those that do not say theirs. Where the scene has no section porous, it takes the
/// fibres of the first preset.
std::vector<NamedMaterial> readMaterials(const Node& root, PorousSettings& porous);

/// Reads fabrics with their pins, placed and checked; `scene` gives materials and the cell.
std::vector<FabricPiece> readFabrics(const Node& root, const Scene& scene);

/// One generator of a piece of fabric.
struct ReadFabricShape {
    FabricGeometry geometry;
    std::array<double, 2> radius{};       ///< [cm]
    std::string text;                     ///< fields as a scene says them, in cgs, without material: "nodes: [9, 9], radius: 0.02"
    Vec3 warp = Vec3::UnitX();            ///< direction of the warp of cloth
    std::vector<std::string> notes = {};  ///< "drop.yaml:14: …": what was mended in its file
};

/// @param kind       one of fabricShapeKinds()
/// @param thickness  of the material's cloth, for cloth that says no radius; 0: the material has none [cm]
ReadFabricShape readFabricShape(const Node& node, const std::string& path, const std::string& kind, double thickness = 0.0);
const std::vector<std::string>& fabricShapeKinds();

/// Reads the pins of a piece, one map or a list of them. Corners and sides are those of the generator's own geometry;
/// shapes are where the `placed` points are.
std::vector<PinGroup> readPins(const Node& node, const std::string& path, const FabricGeometry& geometry, std::span<const Vec3> placed, double cell);

/// The section `motion`: gives obstacles, pins and the pins of fabrics the motions that name them.
void readMotions(const Node& root, Scene& scene);

}  // namespace sim
