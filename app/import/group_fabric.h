#pragma once

#include "app/import/import_report.h"
#include "app/import/reference_scene.h"

#include <vector>

namespace app {

/// Cloth or yarns of one material that belong together; numbers are particles of the file.
struct FabricGroup {
    int material = 0;
    std::vector<int> particles;  ///< ascending
    std::vector<std::vector<int>> strands;
    std::vector<sim::Vec3i> faces;
    int line = 1;  ///< line of the first element

    bool isLooseYarn() const { return faces.empty() && strands.size() == 1; }
};

/// What touches is one group, as far as it is of one material and all cloth or all yarns; in the order of the file.
std::vector<FabricGroup> groupFabric(const reference::Scene& scene, ImportReport& report);

/// Several groups of yarns as one.
FabricGroup merged(const std::vector<FabricGroup>& groups);

}  // namespace app
