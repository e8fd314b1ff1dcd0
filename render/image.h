#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace render {

/// Colours as they stand in the file (sRGB), 0 … 255.
struct Rgb {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb&) const = default;
};

/// A picture: rows from the top, pixels from the left, three bytes each.
struct Image {
    Image() = default;
    /// Throws std::invalid_argument unless both sizes are positive.
    Image(int width, int height, Rgb color = {255, 255, 255});

    bool operator==(const Image&) const = default;
    std::uint8_t* at(int x, int y) { return &pixels[3 * (static_cast<std::size_t>(y) * width + x)]; }
    const std::uint8_t* at(int x, int y) const { return &pixels[3 * (static_cast<std::size_t>(y) * width + x)]; }
    Rgb color(int x, int y) const { return {at(x, y)[0], at(x, y)[1], at(x, y)[2]}; }

    int width = 0, height = 0;         ///< [pixels]
    std::vector<std::uint8_t> pixels;  ///< 3 · width · height
};

/// Part of an image [pixels]: columns x … x + width − 1, rows y … y + height − 1.
struct PixelBox {
    int x = 0, y = 0, width = 0, height = 0;
    bool contains(int px, int py) const { return px >= x && px < x + width && py >= y && py < y + height; }
};

/// Fill the part of the box that lies inside the image.
void fill(Image& image, const PixelBox& box, Rgb color);
/// Copy `source` to (x, y) of `target`; what lies outside the target is left out.
void paste(const Image& source, int x, int y, Image& target);
/// color over the pixel with the given opacity 0 … 1. Pixels outside the image are ignored.
void blend(Image& image, int x, int y, Rgb color, float opacity);

/// What a PNG says beside its pixels: keywords of 1 to 79 characters, each with its text; both Latin-1.
using PngTexts = std::vector<std::pair<std::string, std::string>>;

/// Write a PNG under a temporary name beside `path`, then rename: a reader never sees half a picture.
/// Throws std::runtime_error naming the path and the reason (no such folder, disk full, ...); nothing is left behind.
void writePng(const Image& image, const std::filesystem::path& path, const PngTexts& texts = {});

/// Read any PNG as 8-bit RGB; transparency is laid over white. Throws std::runtime_error naming path and reason.
Image readPng(const std::filesystem::path& path);

}  // namespace render
