#pragma once

#include "app/frames/frame_snapshot.h"
#include "sim/state.h"
#include "sim/surface/surface_mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace app {

/// One quantity at every point of a part, in single precision or as whole numbers.
struct ExportArray {
    std::string name;    ///< "velocity"
    std::string unit;    ///< "cm/s"; empty: [-]
    int components = 1;  ///< per point, which follow one another in `values`
    std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

/// One thing that files show: points, what joins them, and what is known at them. Nothing in it knows of a file format.
struct ExportPart {
    enum class Kind { Points, Lines, Triangles };
    std::string name;  ///< name of its files, groups and prims: a letter, then letters, digits and _
    Kind kind = Kind::Points;
    std::vector<Eigen::Vector3f> positions;  ///< [cm]
    std::vector<int> begin;                  ///< lines only: of each in `positions`, and the end of the last
    std::vector<Eigen::Vector3i> triangles;  ///< triangles only; counter-clockwise as seen from outside of a body
    std::vector<ExportArray> arrays;         ///< arrays of the part: equal names in every frame, also in one where there are no points

    /// The array of that name; null where there is none.
    const ExportArray* find(std::string_view array) const;
};

/// The numbers of vectors, one behind the other.
template <class T>
std::span<const T> flat(const std::vector<Eigen::Matrix<T, 3, 1>>& vectors)
{
    static_assert(sizeof(Eigen::Matrix<T, 3, 1>) == 3 * sizeof(T));
    return {reinterpret_cast<const T*>(vectors.data()), 3 * vectors.size()};
}

/// The units of a part in words: "lengths in cm, velocity in cm/s".
std::string unitsOf(const ExportPart& part);

/// One moment of a run as geometry files show it, copied out of the state.
struct ExportFrame {
    std::int64_t number = 0;        ///< 0 is the initial state
    double time = 0.0;              ///< [s]
    std::vector<ExportPart> parts;  ///< parts, by equal names and in one order in all frames of a run
};

/// Which frame was written, for collections.
struct FrameTime {
    std::int64_t number = 0;
    double time = 0.0;  ///< [s]
};

/// What there is to be seen of a state: `liquid` (points in the order of their ids: velocity, speed, volume, id),
/// `yarns` (lines: velocity, radius, saturation, absorbed, material), `cloth` (triangles: velocity, normal, saturation,
/// absorbed, material) and every obstacle (triangles: velocity). Without yarns there is no part `yarns`, without cloth
/// no `cloth`, and no `liquid` where none can ever come. The same bits for any number of threads.
/// @param fabric     what state.fabric is the state of
/// @param density    of the liquid [g/cm^3]
/// @param obstacles  where they are at state.time
/// @param surface    of the liquid: one more part then, `surface` (triangles: velocity, normal)
ExportFrame exportFrame(std::int64_t number, const sim::State& state, const sim::Fabric& fabric, double density,
                        std::span<const FrameSnapshot::Mesh> obstacles, const sim::SurfaceMesh* surface = nullptr);

}  // namespace app
