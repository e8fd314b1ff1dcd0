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
        auto& files = collections_[part.name];
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
    if (clips_.empty()) writeWhole(folder_ / kUsdaTopology, usdaTopology(frame.parts, secondsPerFrame_));
    clips_.push_back({frame.number, name});
    writeWhole(folder_ / kUsdaAnimation, usdaAnimation(clips_, secondsPerFrame_));
}

}  // namespace app
