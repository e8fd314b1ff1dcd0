#include "render/image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace render {

Image::Image(int w, int h, Rgb color) : width(w), height(h)
{
    if (w <= 0 || h <= 0) throw std::invalid_argument("an image of " + std::to_string(w) + " x " + std::to_string(h) + " pixels");
    pixels.resize(3 * static_cast<std::size_t>(w) * h);
    fill(*this, {0, 0, w, h}, color);
}

void fill(Image& image, const PixelBox& box, Rgb color)
{
    const int x0 = std::max(box.x, 0), x1 = std::min(box.x + box.width, image.width);
    const int y0 = std::max(box.y, 0), y1 = std::min(box.y + box.height, image.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            std::uint8_t* pixel = image.at(x, y);
            pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
        }
}

void paste(const Image& source, int x, int y, Image& target)
{
    const int x0 = std::max(x, 0), x1 = std::min(x + source.width, target.width);
    const int y0 = std::max(y, 0), y1 = std::min(y + source.height, target.height);
    if (x0 >= x1) return;
    for (int row = y0; row < y1; ++row) std::memcpy(target.at(x0, row), source.at(x0 - x, row - y), 3 * static_cast<std::size_t>(x1 - x0));
}

void blend(Image& image, int x, int y, Rgb color, float opacity)
{
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    std::uint8_t* pixel = image.at(x, y);
    const auto mix = [opacity](std::uint8_t under, std::uint8_t over) {
        const float mixed = static_cast<float>(under) + opacity * static_cast<float>(over - under);
        return static_cast<std::uint8_t>(std::lround(mixed));
    };
    pixel[0] = mix(pixel[0], color.r);
    pixel[1] = mix(pixel[1], color.g);
    pixel[2] = mix(pixel[2], color.b);
}

}  // namespace render
