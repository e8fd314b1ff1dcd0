// No key of pictures and files is silently without effect: of each it is known what reads it, and where nothing does that is told.
#include "app/scene/unread_pictures.h"
#include "app/scene/read_picture_settings.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace app {
namespace {

constexpr SceneContents kAll{.liquid = true, .yarns = true, .cloth = true, .obstacles = true, .rooms = true};
constexpr SceneContents kNothing{.liquid = false, .yarns = false, .cloth = false, .obstacles = false, .rooms = false};

std::vector<std::string> notesOn(const std::string& text, const SceneContents& contents, const std::vector<std::string>& set = {})
{
    const sim::SceneFile file = sim::sceneFileFromText(text, "unread.yaml", {"", set});
    PictureSettings settings = readPictureSettings(file);
    settings.contents = contents;
    return unreadPictureNotes(file.root, settings);
}

/// Where a key that is given is in vain: what else the command line says, and what there is; "" where it always acts.
struct InVain {
    std::vector<std::string> with = {};
    const SceneContents& contents = kAll;
    std::string lacking = "";
};

const std::string kFlat = "render.liquid.color_by=flat", kSpeed = "render.liquid.color_by speed and pressure",
                  kNumber = "a color_by that shows a number", kCloth = "fabrics of cloth", kYarns = "fabrics of yarns",
                  kCheckpoint = "output.data checkpoint", kGeometry = "output.data geometry", kVariants = "compare.variants";

const std::map<std::string, InVain> kKeys = {
    {"render.size", {}},
    {"render.background", {}},
    {"render.hud", {}},
    {"render.samples", {}},
    {"render.camera.up", {}},
    {"render.camera.fov", {}},
    {"render.camera.frame", {}},
    {"output.every", {}},
    {"output.frames", {}},
    {"output.data", {}},
    {"compare.sync", {}},
    {"render.liquid.style", {{}, kNothing, "liquid"}},
    {"render.liquid.color_by", {{}, kNothing, "liquid"}},
    {"render.liquid.colormap", {{kFlat}, kAll, kSpeed}},
    {"render.liquid.range", {{kFlat}, kAll, kSpeed}},
    {"render.cloth.color_by", {{}, kNothing, kCloth}},
    {"render.cloth.wet_color", {{"render.cloth.color_by=speed"}, kAll, "render.cloth.color_by material"}},
    {"render.yarns.color_by", {{}, kNothing, kYarns}},
    {"render.yarns.wet_color", {{"render.yarns.color_by=speed"}, kAll, "render.yarns.color_by material"}},
    {"render.yarns.tube_sides", {{}, kNothing, kYarns}},
    {"render.obstacles.style", {{}, kNothing, "obstacles"}},
    {"render.obstacles.opacity", {{"render.obstacles.style=wire"}, kAll, "render.obstacles.style translucent, and solid with inside: true"}},
    {"render.colorbar", {{kFlat}, kAll, kNumber}},
    {"output.checkpoint.every", {{"output.data=[energy]"}, kAll, kCheckpoint}},
    {"output.checkpoint.keep", {{"output.data=[energy]"}, kAll, kCheckpoint}},
    {"output.geometry_format", {{"output.data=[energy]"}, kAll, kGeometry}},
    {"output.geometry_surface", {{"output.data=[energy]"}, kAll, kGeometry}},
    {"output.video.fps", {{"output.frames=none"}, kAll, "output.frames png"}},
    {"output.video.codec", {{"output.frames=none"}, kAll, "output.frames png"}},
    {"compare.layout", {{}, kAll, kVariants}},
    {"compare.products", {{}, kAll, kVariants}},
    {"compare.tolerance.mean_ssim", {}},
    {"compare.tolerance.lowest_ssim", {}},
    {"compare.tolerance.pixels", {}},
    {"compare.tolerance.largest", {}},
    {"compare.tolerance.series", {}},
    {"compare.tolerance.ignore", {}},
    {"compare.tolerance.position", {}},
    {"compare.tolerance.velocity", {}},
    {"compare.tolerance.mass", {}},
};

/// The keys of printed sections, with what is given them.
std::map<std::string, std::string> keysOf(const std::string& printed)
{
    std::map<std::string, std::string> keys;
    std::vector<std::string> above;
    std::istringstream in(printed);
    for (std::string line; std::getline(in, line);) {
        line = line.substr(0, line.find(" #"));
        const std::size_t begin = line.find_first_not_of(' '), colon = line.find(':');
        if (begin == std::string::npos || line[begin] == '#' || colon == std::string::npos) continue;
        above.resize(begin / 2);
        above.push_back(line.substr(begin, colon - begin));
        std::string path;
        for (const std::string& part : above) path += (path.empty() ? "" : ".") + part;
        const std::size_t value = line.find_first_not_of(' ', colon + 1);
        if (value != std::string::npos) keys[path] = line.substr(value, line.find_last_not_of(' ') + 1 - value);
    }
    return keys;
}

TEST(UnreadPictures, OfEveryKeyItIsToldWhereNothingReadsIt)
{
    const std::map<std::string, std::string> keys =
        keysOf(printPictureSettings(readPictureSettings(sim::sceneFileFromText("grid: {cell: 1}\n", "all.yaml"))));
    EXPECT_GT(keys.size(), 25u);
    for (const auto& [key, value] : keys) {
        ASSERT_TRUE(kKeys.contains(key)) << key << ": what reads it?";
        const InVain& inVain = kKeys.at(key);
        std::vector<std::string> set = inVain.with;
        set.push_back(key + "=" + value);
        const auto isAboutKey = [&](const std::string& note) {
            const std::string path = note.substr(note.find(": ") + 2);
            return key.starts_with(path.substr(0, path.find(':'))) && note.ends_with("it goes with " + inVain.lacking);
        };
        const std::vector<std::string> notes = notesOn("grid: {cell: 1}\n", inVain.contents, set);
        EXPECT_EQ(std::ranges::count_if(notes, isAboutKey), inVain.lacking.empty() ? 0 : 1) << set.back();
    }
}

TEST(UnreadPictures, NothingIsToldOfWhatActs)
{
    EXPECT_TRUE(
        notesOn("render: {liquid: {range: [0, 1]}, cloth: {wet_color: [0, 0, 1]}, yarns: {tube_sides: 5}, obstacles: {opacity: 1}, colorbar: false}\n"
                "output: {data: [energy, checkpoint, geometry], checkpoint: {keep: 2}, geometry_surface: true, video: {fps: 25}}\n"
                "compare: {variants: {transfer.method: [pic, apic]}, layout: rows, reference: pic}\n",
                kAll)
            .empty());
}

TEST(UnreadPictures, AreNamedByTheirLine)
{
    EXPECT_EQ(notesOn("render:\n  liquid: {color_by: flat, range: [0, 1]}\n", kAll),
              std::vector<std::string>{"unread.yaml:2: render.liquid.range: has no effect here; it goes with " + kSpeed});
    EXPECT_EQ(notesOn("render: {yarns: {tube_sides: 5, wet_color: [0, 0, 1], color_by: speed}}\n", kNothing),
              std::vector<std::string>{"unread.yaml:1: render.yarns: has no effect here; it goes with " + kYarns});
    EXPECT_EQ(notesOn("compare: {variants: {transfer.method: [pic, apic]}, layout: rows, products: [table]}\n", kAll),
              std::vector<std::string>{"unread.yaml:1: compare.layout: has no effect here; it goes with compare.products video and sheet"});
    // What is solid is seen through from within alone.
    constexpr SceneContents kBall{.liquid = true, .yarns = true, .cloth = true, .obstacles = true, .rooms = false};
    EXPECT_EQ(notesOn("render: {obstacles: {opacity: 1}}\n", kBall).size(), 1u);
}

}  // namespace
}  // namespace app
