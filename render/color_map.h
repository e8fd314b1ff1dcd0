#pragma once

#include "render/image.h"

#include <Eigen/Core>

#include <array>

namespace render {

enum class ColorMap { Jet, Turbo, Viridis };

inline constexpr int kColorMapSize = 256;
using ColorTable = std::array<Eigen::Vector3f, kColorMapSize>;  ///< red, green, blue in 0 … 1

/// The map as 256 colours from the lowest value to the highest.
/// Jet: identical to MATLAB's jet(256). Turbo: cubics through colours of A. Mikhailov's map (Google, 2019).
/// Viridis: polynomial of M. Zucker (2019) to the map of S. van der Walt and N. Smith (matplotlib).
ColorTable colorTable(ColorMap map);

/// The colour of the fraction t of the range, interpolated; t outside 0 … 1 gets the colour of the nearer end.
Eigen::Vector3f colorAt(const ColorTable& table, float t);

/// Red, green, blue in 0 … 1 to bytes, rounded.
Rgb toRgb(const Eigen::Vector3f& color);

}  // namespace render
