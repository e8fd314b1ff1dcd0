#include "app/export/exporter.h"

#include "app/export/geometry_files.h"
#include "app/export/obj.h"
#include "app/export/ply.h"
#include "app/output_files.h"
#include "app/output_folder.h"

namespace app {

Exporter::Exporter(std::filesystem::path folder, const GeometryFormats& formats, double secondsPerFrame)
    : folder_(std::move(folder)), formats_(formats), secondsPerFrame_(secondsPerFrame)
{
    makeFolder(folder_);
}

/// Numbers of the frames before this one of which there are such files, from a run that is gone on with.
std::vector<std::int64_t> Exporter::framesBefore(std::int64_t frame, const std::string& part, const std::string& extension) const
{
    std::vector<std::int64_t> frames = numbersIn(folder_, part + "_", "." + extension);
    std::erase_if(frames, [&](std::int64_t n) { return n >= frame; });
    return frames;
}

void Exporter::write(const ExportFrame& frame)
{
    if (formats_.vtp) writeVtp(frame);
    if (formats_.ply) writePly(frame);
    if (formats_.obj) writeWhole(folder_ / geometryFileName("frame", frame.number, "obj"), objFile(frame));
    if (formats_.usda) writeUsda(frame);
}

void Exporter::writeVtp(const ExportFrame& frame)
{
    for (const ExportPart& part : frame.parts) {
        const std::string name = geometryFileName(part.name, frame.number, "vtp");
        writeWhole(folder_ / name, vtpFile(part, frame.time));
        const auto [found, isNew] = collections_.try_emplace(part.name);
        auto& files = found->second;
        if (isNew)
            for (const std::int64_t n : framesBefore(frame.number, part.name, "vtp"))
                files.push_back({frame.time + secondsPerFrame_ * static_cast<double>(n - frame.number), geometryFileName(part.name, n, "vtp")});
        files.push_back({frame.time, name});
        writeWhole(folder_ / (part.name + ".pvd"), pvdFile(files));
    }
}

void Exporter::writePly(const ExportFrame& frame) const
{
    for (const ExportPart& part : frame.parts)
        writeWhole(folder_ / geometryFileName(part.name, frame.number, "ply"), plyFile(part, frame.time));
}

void Exporter::writeUsda(const ExportFrame& frame)
{
    const std::string name = geometryFileName("frame", frame.number, "usda");
    writeWhole(folder_ / name, usdaFrame(frame, secondsPerFrame_));
    if (clips_.empty()) {
        writeWhole(folder_ / kUsdaTopology, usdaTopology(frame.parts, secondsPerFrame_));
        for (const std::int64_t n : framesBefore(frame.number, "frame", "usda")) clips_.push_back({n, geometryFileName("frame", n, "usda")});
    }
    clips_.push_back({frame.number, name});
    writeWhole(folder_ / kUsdaAnimation, usdaAnimation(clips_, secondsPerFrame_));
}

}  // namespace app
