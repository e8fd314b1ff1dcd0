#pragma once

#include "app/scene/picture_settings.h"
#include "sim/scene/choice.h"
#include "sim/scene/range.h"
#include "sim/scene/units.h"

#include <algorithm>
#include <span>

// The one declaration of the keys of render, output and compare; see sim/scene/describe.h.

namespace app {

using sim::Choice;
using sim::Quantity;
using sim::Range;

inline std::span<const Choice<LiquidStyle>> choicesOf(LiquidStyle)
{
    static constexpr Choice<LiquidStyle> kAll[] = {
        {"points", LiquidStyle::Points}, {"spheres", LiquidStyle::Spheres}, {"surface", LiquidStyle::Surface}};
    return kAll;
}

inline std::span<const Choice<ColorBy>> choicesOf(ColorBy)
{
    static constexpr Choice<ColorBy> kAll[] = {{"speed", ColorBy::Speed}, {"pressure", ColorBy::Pressure}, {"flat", ColorBy::Flat}};
    return kAll;
}

inline std::span<const Choice<ColorMap>> choicesOf(ColorMap)
{
    static constexpr Choice<ColorMap> kAll[] = {{"jet", ColorMap::Jet}, {"turbo", ColorMap::Turbo}, {"viridis", ColorMap::Viridis}};
    return kAll;
}

inline std::span<const Choice<FabricColorBy>> choicesOf(FabricColorBy)
{
    static constexpr Choice<FabricColorBy> kAll[] = {{"material", FabricColorBy::Material},
                                                     {"speed", FabricColorBy::Speed},
                                                     {"strain", FabricColorBy::Strain},
                                                     {"saturation", FabricColorBy::Saturation}};
    return kAll;
}

inline std::span<const Choice<ObstacleStyle>> choicesOf(ObstacleStyle)
{
    static constexpr Choice<ObstacleStyle> kAll[] = {{"auto", ObstacleStyle::Auto},
                                                     {"wire", ObstacleStyle::Wire},
                                                     {"translucent", ObstacleStyle::Translucent},
                                                     {"solid", ObstacleStyle::Solid},
                                                     {"hidden", ObstacleStyle::Hidden}};
    return kAll;
}

inline std::span<const Choice<CompareLayout>> choicesOf(CompareLayout)
{
    static constexpr Choice<CompareLayout> kAll[] = {
        {"columns", CompareLayout::Columns}, {"rows", CompareLayout::Rows}, {"grid", CompareLayout::Grid}};
    return kAll;
}

template <class V>
void describeOrbit(V& v, CameraSettings& c)
{
    v.required("target", "the point to look at, like target: [0, 5, 0]");
    v.vector("target", c.lookAt, Quantity::Length, "Point to look at");
    v.required("distance", "how far the eye is from the target, like distance: 60");
    v.number("distance", c.distance, Quantity::Length, Range::above(0.0), "Distance of the eye from the target");
    v.number("azimuth", c.azimuthDegrees, Quantity::AngleDegrees, Range::any(), "Angle of the eye around the vertical");
    v.number("elevation", c.elevationDegrees, Quantity::AngleDegrees, Range::between(-89.0, 89.0), "Angle of the eye above the horizon");
    v.number("turn_per_s", c.turnDegreesPerSecond, Quantity::TurnRateDegrees, Range::any(), "Change of azimuth per simulated second");
}

template <class V>
void visitFields(V& v, CameraSettings& c)
{
    v.onlySupports("frame", "auto", {}, "Everything is in the picture");
    v.when(!c.orbit && !c.autoFrame, [&](auto& w) {
        w.vector("look_at", c.lookAt, Quantity::Length, "Point in the middle of the picture");
        w.vector("eye", c.eye, Quantity::Length, "Place of the camera");
    });
    v.when(c.orbit,
           [&](auto& w) { w.group("orbit", "Camera that goes around a point, in the place of eye", [&](auto& o) { describeOrbit(o, c); }); });
    v.vector("up", c.up, Quantity::None, "Direction that is up in the picture");
    v.number("fov", c.fovDegrees, Quantity::AngleDegrees, Range::between(1.0, 170.0), "Vertical field of view");
    v.require(c.up.norm() > 0.0, "up", "must be a direction, like [0, 1, 0]");
    v.whenReading([&](auto& r) {
        const bool isPlaced = r.has("look_at") || r.has("eye");
        c.orbit = r.has("orbit");
        c.autoFrame = !c.orbit && !isPlaced;
        r.require(!(isPlaced && c.orbit), "orbit", "goes without look_at and eye; keep one of them");
        r.require(!isPlaced || r.has("eye"), "look_at", "goes with eye; give both");
        r.require(!isPlaced || r.has("look_at"), "eye", "goes with look_at; give both");
        r.require(c.autoFrame || !r.has("frame"), "frame", "auto goes without look_at, eye and orbit");
        r.require(!isPlaced || (c.eye - c.lookAt).norm() > 0.0, "eye", "must not be the point it looks at");
    });
}

/// Values at the ends of the colours where a scene gives none: fast liquid, or a column of 10 cm of water [cm/s, or
/// dyn/cm^2].
inline std::array<double, 2> usualRange(ColorBy colorBy) { return colorBy == ColorBy::Pressure ? std::array{0.0, 1.0e4} : std::array{0.0, 200.0}; }

template <class V>
void describeLiquidLook(V& v, RenderSettings& r)
{
    v.choice("style", r.liquidStyle, "How liquid is drawn: particles as points or spheres, or the surface around them");
    v.choice("color_by", r.colorBy, "What the colour shows");
    v.choice("colormap", r.colorMap, "Colours from low to high");
    v.whenReading([&](auto&) { r.range = usualRange(r.colorBy); });
    v.pair("range", r.range, r.colorBy == ColorBy::Pressure ? Quantity::Pressure : Quantity::Velocity, Range::any(),
           "Values at the ends of the colours");
    v.require(r.range[0] < r.range[1], "range", "must end above its beginning");
}

/// Values at the ends of the colours where a scene gives none [cm/s, or -].
inline std::array<double, 2> usualRange(FabricColorBy colorBy)
{
    return colorBy == FabricColorBy::Speed ? std::array{0.0, 100.0} : colorBy == FabricColorBy::Strain ? std::array{0.0, 0.1} : std::array{0.0, 1.0};
}

template <class V>
void describeFabricLook(V& v, FabricLookSettings& f)
{
    const bool byMaterial = f.colorBy == FabricColorBy::Material;
    v.choice("color_by", f.colorBy,
             "What the colour shows; strain is the largest stretch of what meets at a vertex, "
             "saturation how full its pores are");
    v.when(f.ownColor, [&](auto& w) { w.color("color", f.color, "Red, green, blue, 0 to 1; left out: one for each material"); });
    v.when(!byMaterial, [&](auto& w) {
        w.choice("colormap", f.colorMap, "Colours from low to high");
        w.whenReading([&](auto&) { f.range = usualRange(f.colorBy); });
        w.pair("range", f.range, f.colorBy == FabricColorBy::Speed ? Quantity::Velocity : Quantity::None, Range::any(),
               "Values at the ends of the colours");
        w.require(f.range[0] < f.range[1], "range", "must end above its beginning");
    });
    v.color("wet_color", f.wetColor, "Colour of soaked fabric, color_by material");
    v.whenReading([&](auto& r) {
        f.ownColor = r.has("color");
        const bool isMapped = f.colorBy != FabricColorBy::Material;
        r.require(!isMapped || !r.has("color"), "color", "goes with color_by: material");
        for (const char* key : {"colormap", "range"}) r.require(isMapped || !r.has(key), key, "goes with color_by: speed, strain or saturation");
    });
}

template <class V>
void visitFields(V& v, RenderSettings& r)
{
    v.pixels("size", r.width, r.height, 16, 16384, "Width and height of the picture in pixels");
    v.color("background", r.background, "Red, green, blue, 0 to 1");
    v.section("camera", r.camera, "From where it is seen");
    v.group("liquid", "Liquid in pictures", [&](auto& w) { describeLiquidLook(w, r); });
    v.group("cloth", "Cloth in pictures", [&](auto& w) { describeFabricLook(w, r.cloth); });
    v.group("yarns", "Yarns in pictures", [&](auto& w) {
        describeFabricLook(w, r.yarns);
        w.integer("tube_sides", r.yarns.tubeSides, 3, 64, "Sides of yarns near the camera; distant ones have fewer");
    });
    v.group("obstacles", "Solids in pictures", [&](auto& w) {
        w.choice("style", r.obstacleStyle, "How obstacles are drawn; auto: solid where there is fabric, else translucent");
        w.number("opacity", r.obstacleOpacity, Quantity::None, Range::between(0.0, 1.0), "0 = invisible, 1 = solid");
    });
    v.flag("hud", r.hud, "Label and time stamp in the picture");
    v.flag("colorbar", r.colorBar, "A bar that explains the colours");
    v.integer("samples", r.samples, 1, 16, "Samples per pixel and axis of smooth edges, 1 = off");
}

inline bool isCodecName(const std::string& name)
{
    const auto isAllowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
    return !name.empty() && name[0] != '-' && std::all_of(name.begin(), name.end(), isAllowed);
}

template <class V>
void visitFields(V& v, OutputSettings& o)
{
    v.text("dir", o.dir, "Folder of the results; left out: out/<name>/<variant>");
    v.number("every", o.every, Quantity::Time, Range::above(0.0), "Simulated time from picture to picture");
    v.either("frames", o.frames, "png", "none", "Pictures of every frame");
    v.flags("data",
            {{"energy", &o.energy},
             {"stats", &o.stats},
             {"ledger", &o.ledger},
             {"geometry", &o.geometry},
             {"states", &o.states},
             {"checkpoint", &o.checkpoint}},
            "Data files of a run beside report.json: energy.csv, steps.jsonl, energy_ledger.csv (where energy goes; slow), "
            "geometry/, the state of every frame for drench render and export, checkpoints to go on from");
    v.group("checkpoint", "States to go on from", [&](auto& w) {
        w.number("every", o.checkpointEvery, Quantity::Time, Range::above(0.0), "Simulated time from checkpoint to checkpoint, in whole frames");
        w.integer("keep", o.checkpointKeep, 0, 1'000'000, "The last so many are kept, 0: all");
    });
    GeometryFormats& formats = o.geometryFormats;
    v.flags("geometry_format", {{"vtp", &formats.vtp}, {"ply", &formats.ply}, {"obj", &formats.obj}, {"usda", &formats.usda}},
            "Files of data: geometry: vtp (ParaView), ply, obj, usda");
    v.flag("geometry_surface", o.geometrySurface, "A mesh of the liquid's surface in them, too");
    v.require(formats.any(), "geometry_format", "names no format; there is vtp, ply, obj, usda");
    v.other("probes", "What is read as the run goes, into probes.csv");
    v.group("video", "The video of all pictures", [&](auto& w) {
        w.number("fps", o.videoFps, Quantity::None, Range::aboveTo(0.0, 1000.0), "Pictures per second of the video");
        w.text("codec", o.videoCodec, "Video codec, as ffmpeg names it");
        w.require(isCodecName(o.videoCodec), "codec", "may have letters, digits, _ and - only, like libx264");
    });
}

template <class V>
void visitFields(V& v, Tolerance& t)
{
    const Range share = Range::between(0.0, 1.0);
    v.number("mean_ssim", t.pictures.meanSsim, Quantity::None, share, "Pictures: mean structural similarity, at least");
    v.number("lowest_ssim", t.pictures.lowestSsim, Quantity::None, Range::between(-1.0, 1.0), "Pictures: lowest similarity of a window, at least");
    v.number("pixels", t.pictures.pixels, Quantity::None, share, "Pictures: share of pixels that differ by more than 4 of 255, at most");
    v.integer("largest", t.pictures.largest, 0, 255, "Pictures: largest difference of a channel, of 255; 0 = the same to the last bit");
    v.number("series", t.series, Quantity::None, Range::atLeast(0.0),
             "Numbers in logs and reports: difference relative to the largest of the column, at most");
    v.texts("ignore", t.ignore, "Columns that are not judged, each with those below it: [iterations, fabric]");
    v.number("position", t.position, Quantity::Length, Range::atLeast(0.0), "Particles and vertices, by id: difference of positions, at most");
    v.number("velocity", t.velocity, Quantity::Velocity, Range::atLeast(0.0), "Particles and vertices: difference of velocities, at most");
    v.number("mass", t.mass, Quantity::Mass, Range::atLeast(0.0), "Particles, and what vertices have absorbed: difference of masses, at most");
}

template <class V>
void visitFields(V& v, CompareSettings& c)
{
    v.text("name", c.name, "Name of the comparison; left out: the scene's");
    v.other("variants", "The runs to compare");
    v.choice("layout", c.layout, "How pictures stand side by side");
    v.flags("products", {{"video", &c.video}, {"sheet", &c.sheet}, {"energy_plot", &c.energyPlot}, {"table", &c.table}}, "What is made of the runs");
    v.onlySupports("sync", "time", {}, "Pictures of equal simulated time stand side by side");
    v.text("reference", c.reference, "Label of the variant the others are held against");
    v.section("tolerance", c.tolerance, "What drench diff takes for the same");
}

}  // namespace app
