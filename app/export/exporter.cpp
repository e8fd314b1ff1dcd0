#include "app/export/exporter.h"

#include "app/export/geometry_files.h"
#include "app/output_files.h"

namespace app {

Exporter::Exporter(std::filesystem::path folder, const GeometryFormats& formats)
    : folder_(std::move(folder)), formats_(formats)
{
    std::filesystem::create_directories(folder_);
}

void Exporter::write(const ExportFrame& frame)
{
    if (formats_.vtp) writeVtp(frame);
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

}  // namespace app
