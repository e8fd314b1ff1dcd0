#include "app/export/usda.h"

#include "app/export/geometry_files.h"
#include "app/provenance/provenance.h"
#include "sim/core/units.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>

namespace app {

namespace {

constexpr const char* kRoot = "drench";

/// Text of a layer under construction.
class Layer {
 public:
    /// @param sample  time code of the values that attributes have; without, they are declared only
    explicit Layer(std::optional<std::int64_t> sample) : sample_(sample) {}

    template <class... Args>
    void add(fmt::format_string<Args...> format, Args&&... args)
    {
        fmt::format_to(fmt::appender(text_), format, std::forward<Args>(args)...);
    }

    /// An attribute that changes with time: declared, and then its elements, each written by writeElement(i).
    template <class WriteElement>
    void varying(std::string_view type, std::string_view name, bool perPoint, std::size_t count, WriteElement writeElement)
    {
        add("        {}[] {}{}\n", type, name, perPoint ? " (\n            interpolation = \"vertex\"\n        )" : "");
        if (!sample_) return;
        add("        {}[] {}.timeSamples = {{\n            {}: [", type, name, *sample_);
        for (std::size_t i = 0; i < count; ++i) {
            if (i > 0) add(", ");
            writeElement(i);
        }
        add("],\n        }}\n");
    }
    void vectors(std::string_view type, std::string_view name, bool perPoint, std::span<const float> xyz)
    {
        varying(type, name, perPoint, xyz.size() / 3, [&](std::size_t i) { add("({}, {}, {})", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]); });
    }

    std::string take() const { return fmt::to_string(text_); }

 private:
    const std::optional<std::int64_t> sample_;
    fmt::memory_buffer text_;
};

/// What stands at the head of every layer.
void writeHead(const std::string& more, double secondsPerFrame, Layer& layer)
{
    // Most times per frame are decimals: 1 / 0.004 shall read 250.
    const double rate = std::round(1e6 / secondsPerFrame) / 1e6;
    layer.add(
        "#usda 1.0\n(\n    defaultPrim = \"{}\"\n    doc = \"{}: lengths in cm, velocities in cm/s, volumes in "
        "cm^3, "
        "absorbed liquid in g; a time code is a frame of {} s\"\n{}    metersPerUnit = 0.01\n"
        "    timeCodesPerSecond = {}\n    upAxis = \"Y\"\n)\n\n",
        kRoot, programName(), secondsPerFrame, more, rate);
}

/// Diameters [cm]: of yarns, or of balls that have the particles' volumes; null where the part has no such thing.
std::function<float(std::size_t)> widthsOf(const ExportPart& part)
{
    if (const ExportArray* radius = part.find("radius"))
        return [&r = std::get<std::vector<float>>(radius->values)](std::size_t i) { return 2.0f * r[i]; };
    if (const ExportArray* volume = part.find("volume"))
        return [&v = std::get<std::vector<float>>(volume->values)](std::size_t i) { return static_cast<float>(std::cbrt(6.0 / sim::kPi * v[i])); };
    return nullptr;
}

/// The box around all points and their widths: what a viewer frames. An empty part has the empty box of USD.
void writeExtent(const ExportPart& part, const std::function<float(std::size_t)>& width, Layer& layer)
{
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
        const Eigen::Vector3f margin = Eigen::Vector3f::Constant(width ? 0.5f * width(i) : 0.0f);
        box.extend(part.positions[i] - margin).extend(part.positions[i] + margin);
    }
    const float corners[] = {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
    layer.vectors("float3", "extent", false, corners);
}

void writeArray(const ExportArray& array, Layer& layer)
{
    if (array.name == "radius") return;  // as widths
    if (const auto* numbers = std::get_if<std::vector<float>>(&array.values)) {
        if (array.name == "velocity") return layer.vectors("vector3f", "velocities", false, *numbers);
        if (array.name == "normal") return layer.vectors("normal3f", "normals", true, *numbers);
        return layer.varying("float", "primvars:" + array.name, true, numbers->size(), [&](std::size_t i) { layer.add("{}", (*numbers)[i]); });
    }
    const auto& numbers = std::get<std::vector<std::uint32_t>>(array.values);
    const bool isId = array.name == "id";
    layer.varying(isId ? "int64" : "int", isId ? "ids" : "primvars:" + array.name, !isId, numbers.size(),
                  [&](std::size_t i) { layer.add("{}", numbers[i]); });
}

void writeCells(const ExportPart& part, Layer& layer)
{
    if (part.kind == ExportPart::Kind::Lines) {
        layer.add("        uniform token type = \"linear\"\n        uniform token wrap = \"nonperiodic\"\n");
        layer.varying("int", "curveVertexCounts", false, part.begin.size() - 1,
                      [&](std::size_t s) { layer.add("{}", part.begin[s + 1] - part.begin[s]); });
    }
    if (part.kind == ExportPart::Kind::Triangles) {
        layer.add("        uniform bool doubleSided = 1\n        uniform token subdivisionScheme = \"none\"\n");
        layer.varying("int", "faceVertexCounts", false, part.triangles.size(), [&](std::size_t) { layer.add("3"); });
        layer.varying("int", "faceVertexIndices", false, 3 * part.triangles.size(),
                      [&](std::size_t i) { layer.add("{}", part.triangles[i / 3][i % 3]); });
    }
}

void writePrims(std::span<const ExportPart> parts, Layer& layer)
{
    constexpr const char* kTypes[] = {"Points", "BasisCurves", "Mesh"};  // of ExportPart::Kind
    layer.add("def Xform \"{}\"\n{{\n", kRoot);
    for (const ExportPart& part : parts) {
        layer.add("    def {} \"{}\"\n    {{\n", kTypes[static_cast<int>(part.kind)], part.name);
        const auto width = widthsOf(part);
        writeCells(part, layer);
        writeExtent(part, width, layer);
        layer.vectors("point3f", "points", false, flat(part.positions));
        if (width) layer.varying("float", "widths", true, part.positions.size(), [&](std::size_t i) { layer.add("{}", width(i)); });
        for (const ExportArray& array : part.arrays) writeArray(array, layer);
        layer.add("    }}\n");
    }
    layer.add("}}\n");
}

std::string spanOf(std::int64_t first, std::int64_t last) { return fmt::format("    endTimeCode = {}\n    startTimeCode = {}\n", last, first); }

}  // namespace

