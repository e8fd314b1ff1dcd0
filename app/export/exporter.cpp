#include "app/export/exporter.h"

#include "app/export/geometry_files.h"
#include "app/output_files.h"

namespace app {

Exporter::Exporter(std::filesystem::path folder, const GeometryFormats& formats, std::function<double(std::int64_t)> timeOf)
    : folder_(std::move(folder)), formats_(formats), timeOf_(std::move(timeOf))
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
        const auto [found, isNew] = collections_.try_emplace(part.name);
        auto& files = found->second;
        if (isNew)
            for (const std::int64_t n : numbersIn(folder_, part.name + "_", ".vtp"))
                if (n < frame.number) files.push_back({timeOf_(n), geometryFileName(part.name, n, "vtp")});
        files.push_back({frame.time, name});
        writeWhole(folder_ / (part.name + ".pvd"), pvdFile(files));
    }
}

}  // namespace app
