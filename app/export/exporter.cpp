#include "app/export/exporter.h"

#include "app/export/geometry_files.h"
#include "app/export/obj.h"
#include "app/export/ply.h"
#include "app/export/usda.h"
#include "app/export/vtp.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"

namespace app {

Exporter::Exporter(std::filesystem::path folder, const GeometryFormats& formats, double secondsPerFrame, std::vector<FrameTime> earlier)
    : folder_(std::move(folder)), formats_(formats), secondsPerFrame_(secondsPerFrame), frames_(std::move(earlier))
{
    makeFolder(folder_);
}

void Exporter::write(const ExportFrame& frame)
{
    frames_.push_back({frame.number, frame.time});
    if (formats_.vtp) writeVtp(frame);
    if (formats_.ply) writePly(frame);
    if (formats_.obj) writeWhole(folder_ / geometryFileName("frame", frame.number, "obj"), objFile(frame));
    if (formats_.usda) writeUsda(frame);
}

void Exporter::writeVtp(const ExportFrame& frame) const
{
    for (const ExportPart& part : frame.parts) {
        writeWhole(folder_ / geometryFileName(part.name, frame.number, kVtpExtension), vtpFile(part, frame.time));
        writeWhole(folder_ / (part.name + ".pvd"), pvdFile(part.name, frames_));
    }
}

void Exporter::writePly(const ExportFrame& frame) const
{
    for (const ExportPart& part : frame.parts) writeWhole(folder_ / geometryFileName(part.name, frame.number, "ply"), plyFile(part, frame.time));
}

void Exporter::writeUsda(const ExportFrame& frame) const
{
    writeWhole(folder_ / geometryFileName("frame", frame.number, "usda"), usdaFrame(frame, secondsPerFrame_));
    writeWhole(folder_ / kUsdaTopology, usdaTopology(frame.parts, secondsPerFrame_));
    writeWhole(folder_ / kUsdaAnimation, usdaAnimation(frames_, secondsPerFrame_));
}

}  // namespace app
