#include "sim/scene/fabric_presets.h"

#include "sim/core/units.h"
#include "sim/scene/section_reader.h"

#include <cmath>

// Sources of the table: behind each row stands a letter for each of its columns; e marks an estimate, in the middle of what is usual.
//
// F  Feng, Huang, Xu and Wang 2022, "Learning-based bending stiffness parameter estimation by a drape tester", 618 fabrics: from the tenth
//    to the ninetieth percent mass is 0.0059 to 0.042 g/cm^2 and (B/mass g)^(1/3) is 1.23 to 3.07 cm. Estimates lie inside.
// K  Matsudaira 2015, J. Text. Eng. 61(6) 69-73: cotton broad, wool tropical, bent by Kawabata's tester; one number for warp and weft. Second-hand.
// M  Morton and Hearle, "Physical Properties of Textile Fibres": densities; diameters are typical ones of the kind (jersey: cotton and polyester).
// P  Penava, Simic Penava and Knezic 2014, "Determination of the elastic constants of plain woven fabrics": cotton, wool. Second-hand.
// W  Wang, O'Brien and Ramamoorthi 2011, "Data-driven elastic models for cloth", as their files have it at the smallest strain and curvature:
//    11oz-black-denim, gray-interlock, tango-red-jet-set, and for cotton_broadcloth royal-target (65 % cotton). Their first axis is read as the
//    weft, for along it denim with spandex stretches.
//
// A modulus of 1 N/m is 1e3 dyn/cm, a stiffness of 1 N m is 1e7 dyn cm, a shear stiffness of Kawabata's 1 gf/(cm deg) is 5.6e4 dyn/cm.

namespace sim {

std::span<const FabricPreset> fabricPresets()
{
    // clang-format off
    static constexpr FabricPreset kAll[] = {
        // mass, thickness, density and diameter of fibres; stretch, shear; bending; poisson, friction
        {"cotton_broadcloth", 0.01503, 0.0318, 1.54, 0.0013, {2.03e6, 2.02e6}, 5.6e4,  {115.7, 115.7}, 0.243, 0.55}, // P P M M W e K P e
        {"denim",             0.0324,  0.07,   1.54, 0.0013, {1.01e6, 2.05e5}, 5.3e4,  {642.0, 198.2}, 0.022, 0.6}, // W e M M W W W W e
        {"wool",              0.02348, 0.0568, 1.31, 0.0021, {1.0e6, 6.0e5},   3.4e4,  {65.7, 65.7},   0.277, 0.5}, // P P M M e e K P e
        {"silk",              0.0065,  0.015,  1.34, 0.0012, {1.0e6, 6.0e5},   1.7e4,  {30.0, 25.0},   0.3,   0.3}, // e e M M e e e e e
        {"polyester",         0.0113,  0.02,   1.39, 0.0013, {1.71e5, 4.31e4}, 1.43e4, {142.9, 183.6}, 0.3,   0.35}, // W e M M W W W e e
        {"jersey",            0.0187,  0.07,   1.48, 0.0013, {3.45e4, 1.66e4}, 3.69e4, {231.9, 233.8}, 0.3,   0.6}, // W e M M W W W e e
        {"terry",             0.04,    0.3,    1.54, 0.0015, {1.0e6, 5.0e5},   3.0e4,  {310.0, 230.0}, 0.2,   0.7}, // e e M M e e e e e
        {"felt",              0.03,    0.12,   1.31, 0.0024, {1.0e6, 1.0e6},   4.0e5,  {600.0, 600.0}, 0.25,  0.5}, // e e M M e e e e e
    };
    // clang-format on
    return kAll;
}

std::vector<std::string> fabricPresetNames()
{
    std::vector<std::string> names;
    for (const FabricPreset& preset : fabricPresets()) names.emplace_back(preset.name);
    return names;
}

/// The modulus is that of a sheet which stretches as the fabric does in the mean of warp and weft.
FabricMaterial FabricPreset::material() const
{
    FabricMaterial m;
    m.volumeFraction = volumeFraction();
    m.density = fibreDensity;
    m.young = std::sqrt(stretch[0] * stretch[1]) / (m.packing() * thickness);
    m.poisson = poisson;
    m.frictionAngle = std::atan(friction);
    m.thickness = thickness;
    m.stretchStiffness = stretch;
    m.shearStiffness = shear;
    m.bendingStiffness = bending;
    return m;
}

const FabricPreset* fabricPresetOf(const SectionReader& section)
{
    const Node* node = section.find("preset");
    return node ? &fabricPresets()[readChoice(*node, section.pathOf("preset"), fabricPresetNames())] : nullptr;
}

void readFabricPreset(const SectionReader& section, FabricMaterial& material)
{
    const FabricPreset* preset = fabricPresetOf(section);
    if (!preset) return;
    material = preset->material();
    if (!section.has("young")) return;
    material.stretchStiffness.fill(0.0);
    material.shearStiffness = 0.0;
    material.bendingStiffness.fill(0.0);
}

}  // namespace sim
