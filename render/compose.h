#pragma once

#include "render/font.h"
#include "render/image.h"
#include "render/overlay.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace render {

enum class PanelLayout { Columns, Rows, Grid };

/// What stands around the panels of a comparison. Empty texts take no room.
struct ComposeLook {
    PanelLayout layout = PanelLayout::Columns;
    std::string title;                 ///< above everything
    std::optional<double> time;        ///< [s], stamped at the top right
    std::optional<ColorBar> colorBar;  ///< one for all, below everything
    Rgb background = {255, 255, 255};
};

/// Where each panel goes in the composed picture, in the order of the panels.
struct Composition {
    Image image;
    std::vector<PixelBox> panels;
};

/// Panels side by side, each under its label, unchanged to the pixel. Width and height come out even (H.264 needs it).
/// @param labels  one per panel, or none
/// Throws std::invalid_argument if there are no panels, they differ in size, or the labels do not match.
Composition compose(std::span<const Image> panels, std::span<const std::string> labels, const Font& font, const ComposeLook& look = {});

}  // namespace render
