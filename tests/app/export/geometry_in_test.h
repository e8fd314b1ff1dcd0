#pragma once

#include "app/export/export_frame.h"
#include "sim/state.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <limits>
#include <vector>

// What the tests of geometry files share: something of every kind to write, and VTK to read it back.

namespace app::test {

inline constexpr double kDensity = 1.1;  ///< of the liquid [g/cm^3]

/// Two yarns of 3 and 2 vertices, a sheet of 4 x 3, wet in parts, and some particles, all of them moving, in a box.
struct WetScene {
    /// Particles have ids in another order than their own.
    explicit WetScene(std::size_t particles = 7);

    ExportFrame frame(std::int64_t number = 0) const;
    /// Particles and vertices go on by dt [s].
    void move(double dt);

    sim::Fabric fabric;
    sim::State state;
    std::vector<FrameSnapshot::Mesh> obstacles;
};

/// What the reader that is not ours finds in files: see read_geometry.py. Throws std::runtime_error with what it says
/// is wrong.
nlohmann::json readGeometry(const std::vector<std::filesystem::path>& files);

/// Of one number against another in single precision [-].
inline constexpr double kSingle = std::numeric_limits<float>::epsilon();

/// Is a vector that was read the one that was written, but for rounding to single precision?
void expectClose(const nlohmann::json& read, const sim::Vec3& written);

}  // namespace app::test
