#pragma once

#include "render/color_map.h"
#include "render/gl_objects.h"

#include <optional>

namespace render {

/// A colour map as a texture of kColorMapSize x 1.
class ColorMapTexture {
 public:
    explicit ColorMapTexture(const Gl& gl) : gl_(gl), texture_(gl) {}
    /// Binds it to texture unit 0.
    void bind(ColorMap map);

 private:
    const Gl& gl_;
    Texture texture_;
    std::optional<ColorMap> uploaded_;
};

}  // namespace render
