#include "tests/sim/scene/bad_scene.h"

// Sections of later versions, pictures and products.

namespace {

const BadScene kBadScenes[] = {
    {"Coupling", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
coupling: {cohesion: {strength: -1}}
)",
     "bad.yaml:3: coupling.cohesion.strength: \"-1\" is out of range; must be at least 0"},
    {"CohesionWithSolverGrid", R"(grid: {cell: 0.1}
materials: {wool: {young: 1.0e+6}}
fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 3, radius: 0.05}}]
fabric: {solver: grid}
coupling: {cohesion: {strength: 1}}
)",
     "bad.yaml:5: coupling.cohesion: fabric.solver grid has none; choose fabric.solver: vertex, or strength: 0"},
    {"CohesionWithoutContact", R"(grid: {cell: 0.1}
materials: {wool: {young: 1.0e+6}}
fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 3, radius: 0.05}}]
fabric: {contact: false}
coupling: {cohesion: {strength: 1}}
)",
     "bad.yaml:5: coupling.cohesion: acts where fabric touches, and fabric.contact is false; set that true, or strength: 0"},
    {"CohesionOfNothing", R"(grid: {cell: 0.1}
materials: {wool: {young: 1.0e+6}}
fabrics: [{strand: {material: wool, from: [0, 0, 0], to: [1, 0, 0], segments: 3, radius: 0.05}}]
coupling: {cohesion: {strength: 1, fabric: false, obstacle: false}}
)",
     "bad.yaml:4: coupling.cohesion: holds neither fabric nor obstacle; set one of them true, or strength: 0"},
    {"Sinks", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
sinks: []
)",
     "bad.yaml:3: sinks: liquid goes out through an outlet in liquid.openings; domain deletes what falls out of a shape"},
    {"SceneName", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
scene: {name: Dam Break!}
)",
     "bad.yaml:3: scene.name: \"Dam Break!\" may have a-z, 0-9 and _ only; dam_break_ would do"},
    {"TagsIsWord", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
scene: {tags: paper}
)",
     "bad.yaml:3: scene.tags: needs a list of words, not \"paper\""},
    {"IncludeIsNumberMap", R"(include: {a: 1}
grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
)",
     "bad.yaml:1: include names files, like [dam_break.yaml], not a map"},
    {"RenderUnknownKey", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {colour: 1}
)",
     "bad.yaml:3: unknown key \"colour\" in render (there is size, background, camera, liquid, cloth, yarns, obstacles, hud, colorbar, "
     "samples)"},
    {"RenderSurface", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {liquid: {style: surfaces}}
)",
     "bad.yaml:3: render.liquid.style: \"surfaces\" is unknown (did you mean \"surface\"?)"},
    {"RenderYarns", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {yarns: {tube_sides: 2}}
)",
     "bad.yaml:3: render.yarns.tube_sides: 2 is out of range; must be 3 to 64"},
    {"RenderYarnsColorBy", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {yarns: {color_by: stain}}
)",
     "bad.yaml:3: render.yarns.color_by: \"stain\" is unknown (did you mean \"strain\"?)"},
    {"RenderLiquidSaturation", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {liquid: {color_by: saturation}}
)",
     "bad.yaml:3: render.liquid.color_by: \"saturation\" is unknown (there is speed, pressure, flat)"},
    {"RenderPressureInSpeeds", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {liquid: {color_by: pressure, range: [0, 2 cm/s]}}
)",
     "bad.yaml:3: render.liquid.range: \"2 cm/s\" is a velocity, needs a pressure (in dyn/cm^2)"},
    {"RenderClothColorAndStrain", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {cloth: {color_by: strain, color: [1, 0, 0]}}
)",
     "bad.yaml:3: render.cloth.color: goes with color_by: material"},
    {"RenderSize", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {size: [960]}
)",
     "bad.yaml:3: render.size: needs a list of 2 whole numbers, like [960, 540], not a list of 1"},
    {"RenderSizeZero", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {size: [0, 540]}
)",
     "bad.yaml:3: render.size: 0 is out of range; must be 16 to 16384"},
    {"BackgroundOutOfRange", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {background: [255, 255, 255]}
)",
     "bad.yaml:3: render.background: \"255\" is out of range; must be 0 to 1"},
    {"RangeBackwards", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {liquid: {range: [200, 0]}}
)",
     "bad.yaml:3: render.liquid.range: must end above its beginning"},
    {"EyeWithoutLookAt", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {camera: {eye: [0, 0, 1]}}
)",
     "bad.yaml:3: render.camera.eye: goes with look_at; give both"},
    {"OrbitAndEye", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
render: {camera: {eye: [0, 0, 1], look_at: [0, 0, 0], orbit: {target: [0, 0, 0], distance: 5}}}
)",
     "bad.yaml:3: render.camera.orbit: goes without look_at and eye; keep one of them"},
    {"OutputCheckpoints", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {data: [energy, checkpoints]}
)",
     "bad.yaml:3: output.data: \"checkpoints\" is unknown (did you mean \"checkpoint\"?)"},
    {"OutputCheckpointOften", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {checkpoint: {every: 0}}
)",
     "bad.yaml:3: output.checkpoint.every: \"0\" is out of range; must be above 0 s"},
    {"GeometryFormatUnknown", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {data: [geometry], geometry_format: [vtp, ply2]}
)",
     "bad.yaml:3: output.geometry_format: \"ply2\" is unknown (did you mean \"ply\"?)"},
    {"GeometryFormatNone", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {data: [geometry], geometry_format: []}
)",
     "bad.yaml:3: output.geometry_format: names no format; there is vtp, ply, obj, usda"},
    {"GeometryFormatNoList", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {geometry_format: vtp}
)",
     "bad.yaml:3: output.geometry_format: needs a list of words, not \"vtp\""},
    {"OutputDataUnknown", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {data: [enrgy]}
)",
     "bad.yaml:3: output.data: \"enrgy\" is unknown (did you mean \"energy\"?)"},
    {"EnergyPlotWithoutEnergy", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {data: [stats]}
compare: {products: [energy_plot], variants: {transfer.method: [pic, apic]}}
)",
     "bad.yaml:3: output.data: has no energy, which compare.products: energy_plot draws; add energy, or take energy_plot out"},
    {"OutputEveryZero", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {every: 0}
)",
     "bad.yaml:3: output.every: \"0\" is out of range; must be above 0 s"},
    {"OutputFrames", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {frames: jpg}
)",
     "bad.yaml:3: output.frames: \"jpg\" is unknown (there is png, none)"},
    {"Codec", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
output: {video: {codec: 'x; rm'}}
)",
     "bad.yaml:3: output.video.codec: may have letters, digits, _ and - only, like libx264"},
    {"ReferenceUnknown", R"(grid: {cell: 0.1}
liquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}
compare: {variants: {transfer.method: [pic, apic]}, reference: apicc}
)",
     "bad.yaml:3: compare.reference: \"apicc\" is the label of no variant (did you mean \"apic\"?)"},
};

class BadPictures : public testing::TestWithParam<BadScene> {};

TEST_P(BadPictures, NameLocationFaultAndRemedy) { expectItsMessage(GetParam()); }

INSTANTIATE_TEST_SUITE_P(LoadScene, BadPictures, testing::ValuesIn(kBadScenes), [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
