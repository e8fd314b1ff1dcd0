#include "tests/app/export/geometry_in_test.h"

#include "app/system/child_process.h"
#include "tests/app/temporary_folder.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace app::test {

namespace {

sim::FabricPiece yarns()
{
    sim::FabricGeometry geometry;
    geometry.points = {{0, 0, 0}, {1, 0, 0}, {2, 0.5, 0}, {0, 0, 1}, {1, 0, 1}};
    geometry.strands = {{0, 1, 2}, {3, 4}};
    return sim::testing::pieceOf(geometry, sim::testing::wool(), {0.04, 0.09});
}

sim::FabricPiece sheet()
{
    sim::FabricGeometry geometry;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i) geometry.points.emplace_back(i, 3.0 + 0.2 * i * j, j);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 3; ++i) {
            const int at = 4 * j + i;
            geometry.faces.insert(geometry.faces.end(), {{at, at + 4, at + 1}, {at + 1, at + 4, at + 5}});
        }
    sim::FabricPiece piece = sim::testing::pieceOf(geometry, sim::testing::wool(), {0.05, 0.05});
    piece.name = "sheet";
    piece.material.density = 1.5;
    return piece;
}

FrameSnapshot::Mesh tetrahedron()
{
    FrameSnapshot::Mesh mesh;
    mesh.name = "big tank";
    mesh.positions = {{-5, -5, -5}, {9, -5, -5}, {-5, 9, -5}, {-5, -5, 9}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

}  // namespace

WetScene::WetScene(std::size_t particles) : obstacles{tetrahedron()}
{
    sim::testing::Noise noise(7);
    const std::vector<sim::FabricPiece> pieces = {yarns(), sheet()};
    fabric = sim::assembleFabric(pieces);
    state.fabric = sim::restState(fabric);
    const std::vector<double> capacity = sim::poreCapacity(fabric, kDensity);
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
        state.fabric.v[v] = 30.0 * noise.vector();
        state.fabric.absorbed[v] = capacity[v] * std::max(0.0, noise());
    }
    state.fabric.absorbed[1] = 1.5 * capacity[1];  // more than its pores hold
    state.emittedVolume = {1.0};
    for (std::size_t p = 0; p < particles; ++p) {
        const auto id = static_cast<std::uint32_t>((7919 * p + 3) % particles + 100);
        state.liquid.add(4.0 * noise.vector(), 1e-3 * (1.5 + noise()), id, 100.0 * noise.vector());
    }
    state.nextId = 1000;
}

ExportFrame WetScene::frame(std::int64_t number) const { return exportFrame(number, state, fabric, kDensity, obstacles); }

void WetScene::move(double dt)
{
    for (std::size_t p = 0; p < state.liquid.count; ++p)
        for (int a = 0; a < 3; ++a) state.liquid.x[a][p] += dt * state.liquid.velocity(p)[a];
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) state.fabric.x[v] += dt * state.fabric.v[v];
    state.time += dt;
}

void expectClose(const nlohmann::json& read, const sim::Vec3& written)
{
    ASSERT_EQ(read.size(), 3u);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(read[a].get<double>(), written[a], kSingle * std::abs(written[a]));
}

nlohmann::json readGeometry(const std::vector<std::filesystem::path>& files)
{
    const TemporaryFolder folder;
    std::vector<std::string> arguments = {"-B", GEOMETRY_READER, folder / "out.json"};
    arguments.insert(arguments.end(), files.begin(), files.end());
    const ChildExit end = runChild(PYTHON_WITH_VTK, arguments);
    // VTK tells some faults by words alone.
    if (!end.ok() || !end.errorText.empty()) throw std::runtime_error(end.errorText);
    return nlohmann::json::parse(contentOf(folder / "out.json"));
}

}  // namespace app::test
