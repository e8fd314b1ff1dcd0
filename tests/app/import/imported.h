#pragma once

#include "app/import/import_scene.h"
#include "sim/core/check.h"
#include "tests/app/temporary_folder.h"

#include <filesystem>
#include <string>

namespace app::test {

inline std::filesystem::path ownScene(const std::string& name) { return std::filesystem::path(IMPORT_SCENES_DIR) / (name + ".xml"); }

/// A scene of libWetCloth, imported into a folder of the test's own, and loaded from there.
class Imported {
 public:
    explicit Imported(const std::filesystem::path& xml, const ImportOptions& options = {}) : backends_(drenchBackends())
    {
        yaml_ = folder_ / (xml.stem().string() + ".yaml");
        report = importScene(xml, yaml_, options, backends_);
    }
    LoadedScene setup() const { return backends_.loadScene({yaml_.string(), "", {}}); }
    sim::Scene scene() const { return setup().scene; }
    std::unique_ptr<SimulationHandle> start(const LoadedScene& setup) const { return backends_.startSimulation(setup); }
    std::string yaml() const { return contentOf(yaml_); }
    const std::filesystem::path& folder() const { return folder_.path(); }

    std::string report;

 private:
    TemporaryFolder folder_;
    Backends backends_;
    std::filesystem::path yaml_;
};

struct FabricCounts {
    std::size_t vertices = 0, edges = 0, faces = 0, held = 0, pieces = 0;
    bool operator==(const FabricCounts&) const = default;
};

inline FabricCounts countFabric(const sim::Scene& scene)
{
    FabricCounts n;
    for (const sim::FabricPiece& piece : scene.fabrics) {
        ++n.pieces;
        n.vertices += piece.points.size();
        n.faces += piece.faces.size();
        for (const auto& strand : piece.strands) n.edges += strand.size() - 1;
        for (const auto& pin : piece.pins) n.held += pin.vertices.size();
    }
    return n;
}

inline void PrintTo(const FabricCounts& n, std::ostream* out)
{
    *out << n.vertices << " vertices, " << n.edges << " edges, " << n.faces << " faces, " << n.held << " held, " << n.pieces << " pieces";
}

}  // namespace app::test
