#pragma once

#include "sim/fabric/pieces/piece.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace sim {

/// A common fabric, as it is measured: by its area, with its thickness between the plates of a gauge.
struct FabricPreset {
    const char* name;
    double mass;                    ///< per area [g/cm^2]
    double thickness;               ///< [cm]
    double fibreDensity;            ///< [g/cm^3]
    double fibreDiameter;           ///< [cm]
    std::array<double, 2> stretch;  ///< force per width and strain along warp and weft [dyn/cm]
    double shear;                   ///< force per width and angle [dyn/cm]
    std::array<double, 2> bending;  ///< moment per width and curvature, warp and weft bent [dyn cm]
    double poisson;                 ///< [-]
    double friction;                ///< of the fabric on itself [-]

    double volumeFraction() const { return mass / (thickness * fibreDensity); }  ///< φ; the rest are pores [-]
    /// What a scene's material has of it.
    FabricMaterial material() const;
};
std::span<const FabricPreset> fabricPresets();
std::vector<std::string> fabricPresetNames();

class SectionReader;

/// The preset that a section names; nullptr if it names none.
const FabricPreset* fabricPresetOf(const SectionReader& section);

/// Sets the material to the preset that the section names, if it does. A Young's modulus beside it stands for the preset's stiffnesses.
void readFabricPreset(const SectionReader& section, FabricMaterial& material);

}  // namespace sim
