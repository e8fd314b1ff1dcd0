#pragma once

#include "render/look.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace render {

/// What a vertex of fabric says of its colour; its alpha: 255 = this colour, 0 = that of its value in the colour map.
using Paint = std::array<std::uint8_t, 4>;

inline Paint paintOf(const FabricLook& look, int material)
{
    if (look.byValue || look.colors.empty()) return {0, 0, 0, 0};
    const Rgb color = toRgb(look.colors[static_cast<std::size_t>(std::max(material, 0)) % look.colors.size()]);
    return {color.r, color.g, color.b, 255};
}

}  // namespace render
