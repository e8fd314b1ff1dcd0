#include "app/export/obj.h"

#include "app/provenance/provenance.h"

#include <fmt/format.h>

namespace app {

namespace {

/// @param first  number of the first point of the part: those of a file count from 1, over all parts
void writeCells(const ExportPart& part, std::size_t first, fmt::memory_buffer& out)
{
    const auto to = fmt::appender(out);
    if (part.kind == ExportPart::Kind::Points)
        for (std::size_t i = 0; i < part.positions.size(); ++i) fmt::format_to(to, "p {}\n", first + i);
    for (std::size_t s = 0; s + 1 < part.begin.size(); ++s) {
        out.push_back('l');
        for (int i = part.begin[s]; i < part.begin[s + 1]; ++i) fmt::format_to(to, " {}", first + i);
        out.push_back('\n');
    }
    for (const Eigen::Vector3i& t : part.triangles) fmt::format_to(to, "f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
}

}  // namespace

std::string objFile(const ExportFrame& frame)
{
    fmt::memory_buffer out;
    fmt::format_to(fmt::appender(out), "# {}: lengths in cm, time {} s\n", programName(), frame.time);
    std::size_t first = 1;
    for (const ExportPart& part : frame.parts) {
        fmt::format_to(fmt::appender(out), "o {}\ng {}\n", part.name, part.name);
        for (const Eigen::Vector3f& x : part.positions) fmt::format_to(fmt::appender(out), "v {} {} {}\n", x.x(), x.y(), x.z());
        writeCells(part, first, out);
        first += part.positions.size();
    }
    return fmt::to_string(out);
}

}  // namespace app
