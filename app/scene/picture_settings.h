#pragma once

#include "app/scene/tolerance.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

// What a scene file says about pictures and files: the sections render, output, compare. sim/ knows nothing of them.

namespace app {

struct CameraSettings {
    bool autoFrame = true;                             ///< Frame everything; false once look_at and eye are given
    Eigen::Vector3d lookAt = Eigen::Vector3d::Zero();  ///< [cm]
    Eigen::Vector3d eye = {0.0, 0.0, 1.0};             ///< [cm]
    Eigen::Vector3d up = Eigen::Vector3d::UnitY();
    double fovDegrees = 40.0;  ///< vertical field of view [deg]
    bool orbit = false;        ///< camera.orbit was given: lookAt is its target
    double distance = 0.0, azimuthDegrees = 0.0, elevationDegrees = 0.0, turnDegreesPerSecond = 0.0;
};

enum class LiquidStyle { Points, Spheres, Surface };
enum class ColorBy { Speed, Pressure, Flat };
enum class ColorMap { Jet, Turbo, Viridis };
enum class FabricColorBy { Material, Speed, Strain, Saturation };
enum class ObstacleStyle { Auto, Wire, Translucent, Solid, Hidden };

struct FabricLookSettings {
    FabricColorBy colorBy = FabricColorBy::Material;
    bool ownColor = false;  ///< color was given; else each material has one of a palette
    Eigen::Vector3f color = {0.80f, 0.70f, 0.55f};
    Eigen::Vector3f wetColor = {0.10f, 0.20f, 0.60f};
    ColorMap colorMap = ColorMap::Viridis;
    std::array<double, 2> range = {0.0, 100.0};  ///< range of the colour bar [cm/s], or of strain or saturation [-]
};

struct YarnLookSettings : FabricLookSettings {
    int tubeSides = 10;  ///< number of sides of tubes near the camera
};

struct RenderSettings {
    int width = 960, height = 540;  ///< [pixels]
    Eigen::Vector3f background = Eigen::Vector3f::Ones();
    CameraSettings camera;
    LiquidStyle liquidStyle = LiquidStyle::Spheres;
    ColorBy colorBy = ColorBy::Speed;
    ColorMap colorMap = ColorMap::Jet;
    std::array<double, 2> range = {0.0, 200.0};  ///< range of the colour bar [cm/s], or of pressure [dyn/cm^2]
    FabricLookSettings cloth;
    YarnLookSettings yarns;
    ObstacleStyle obstacleStyle = ObstacleStyle::Auto;
    double obstacleOpacity = 0.15;
    bool hud = true;  ///< label and time stamp in the picture
    bool colorBar = true;
    int samples = 4;  ///< multisampling, 1 = off
};

/// Files that geometry is written as.
struct GeometryFormats {
    bool vtp = true;  ///< ParaView, with .pvd
    bool ply = false, obj = false, usda = false;

    bool any() const { return vtp || ply || obj || usda; }
};

struct OutputSettings {
    std::string dir;                   ///< default out/<name>/<variant>
    double every = 4.0e-3;             ///< simulated time per frame [s]
    bool frames = true;                ///< write frame_00000.png, …
    bool energy = true, stats = true;  ///< energy.csv, steps.jsonl
    bool ledger = false;               ///< energy_ledger.csv
    bool states = false;               ///< the state of every frame, to make pictures of it again
    bool checkpoint = false;           ///< write states to resume from
    double checkpointEvery = 0.25;     ///< simulated time between those states [s]
    int checkpointKeep = 1;            ///< number of the last of those states that are kept; 0: all
    bool geometry = false;             ///< write geometry/ with every frame's liquid, fabric and obstacles
    GeometryFormats geometryFormats;   ///< formats of the geometry files
    bool geometrySurface = false;      ///< whether geometry has a mesh of the liquid's surface
    std::string probes;                ///< the section of what is read as a run goes, on one line; empty: none
    double videoFps = 50.0;
    std::string videoCodec = "libx264";
};

enum class CompareLayout { Columns, Rows, Grid };

/// One variant of the scene: a name, a label and dotted overrides as they would stand behind --set.
struct Variant {
    std::string name;  ///< [a-z0-9_]+: its folder and what --variant takes
    std::string label;
    std::vector<std::string> overrides;  ///< "transfer.method=apic", …
};

struct CompareSettings {
    std::string name;  ///< name of the comparison; empty: the scene's
    std::vector<Variant> variants;
    CompareLayout layout = CompareLayout::Columns;
    bool video = true, sheet = false, energyPlot = true, table = true;
    std::string reference;  ///< label of the baseline, if any
    Tolerance tolerance;    ///< differences within which drench diff takes results for equal
};

/// What there is to draw in the scene that the settings belong to.
struct SceneContents {
    bool liquid = true, yarns = false, cloth = false;
    bool obstacles = true, rooms = true;  ///< rooms: of the obstacles some are `inside: true`
    bool fabric() const { return yarns || cloth; }
};

struct PictureSettings {
    SceneContents contents;  ///< not read from the sections, but told by who knows the whole scene
    RenderSettings render;
    OutputSettings output;
    CompareSettings compare;
};

}  // namespace app
