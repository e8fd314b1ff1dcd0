#include "app/export/ply.h"

#include "app/export/binary.h"
#include "app/provenance/provenance.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>

#include <cstring>

namespace app {

namespace {

/// Numbers of 4 bytes in memory: `components` for each point.
struct Column {
    const void* values;
    std::size_t components;
};

Column columnOf(const ExportArray& array)
{
    const void* values = std::visit([](const auto& v) -> const void* { return v.data(); }, array.values);
    return {values, static_cast<std::size_t>(array.components)};
}

void writeProperties(const ExportArray& array, std::string& header)
{
    const char* type = std::holds_alternative<std::vector<float>>(array.values) ? "float" : "uint";
    if (array.components == 1) {
        header += fmt::format("property {} {}\n", type, array.name);
        return;
    }
    // vx vy vz and nx ny nz, as every reader knows them.
    for (const char axis : {'x', 'y', 'z'}) header += fmt::format("property {} {}{}\n", type, array.name[0], axis);
}

std::string headerOf(const ExportPart& part, double time, std::size_t edges)
{
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\ncomment {}: {}\ncomment time {} s\nelement vertex {}\n", programName(),
                                     unitsOf(part), time, part.positions.size());
    for (const char axis : {'x', 'y', 'z'}) header += fmt::format("property float {}\n", axis);
    for (const ExportArray& array : part.arrays) writeProperties(array, header);
    if (part.kind == ExportPart::Kind::Triangles)
        header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", part.triangles.size());
    if (part.kind == ExportPart::Kind::Lines) header += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", edges);
    return header + "end_header\n";
}

/// One row per point: its numbers of all columns.
void appendRows(const std::vector<Column>& columns, std::size_t points, std::string& out)
{
    constexpr std::size_t kNumber = 4, kGrain = 4096;
    std::size_t length = 0;
    for (const Column& column : columns) length += kNumber * column.components;
    const std::size_t begin = out.size();
    out.resize(begin + points * length);
    sim::parallelFor(points, kGrain, [&](std::size_t i) {
        char* to = out.data() + begin + i * length;
        for (const Column& column : columns) {
            const std::size_t bytes = kNumber * column.components;
            std::memcpy(to, static_cast<const char*>(column.values) + i * bytes, bytes);
            to += bytes;
        }
    });
}

std::vector<Eigen::Vector2i> edgesOf(const ExportPart& part)
{
    std::vector<Eigen::Vector2i> edges;
    for (std::size_t s = 0; s + 1 < part.begin.size(); ++s)
        for (int i = part.begin[s]; i + 1 < part.begin[s + 1]; ++i) edges.emplace_back(i, i + 1);
    return edges;
}

}  // namespace

std::string plyFile(const ExportPart& part, double time)
{
    const std::vector<Eigen::Vector2i> edges = edgesOf(part);
    std::string out = headerOf(part, time, edges.size());
    std::vector<Column> columns = {{part.positions.data(), 3}};
    for (const ExportArray& array : part.arrays) columns.push_back(columnOf(array));
    appendRows(columns, part.positions.size(), out);
    for (const Eigen::Vector3i& triangle : part.triangles) {
        appendBinary(std::uint8_t{3}, out);
        appendBinary(triangle, out);
    }
    for (const Eigen::Vector2i& edge : edges) appendBinary(edge, out);
    return out;
}

}  // namespace app
