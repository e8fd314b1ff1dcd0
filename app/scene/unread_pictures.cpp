#include "app/scene/unread_pictures.h"

#include "sim/scene/unread_settings.h"

#include <set>

namespace app {

namespace {

/// What reads a key, or all below it, and whether it is there.
struct PictureReader {
    std::string path;
    bool isThere;
    std::string what;
};

void addFabricLook(const std::string& path, bool isThere, const FabricLookSettings& look, std::vector<PictureReader>& readers)
{
    readers.push_back({path, isThere, path == "render.cloth" ? "fabrics of cloth" : "fabrics of yarns"});
    readers.push_back({path + ".wet_color", look.colorBy == FabricColorBy::Material, path + ".color_by material"});
}

/// Is there anything whose colours a bar explains?
bool hasColorBar(const SceneContents& contents, const RenderSettings& r)
{
    return (contents.liquid && r.colorBy != ColorBy::Flat) || (contents.cloth && r.cloth.colorBy != FabricColorBy::Material) ||
           (contents.yarns && r.yarns.colorBy != FabricColorBy::Material);
}

/// Are there faces that one sees through?
bool hasGlass(const SceneContents& contents, ObstacleStyle style)
{
    if (style == ObstacleStyle::Wire || style == ObstacleStyle::Hidden) return false;
    const bool isSolid = style == ObstacleStyle::Solid || (style == ObstacleStyle::Auto && contents.fabric());
    return !isSolid || contents.rooms;
}

std::vector<PictureReader> readersOf(const PictureSettings& settings)
{
    const SceneContents& contents = settings.contents;
    const RenderSettings& r = settings.render;
    const OutputSettings& o = settings.output;
    const CompareSettings& c = settings.compare;
    std::vector<PictureReader> readers;
    readers.push_back({"render.liquid", contents.liquid, "liquid"});
    for (const char* path : {"render.liquid.colormap", "render.liquid.range"})
        readers.push_back({path, r.colorBy != ColorBy::Flat, "render.liquid.color_by speed and pressure"});
    addFabricLook("render.cloth", contents.cloth, r.cloth, readers);
    addFabricLook("render.yarns", contents.yarns, r.yarns, readers);
    readers.push_back({"render.obstacles", contents.obstacles, "obstacles"});
    readers.push_back(
        {"render.obstacles.opacity", hasGlass(contents, r.obstacleStyle), "render.obstacles.style translucent, and solid with inside: true"});
    readers.push_back({"render.colorbar", hasColorBar(contents, r), "a color_by that shows a number"});
    readers.push_back({"output.checkpoint.every", o.checkpoint, "output.data checkpoint"});
    readers.push_back({"output.checkpoint.keep", o.checkpoint, "output.data checkpoint"});
    readers.push_back({"output.geometry_format", o.geometry, "output.data geometry"});
    readers.push_back({"output.geometry_surface", o.geometry, "output.data geometry"});
    readers.push_back({"output.video", o.frames, "output.frames png"});
    for (const char* path : {"compare.name", "compare.layout", "compare.products", "compare.reference"})
        readers.push_back({path, !c.variants.empty(), "compare.variants"});
    readers.push_back({"compare.layout", c.video || c.sheet, "compare.products video and sheet"});
    readers.push_back({"compare.reference", c.table, "compare.products table"});
    return readers;
}

}  // namespace

std::vector<std::string> unreadPictureNotes(const sim::Node& root, const PictureSettings& settings)
{
    std::vector<std::string> notes;
    std::set<std::string> told;
    for (const PictureReader& reader : readersOf(settings)) {
        const sim::Node* given = reader.isThere ? nullptr : sim::nodeAt(root, reader.path);
        if (!given || !(reader.path.starts_with("compare.") || sim::isOfThisRun(root, *given))) continue;
        if (told.contains(reader.path.substr(0, reader.path.rfind('.'))) || !told.insert(reader.path).second) continue;  // all above it, or it
        notes.push_back(sim::unreadNote(*given, reader.path, reader.what));
    }
    return notes;
}

}  // namespace app