std::string usdaFrame(const ExportFrame& frame, double secondsPerFrame)
{
    Layer layer(frame.number);
    writeHead(spanOf(frame.number, frame.number), secondsPerFrame, layer);
    writePrims(frame.parts, layer);
    return layer.take();
}

std::string usdaTopology(std::span<const ExportPart> parts, double secondsPerFrame)
{
    Layer layer(std::nullopt);
    writeHead("", secondsPerFrame, layer);
    writePrims(parts, layer);
    return layer.take();
}

std::string usdaAnimation(std::span<const FrameTime> frames, double secondsPerFrame)
{
    std::string active, times, files;
    for (std::size_t f = 0; f < frames.size(); ++f) {
        const char* comma = f > 0 ? ", " : "";
        const std::int64_t code = frames[f].number;
        active += fmt::format("{}({}, {})", comma, code, f);
        times += fmt::format("{}({}, {})", comma, code, code);
        files += fmt::format("{}@./{}@", comma, geometryFileName("frame", code, "usda"));
    }
    Layer layer(std::nullopt);
    writeHead(spanOf(frames.front().number, frames.back().number) + fmt::format("    subLayers = [@./{}@]\n", kUsdaTopology), secondsPerFrame, layer);
    layer.add(
        "over \"{}\" (\n    clips = {{\n        dictionary default = {{\n            double2[] active = [{}]\n"
        "            asset[] assetPaths = [{}]\n            asset manifestAssetPath = @./{}@\n"
        "            string primPath = \"/{}\"\n            double2[] times = [{}]\n        }}\n    }}\n)\n{{\n}}\n",
        kRoot, active, files, kUsdaTopology, kRoot, times);
    return layer.take();
}

}  // namespace app
