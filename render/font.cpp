#include "render/font.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>
#pragma GCC diagnostic pop

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

struct Font::Face {
    std::vector<unsigned char> file;
    stbtt_fontinfo info{};
};

namespace {

/// The code points of UTF-8 text; bytes that are none become U+FFFD.
std::vector<int> codePoints(std::string_view text)
{
    std::vector<int> points;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        const int following = lead < 0x80 ? 0 : lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : -1;
        int point = following <= 0 ? lead : lead & (0x3F >> following);
        bool isValid = following >= 0;
        for (int k = 0; k < following && isValid; ++k) {
            isValid = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
            if (isValid) point = point << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
        }
        points.push_back(isValid ? point : 0xFFFD);
    }
    return points;
}

/// Calls visit(code point, pen x [pixels]) for each letter; returns where the pen ends.
template <class Visit>
float walk(const stbtt_fontinfo& info, std::string_view text, float scale, Visit&& visit)
{
    const std::vector<int> points = codePoints(text);
    float pen = 0.0f;
    for (std::size_t i = 0; i < points.size(); ++i) {
        int advance = 0, bearing = 0;
        stbtt_GetCodepointHMetrics(&info, points[i], &advance, &bearing);
        visit(points[i], pen);
        pen += scale * static_cast<float>(advance);
        if (i + 1 < points.size()) pen += scale * static_cast<float>(stbtt_GetCodepointKernAdvance(&info, points[i], points[i + 1]));
    }
    return pen;
}

/// How much of each pixel of a box a glyph covers, 0 to 255.
struct Coverage {
    PixelBox box;
    std::vector<unsigned char> values;

    unsigned char at(int x, int y) const
    {
        return x < 0 || y < 0 || x >= box.width || y >= box.height ? 0 : values[static_cast<std::size_t>(y) * box.width + x];
    }
};

void blendGlyph(Image& image, const Coverage& glyph, Rgb color)
{
    for (int y = 0; y < glyph.box.height; ++y)
        for (int x = 0; x < glyph.box.width; ++x)
            if (const unsigned char c = glyph.at(x, y); c > 0) blend(image, glyph.box.x + x, glyph.box.y + y, color, static_cast<float>(c) / 255.0f);
}

/// The most that is covered of the pixels within `reach` of a pixel.
unsigned char mostWithin(const Coverage& glyph, int x, int y, int reach)
{
    unsigned char most = 0;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i)
            if (i * i + j * j <= reach * (reach + 1)) most = std::max(most, glyph.at(x + i, y + j));
    return most;
}

/// A glyph with a rim `reach` pixels wide.
Coverage widened(const Coverage& glyph, int reach)
{
    const PixelBox& box = glyph.box;
    Coverage wide{{box.x - reach, box.y - reach, box.width + 2 * reach, box.height + 2 * reach}, {}};
    for (int y = 0; y < wide.box.height; ++y)
        for (int x = 0; x < wide.box.width; ++x) wide.values.push_back(mostWithin(glyph, x - reach, y - reach, reach));
    return wide;
}

/// Calls draw(coverage) for each glyph of a text with the base line at y that begins at x [pixels].
template <class Draw>
void drawGlyphs(const stbtt_fontinfo& font, std::string_view text, float x, float y, float size, const Draw& draw)
{
    const float scale = stbtt_ScaleForPixelHeight(&font, size);
    const int baseline = static_cast<int>(std::lround(y));
    Coverage glyph;
    walk(font, text, scale, [&](int point, float pen) {
        const float start = std::floor(x + pen), shift = x + pen - start;
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        stbtt_GetCodepointBitmapBoxSubpixel(&font, point, scale, scale, shift, 0.0f, &x0, &y0, &x1, &y1);
        glyph.box = {static_cast<int>(start) + x0, baseline + y0, x1 - x0, y1 - y0};
        if (glyph.box.width <= 0 || glyph.box.height <= 0) return;
        glyph.values.assign(static_cast<std::size_t>(glyph.box.width) * glyph.box.height, 0);
        stbtt_MakeCodepointBitmapSubpixel(&font, glyph.values.data(), glyph.box.width, glyph.box.height, glyph.box.width, scale, scale, shift, 0.0f,
                                          point);
        draw(glyph);
    });
}

}  // namespace

std::filesystem::path usualFontFile()
{
    const char* fromEnvironment = std::getenv("DRENCH_FONT");
    if (fromEnvironment != nullptr && *fromEnvironment != '\0') return fromEnvironment;
    return "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
}

Font::Font(const std::filesystem::path& wanted) : face_(std::make_unique<Face>())
{
    const std::filesystem::path path = wanted.empty() ? usualFontFile() : wanted;
    std::ifstream file(path, std::ios::binary);
    face_->file.assign(std::istreambuf_iterator<char>(file), {});
    if (face_->file.empty() || stbtt_InitFont(&face_->info, face_->file.data(), 0) == 0)
        throw std::runtime_error("cannot read font " + path.string() + " (install fonts-dejavu-core or set DRENCH_FONT)");
}

Font::~Font() = default;

float Font::width(std::string_view text, float size) const
{
    return walk(face_->info, text, stbtt_ScaleForPixelHeight(&face_->info, size), [](int, float) {});
}

float Font::capHeight(float size) const
{
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetCodepointBox(&face_->info, 'H', &x0, &y0, &x1, &y1);
    return stbtt_ScaleForPixelHeight(&face_->info, size) * static_cast<float>(y1);
}

PixelBox Font::draw(Image& image, std::string_view text, float x, float y, float size, const Ink& ink) const
{
    const int reach = ink.halo ? std::max(1, static_cast<int>(std::lround(0.08f * size))) : 0;
    if (ink.halo) drawGlyphs(face_->info, text, x, y, size, [&](const Coverage& glyph) { blendGlyph(image, widened(glyph, reach), *ink.halo); });
    int left = image.width, right = 0, top = image.height, bottom = 0;
    drawGlyphs(face_->info, text, x, y, size, [&](const Coverage& glyph) {
        blendGlyph(image, glyph, ink.color);
        const PixelBox& box = glyph.box;
        left = std::min(left, box.x - reach), right = std::max(right, box.x + box.width + reach);
        top = std::min(top, box.y - reach), bottom = std::max(bottom, box.y + box.height + reach);
    });
    return right > left ? PixelBox{left, top, right - left, bottom - top} : PixelBox{};
}

}  // namespace render
