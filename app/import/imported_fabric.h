#pragma once

#include "app/import/import_report.h"
#include "app/import/recognise.h"
#include "app/import/reference_scene.h"

#include <array>
#include <string>
#include <vector>

namespace app {

/// Vertices of a piece that are held, and follow the scripts of a group.
struct ImportedPin {
    int group = -1;  ///< -1: stands still
    bool twist = false;
    std::string selection;      ///< "corners: all, patch: 2"
    std::vector<int> vertices;  ///< vertices of the piece, ascending
};

/// One piece of fabric of the scene to be written.
struct ImportedPiece {
    std::string name;
    int material = 0;                        ///< material of the file
    std::array<double, 2> radius{};          ///< [cm]
    sim::Vec3 velocity = sim::Vec3::Zero();  ///< [cm/s]
    double wetness = 0.0;                    ///< share of the pores that is full [-]
    GeneratedFabric shape;                   ///< kind mesh or points: its geometry goes into a file of its own
    std::vector<int> particles;              ///< particles of the file, by vertex
    std::vector<ImportedPin> pins;
    int line = 1;  ///< line of the file

    bool hasFile() const { return shape.kind == "mesh" || shape.kind == "points"; }
};

/// All cloth and yarns of a scene, by generators where they are recognised; tells the report what came out, and what is
/// lost.
std::vector<ImportedPiece> importFabrics(const reference::Scene& scene, ImportReport& report);

/// The groups that a script moves.
bool isMovedGroup(const reference::Scene& scene, int group);

/// The pins of a piece whose shape and particles are known.
std::vector<ImportedPin> importPins(const ImportedPiece& piece, const reference::Scene& scene, ImportReport& report);

/// The words of a scene that hold these vertices and no others: corners or a side where they are meant, else their
/// numbers.
std::string pinSelection(const sim::FabricGeometry& geometry, const std::vector<int>& vertices);

/// Vertices, edges and faces as an OBJ file, counted from 1.
std::string objText(const sim::FabricGeometry& geometry);

}  // namespace app
