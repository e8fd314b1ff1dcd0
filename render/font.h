#pragma once

#include "render/image.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace render {

/// The TrueType file that text is drawn with: $DRENCH_FONT, else where Debian's fonts-dejavu-core puts DejaVuSans.ttf.
std::filesystem::path usualFontFile();

/// What text is written in.
struct Ink {
    Ink(Rgb letters = {}, std::optional<Rgb> around = {}) : color(letters), halo(around) {}

    Rgb color;
    std::optional<Rgb> halo;  ///< colour of a rim around letters, which keeps them legible on whatever is behind; none: no rim

    bool operator==(const Ink&) const = default;
};

/// DejaVu Sans, drawn into images with smooth edges. Text is UTF-8.
class Font {
 public:
    /// @param file  a TrueType file; empty = usualFontFile()
    /// Throws std::runtime_error naming the file, and the package that would help, if it cannot be read.
    explicit Font(const std::filesystem::path& file = {});
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    /// Width of the text [pixels]; `size` is the height of a line [pixels].
    float width(std::string_view text, float size) const;
    /// Height of capital letters and digits over the base line [pixels].
    float capHeight(float size) const;
    /// Draw from x rightwards with the base line at y [pixels]. Returns the box of the pixels that may have changed.
    PixelBox draw(Image& image, std::string_view text, float x, float y, float size, const Ink& ink) const;

 private:
    struct Face;
    std::unique_ptr<Face> face_;
};

}  // namespace render
