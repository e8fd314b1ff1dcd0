#include "sim/scene/read_place.h"

#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <cmath>

namespace sim {

void requireNear(const Node& node, const std::string& path, const Vec3& x)
{
    if (x.cwiseAbs().maxCoeff() > kFarthest) fail(node.location, fmt::format("{}: lies beyond {} cm", path, kFarthest));
}

Vec3 unitAxis(const Node& node, const std::string& path, const Vec3& axis)
{
    const double length = axis.norm();
    if (!(length > 0.0) || !std::isfinite(length)) fail(node.location, fmt::format("{}: must be a direction, like [0, 1, 0]", path));
    return axis / length;
}

std::filesystem::path existingFile(const Node& name, const std::string& path)
{
    namespace fs = std::filesystem;
    const fs::path directory = name.location.source ? name.location.source->directory : ".";
    const fs::path file = directory / fs::path(readText(name, path));
    requireAllowed(file, name.location);
    std::error_code error;
    if (!fs::is_regular_file(file, error)) fail(name.location, fmt::format("{}: there is no file {}", path, fileInQuotes(file.string())));
    return fs::absolute(file, error).lexically_normal();
}

ReadTransform readRotation(const Node& node, const std::string& path, const Vec3& middle)
{
    Vec3 axis = Vec3::UnitY(), origin = middle;
    double angle = 0.0;
    const auto fields = [&](auto& v) {
        v.required("axis", "the direction to turn about, like axis: [0, 0, 1]");
        v.vector("axis", axis, Quantity::None, "");
        v.required("angle", "how far to turn, in degrees, like angle: 30");
        v.number("angle", angle, Quantity::Angle, Range::between(-3600.0, 3600.0), "");
        v.vector("origin", origin, Quantity::Length, "Point on the axis");
    };
    SectionReader::read(&node, path, fields);
    requireNear(node, path, origin);
    const Eigen::AngleAxisd turn(angle, unitAxis(node, joinPath(path, "axis"), axis));
    return {Eigen::Isometry3d(Eigen::Translation3d(origin) * turn * Eigen::Translation3d(-origin)), flowOf(fields)};
}

ReadTransform readTranslation(const Node& node, const std::string& path)
{
    Vec3 by = Vec3::Zero();
    readNumbers(node, path, {by.data(), 3}, Quantity::Length, Range::between(-kFarthest, kFarthest));
    return {Eigen::Isometry3d(Eigen::Translation3d(by)), fmt::format("[{}, {}, {}]", formatPlain(by[0]), formatPlain(by[1]), formatPlain(by[2]))};
}

}  // namespace sim
