// The pattern of the Hessian, the batches of triangles, and the tasks that they are worked on in.

#include "sim/fabric/shells/shell_rest.h"
#include "sim/fabric/shells/shells.h"

#include <algorithm>
#include <cstdint>

namespace sim {

Shells::Shells(const Fabric& fabric, const FabricSettings& settings) : settings_(settings)
{
    const std::span<const Vec3i> faces = fabric.faces.vertices;
    if (faces.empty()) return;
    across_ = verticesAcross(faces);
    row_.assign(fabric.vertexCount(), -1);
    for (const Vec3i& f : faces)
        for (int k = 0; k < 3; ++k) row_[f[k]] = 0;
    for (std::size_t v = 0; v < row_.size(); ++v)
        if (row_[v] == 0) {
            row_[v] = static_cast<int>(vertices_.size());
            vertices_.push_back(static_cast<int>(v));
        }

    pattern_.resize(vertices_.size());
    const auto sixOf = [&](std::size_t f) {
        std::array<int, kShellVertices> six{};
        for (int k = 0; k < 3; ++k) {
            six[k] = row_[faces[f][k]];
            six[3 + k] = across_[f][k] >= 0 ? row_[across_[f][k]] : -1;
        }
        return six;
    };
    neighbors_.resize(vertices_.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::array<int, kShellVertices> six = sixOf(f);
        for (int i = 0; i < kShellVertices; ++i)
            for (int j = 0; j < kShellVertices; ++j) {
                if (six[i] < 0 || six[j] < 0 || !areTied(i, j)) continue;
                pattern_[six[i]].push_back(six[j]);
                if (i < 3 && j < 3) neighbors_[six[i]].push_back(six[j]);
            }
    }
    for (auto* rows : {&pattern_, &neighbors_})
        for (std::vector<int>& columns : *rows) {
            std::ranges::sort(columns);
            columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
        }

    const BlockMatrix pattern(pattern_);
    for (std::size_t begin = 0; begin < faces.size(); begin += kLanes)
        fill(fabric, settings, begin, std::min(faces.size(), begin + kLanes), pattern, batches_.emplace_back());
    colorTasks(fabric.vertexCount());
    for (const FabricMaterial& m : fabric.materials) damped_ = damped_ || (m.dampingViscosity > 0.0 && (m.dampBending || m.dampStretching));
}

/// Greedy: each task takes the first colour that none before it with a vertex of its own has.
void Shells::colorTasks(std::size_t vertices)
{
    std::vector<std::vector<int>> colorsAt(vertices);
    const int tasks = static_cast<int>((batches_.size() + kBatchesPerTask - 1) / kBatchesPerTask);
    for (int task = 0; task < tasks; ++task) {
        std::vector<int> own;
        for (std::size_t b = task * kBatchesPerTask; b < std::min(batches_.size(), (task + 1) * kBatchesPerTask); ++b)
            for (const Lanes& lanes : batches_[b].vertex) std::ranges::copy_if(lanes, std::back_inserter(own), [](int v) { return v >= 0; });
        std::vector<char> isTaken(tasks_.size() + 1, 0);
        for (int v : own)
            for (int color : colorsAt[v]) isTaken[color] = 1;
        const int color = static_cast<int>(std::ranges::find(isTaken, 0) - isTaken.begin());
        if (color == static_cast<int>(tasks_.size())) tasks_.emplace_back();
        tasks_[color].push_back(task);
        for (int v : own)
            if (colorsAt[v].empty() || colorsAt[v].back() != color) colorsAt[v].push_back(color);
    }
}

/// The faces from number begin to end, a pack of them at most.
void Shells::fill(const Fabric& fabric, const FabricSettings& settings, std::size_t begin, std::size_t end, const BlockMatrix& pattern,
                  Batch& batch) const
{
    for (auto& lanes : batch.vertex) lanes.fill(-1);
    for (auto& lanes : batch.entry) lanes.fill(-1);
    batch.isTransposed.fill(0);
    for (std::size_t f = begin; f < end; ++f) {
        const int l = static_cast<int>(f - begin);
        const FabricMaterial& material = fabric.materials[fabric.faces.material[f]];
        for (int k = 0; k < 3; ++k) {
            batch.vertex[k][l] = fabric.faces.vertices[f][k];
            batch.vertex[3 + k][l] = across_[f][k];
        }
        setLane(batch.rest, l, shellRest(fabric, static_cast<int>(f), across_[f], settings));
        const double viscous = 3.0 * material.dampingViscosity / material.young;
        batch.damping[l] = material.dampStretching ? viscous : 0.0;
        batch.bendDamping[l] = material.dampBending ? viscous : 0.0;
        for (int i = 0; i < kShellVertices; ++i)
            for (int j = i; j < kShellVertices; ++j) {
                if (batch.vertex[i][l] < 0 || batch.vertex[j][l] < 0 || !areTied(i, j)) continue;
                const int ri = row_[batch.vertex[i][l]], rj = row_[batch.vertex[j][l]];
                batch.entry[blockOf(i, j)][l] = pattern.find(std::min(ri, rj), std::max(ri, rj));
                if (ri > rj) batch.isTransposed[blockOf(i, j)] |= 1u << l;
            }
    }
}

}  // namespace sim
