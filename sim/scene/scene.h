#pragma once

#include "sim/fabric/pieces/piece.h"
#include "sim/obstacle_settings.h"
#include "sim/opening_settings.h"
#include "sim/scene/velocity_field.h"
#include "sim/settings.h"
#include "sim/shapes/shape.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sim {

/// How particles are laid out in a source (sources/README.md, Filling).
struct FillSettings {
    enum class Pattern { Lattice, Reference, Jittered, Poisson };
    Pattern pattern = Pattern::Lattice;
    std::uint64_t seed = 1;
    double spacing = 0.0;  ///< pitch in cells; 0 = the pattern's own [-]

    /// Pitch of the particles [cells].
    double pitch() const
    {
        if (spacing > 0.0) return spacing;
        return pattern == Pattern::Reference ? 0.35355339059327379 : 0.4;  // 1/√8: eight in (1/√2)³ of a cell's volume
    }
};

/// A span of time in which a source gives liquid.
struct Emission {
    double from = 0.0, to = 0.0;                                 ///< [s]; both equal the start: once, the initial body
    double maxVolume = std::numeric_limits<double>::infinity();  ///< [cm^3]
    Vec3 velocity = Vec3::Zero();                                ///< [cm/s]
};

struct SourceSettings {
    std::string name;
    Shape shape;
    FillSettings fill;
    std::vector<Emission> emissions;             ///< at least one
    double volume = 0.0;                         ///< estimate, inside the domain and outside of obstacles [cm^3]
    std::string where;                           ///< "drop.yaml:14", for messages
    std::string shapeText;                       ///< the shape as a scene says it, in cgs, on one line
    std::vector<std::string> notes;              ///< notes about its meshes
    std::optional<VelocityField> velocityField;  ///< velocity field of the initial body, beside the emission's velocity
};

struct NamedMaterial {
    std::string name;
    FabricMaterial material;
    double fibreDiameter = 0.0;  ///< of its preset; 0 without one [cm]
};

/// What holds from a step on.
struct SettingsChange {
    std::int64_t step = 0;  ///< the first step with it, counted from 1
    Settings settings;
    std::vector<NamedMaterial> materials;
};

/// One scene file, resolved: includes, variant and overrides applied, units converted to CGS.
struct Scene {
    std::string name, title, description;
    std::vector<std::string> tags;
    std::string file;  ///< the file it came from, for messages
    Settings settings;
    std::vector<SourceSettings> sources;
    std::vector<NamedMaterial> materials;
    std::vector<FabricPiece> fabrics;
    std::vector<ObstacleSettings> obstacles;
    std::optional<Shape> domain;            ///< liquid outside of it is deleted
    std::string domainText;                 ///< the domain as a scene says it, in cgs, on one line
    std::vector<OpeningSettings> openings;  ///< in faces of the domain, which is a box then
    std::vector<SettingsChange> changes;    ///< during the run, in order
    std::vector<std::string> notes;         ///< "drop.yaml:14: …": what was mended in its files, for the user to know
};

}  // namespace sim
