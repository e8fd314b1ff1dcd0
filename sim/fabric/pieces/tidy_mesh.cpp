#include "sim/fabric/pieces/tidy_mesh.h"

#include "sim/shapes/mend_solid.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace sim {

namespace {

/// Every point has its own vertex of the file.
std::vector<int> asInFile(const FabricGeometry& mesh)
{
    std::vector<int> numbers(mesh.points.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

std::array<int, 3> sortedCorners(const Vec3i& face)
{
    std::array<int, 3> corners = {face[0], face[1], face[2]};
    std::ranges::sort(corners);
    return corners;
}

bool isNothing(const std::array<int, 3>& corners) { return corners[0] == corners[1] || corners[1] == corners[2]; }

/// Corners at one place become one; faces that lose a corner go, and so do those that are another's double then. Returns the number of
/// corners that went up in others.
std::size_t weld(FabricGeometry& mesh, double distance)
{
    const std::vector<int> number = weldedNumbers(mesh.points, distance);
    std::vector<bool> isGone(mesh.points.size(), false);
    std::set<std::array<int, 3>> known, knownInFile;
    std::erase_if(mesh.faces, [&](Vec3i& f) {
        // What is wrong in the file already stays, and is told as that.
        const std::array<int, 3> before = sortedCorners(f);
        for (int& corner : f) {
            if (number[corner] != corner) isGone[corner] = true;
            corner = number[corner];
        }
        const std::array<int, 3> corners = sortedCorners(f);
        const bool isNew = known.insert(corners).second, wasNew = knownInFile.insert(before).second;
        return (isNothing(corners) && !isNothing(before)) || (!isNew && wasNew);
    });
    for (int& point : mesh.ofFile) point = point < 0 ? point : number[point];
    return static_cast<std::size_t>(std::ranges::count(isGone, true));
}

/// Points that no face and no strand has go. Returns their number.
std::size_t dropUnused(FabricGeometry& mesh)
{
    std::vector<int> number(mesh.points.size(), -1);
    for (const Vec3i& f : mesh.faces)
        for (const int corner : f) number[corner] = 0;
    for (const std::vector<int>& strand : mesh.strands)
        for (const int point : strand) number[point] = 0;
    std::vector<Vec3> used;
    for (std::size_t p = 0; p < number.size(); ++p) {
        if (number[p] < 0) continue;
        number[p] = static_cast<int>(used.size());
        used.push_back(mesh.points[p]);
    }
    for (Vec3i& f : mesh.faces)
        for (int& corner : f) corner = number[corner];
    for (std::vector<int>& strand : mesh.strands)
        for (int& point : strand) point = number[point];
    for (int& point : mesh.ofFile) point = point < 0 ? point : number[point];
    const std::size_t dropped = mesh.points.size() - used.size();
    mesh.points = std::move(used);
    return dropped;
}

/// Faces none of whose corners another face has.
std::size_t loneFaces(const FabricGeometry& mesh)
{
    std::vector<int> faces(mesh.points.size(), 0);
    for (const Vec3i& f : mesh.faces)
        for (const int corner : f) ++faces[corner];
    return static_cast<std::size_t>(std::ranges::count_if(mesh.faces, [&](const Vec3i& f) {
        return std::max({faces[f[0]], faces[f[1]], faces[f[2]]}) == 1;
    }));
}

/// Where the scene does not say: far below any edge, above the rounding of single precision [cm].
double ownWeld(const std::vector<Vec3>& points)
{
    constexpr double kOfSize = 1.0e-6;
    Eigen::AlignedBox3d box;
    for (const Vec3& x : points) box.extend(x);
    return points.empty() ? 0.0 : kOfSize * box.sizes().maxCoeff();
}

}  // namespace

std::vector<std::string> tidyMesh(FabricGeometry& mesh, double distance)
{
    std::vector<std::string> notes;
    mesh.ofFile = asInFile(mesh);
    const std::size_t before = mesh.faces.size(), unused = dropUnused(mesh);
    if (distance < 0.0) distance = ownWeld(mesh.points);
    const std::size_t welded = distance > 0.0 ? weld(mesh, distance) : 0;
    dropUnused(mesh);
    const std::size_t gone = before - mesh.faces.size(), lone = mesh.faces.size() > 1 ? loneFaces(mesh) : 0;
    if (unused > 0) notes.push_back(fmt::format("{} of its vertices are in no {} and left out", unused, mesh.strands.empty() ? "face" : "line"));
    if (welded > 0)
        notes.push_back(fmt::format("{} of its vertices are welded to others within {:.3g} cm{}; weld: 0 would leave them apart", welded, distance,
                                    gone > 0 ? fmt::format(", and {} faces that are nothing or doubled then are left out", gone) : ""));
    if (lone > 0)
        notes.push_back(fmt::format("{} of its {} triangles share no vertex with another and will fall apart; a larger weld would join them", lone,
                                    mesh.faces.size()));
    return notes;
}

}  // namespace sim
