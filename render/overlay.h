#pragma once

#include "render/color_map.h"
#include "render/font.h"
#include "render/image.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What is written over pictures, single or composed. All sizes follow the picture's.

namespace render {

enum class Corner { TopLeft, TopCenter, TopRight };

struct ColorBar {
    ColorMap map = ColorMap::Jet;
    std::array<float, 2> range = {0.0f, 200.0f};
    std::string title = "speed [cm/s]";  ///< title with the unit

    bool operator==(const ColorBar&) const = default;
};

/// Height of a line of text in pictures of this size [pixels]: one thirtieth of the height, legible from 11 up.
float textSize(int width, int height);

/// Dark on light and light on dark.
Rgb contrastingColor(Rgb background);

/// "t = 0.124 s"
std::string timeText(double seconds);

/// Round numbers (steps of 1, 2, 2.5 or 5 times a power of ten) inside the range, about five of them.
std::vector<double> niceTicks(double from, double to);

/// Text in a corner. Returns the box of pixels that may have changed; empty text changes none.
PixelBox drawLabel(Image& image, const Font& font, std::string_view text, Corner corner, const Ink& ink);

/// Upright bar at the right edge, or `inset` pixels from it, with title and ticks. Returns the box of the colours
/// alone.
PixelBox drawColorBar(Image& image, const Font& font, const ColorBar& bar, const Ink& ink, int inset = 0);

/// Several upright bars from the right edge on.
void drawColorBars(Image& image, const Font& font, std::span<const ColorBar> bars, const Ink& ink);

/// All that is written over one picture.
struct Annotations {
    std::string label, time;  ///< texts at the top left and right; empty: none
    std::vector<ColorBar> bars;
    Ink ink;

    bool operator==(const Annotations&) const = default;
    bool empty() const { return label.empty() && time.empty() && bars.empty(); }
};

void drawAnnotations(Image& image, const Font& font, const Annotations& annotations);

/// Lying bar in the middle of `box`, title to its left, ticks below; letters of `size` pixels. Returns the box of the
/// colours alone.
PixelBox drawLyingColorBar(Image& image, const Font& font, const ColorBar& bar, const PixelBox& box, float size, const Ink& ink);

}  // namespace render
