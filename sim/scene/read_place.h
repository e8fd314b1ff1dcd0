#pragma once

#include "sim/scene/node.h"
#include "sim/scene/range.h"
#include "sim/scene/section_writer.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <string>

// Sizes, directions, files and rigid motions, as shapes and fabric say them.

namespace sim {

inline constexpr double kFarthest = 1.0e7;  ///< 100 km: sizes beyond it are slips, and their squares lose all digits [cm]

/// The fields as one line of YAML, as a declaration writes them.
template <class Fields>
std::string flowOf(Fields fields)
{
    SectionWriter writer;
    fields(writer);
    return writer.flow();
}

/// Refuses points beyond kFarthest.
void requireNear(const Node& node, const std::string& path, const Vec3& x);

/// The direction with length 1; refuses what is none. `path` names the key.
Vec3 unitAxis(const Node& node, const std::string& path, const Vec3& axis);

/// The file that a scene names, relative to it, as an absolute path; refused if there is none.
std::filesystem::path existingFile(const Node& name, const std::string& path);

/// A rigid motion, and the same in the words of a scene (cgs, one line).
struct ReadTransform {
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    std::string text;
};

/// {axis, angle, origin}: turns about a point, `middle` unless it says another.
ReadTransform readRotation(const Node& node, const std::string& path, const Vec3& middle);
/// [x, y, z]
ReadTransform readTranslation(const Node& node, const std::string& path);

}  // namespace sim
