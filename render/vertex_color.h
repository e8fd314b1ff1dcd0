#pragma once

#include "render/look.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace render {

/// What a vertex of fabric says of its colour; its alpha: 255 = this colour, 0 = that of its value in the colour map.
using VertexColor = std::array<std::uint8_t, 4>;

/// @param wetness  0 = dry … 1 = soaked
inline VertexColor vertexColorOf(const FabricLook& look, int material, float wetness = 0.0f)
{
    if (look.byValue || look.colors.empty()) return {0, 0, 0, 0};
    const Eigen::Vector3f& dry = look.colors[static_cast<std::size_t>(std::max(material, 0)) % look.colors.size()];
    const Rgb color = toRgb(dry + std::clamp(wetness, 0.0f, 1.0f) * (look.wetColor - dry));
    return {color.r, color.g, color.b, 255};
}

}  // namespace render
