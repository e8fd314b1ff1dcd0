#include "app/export/vtp.h"

#include "app/export/binary.h"
#include "app/export/compress.h"
#include "app/export/geometry_files.h"
#include "app/provenance/provenance.h"

#include <fmt/format.h>

#include <numeric>

namespace app {

namespace {

/// A file under construction: its XML, and the numbers that come behind it.
class VtpText {
 public:
    void line(std::string_view text) { (xml_ += text) += '\n'; }

    /// An array whose numbers are in the appended data.
    template <class T>
    void array(const std::string& name, int components, std::span<const T> values)
    {
        static_assert(sizeof(T) == 4);
        const char* type = std::is_same_v<T, float> ? "Float32" : std::is_signed_v<T> ? "Int32" : "UInt32";
        line(fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)", type, name, components,
                         appended_.size()));
        appendCompressed(std::as_bytes(values), std::is_integral_v<T>, appended_);
    }

    std::string take() &&
    {
        line("<AppendedData encoding=\"raw\">");
        return std::move(xml_) + '_' + appended_ + "\n</AppendedData>\n</VTKFile>\n";
    }

 private:
    std::string xml_, appended_;
};

/// The cells of one kind: the points of all, one behind the other, and the end of each.
void writeCells(const char* kind, std::span<const int> points, std::span<const int> ends, VtpText& out)
{
    out.line(fmt::format("<{}>", kind));
    out.array("connectivity", 1, points);
    out.array("offsets", 1, ends);
    out.line(fmt::format("</{}>", kind));
}

/// first, first + step, …
std::vector<int> series(std::size_t count, int first, int step)
{
    std::vector<int> values(count);
    for (int& value : values) value = std::exchange(first, first + step);
    return values;
}

void writeCells(const ExportPart& part, VtpText& out)
{
    const std::size_t points = part.positions.size();
    switch (part.kind) {
        case ExportPart::Kind::Points: return writeCells("Verts", series(points, 0, 1), series(points, 1, 1), out);
        case ExportPart::Kind::Lines: return writeCells("Lines", series(points, 0, 1), std::span(part.begin).subspan(1), out);
        case ExportPart::Kind::Triangles: return writeCells("Polys", flat(part.triangles), series(part.triangles.size(), 3, 3), out);
    }
}

std::size_t cellCount(const ExportPart& part, ExportPart::Kind kind)
{
    if (kind != part.kind) return 0;
    return kind == ExportPart::Kind::Points ? part.positions.size() : kind == ExportPart::Kind::Lines ? part.begin.size() - 1 : part.triangles.size();
}

}  // namespace

std::string vtpFile(const ExportPart& part, double time)
{
    using Kind = ExportPart::Kind;
    VtpText out;
    out.line("<?xml version=\"1.0\"?>");
    out.line(fmt::format("<!-- {}: {}, time in s -->", programName(), unitsOf(part)));
    out.line(R"(<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">)");
    out.line("<PolyData>");
    out.line(
        fmt::format(R"(<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray></FieldData>)", time));
    out.line(fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfVerts="{}" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="{}">)",
                         part.positions.size(), cellCount(part, Kind::Points), cellCount(part, Kind::Lines), cellCount(part, Kind::Triangles)));
    out.line("<PointData>");
    for (const ExportArray& array : part.arrays)
        std::visit([&]<class T>(const std::vector<T>& values) { out.array(array.name, array.components, std::span(values)); }, array.values);
    out.line("</PointData>");
    out.line("<Points>");
    out.array("Points", 3, flat(part.positions));
    out.line("</Points>");
    writeCells(part, out);
    out.line("</Piece>");
    out.line("</PolyData>");
    return std::move(out).take();
}

std::string pvdFile(std::string_view part, std::span<const FrameTime> frames)
{
    std::string out = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- {}: timestep in s -->\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
        programName());
    for (const FrameTime& frame : frames)
        out += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", frame.time, geometryFileName(part, frame.number, kVtpExtension));
    return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace app
