#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace render {

namespace {

int rounded(float x) { return static_cast<int>(std::lround(x)); }

std::string tickText(double value)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", std::abs(value) < 1e-12 ? 0.0 : value);
    return text.data();
}

/// Colour of pixel i of n along the bar: its middle's.
Rgb barColor(const ColorTable& table, int i, int n) { return toRgb(colorAt(table, (static_cast<float>(i) + 0.5f) / static_cast<float>(n))); }

double fractionOf(double value, const std::array<float, 2>& range) { return (value - range[0]) / (static_cast<double>(range[1]) - range[0]); }

/// A line one pixel wide around the box, outside of it.
void frame(Image& image, const PixelBox& box, Rgb ink)
{
    fill(image, {box.x - 1, box.y - 1, box.width + 2, 1}, ink);
    fill(image, {box.x - 1, box.y + box.height, box.width + 2, 1}, ink);
    fill(image, {box.x - 1, box.y, 1, box.height}, ink);
    fill(image, {box.x + box.width, box.y, 1, box.height}, ink);
}

/// Size of the letters beside an upright colour bar [pixels].
float barTextSize(const Image& image) { return 0.9f * textSize(image.width, image.height); }

}  // namespace

float textSize(int width, int height) { return std::max(11.0f, static_cast<float>(std::min(height, width)) / 30.0f); }

Rgb contrastingColor(Rgb background)
{
    const double luminance = 0.299 * background.r + 0.587 * background.g + 0.114 * background.b;
    return luminance > 110.0 ? Rgb{32, 36, 42} : Rgb{236, 238, 240};
}

std::string timeText(double seconds)
{
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "t = %.3f s", seconds);
    return text.data();
}

std::vector<double> niceTicks(double from, double to)
{
    if (!(from < to) || !std::isfinite(to - from)) return {};
    constexpr double kSteps = 4.0;
    const double power = std::pow(10.0, std::floor(std::log10((to - from) / kSteps)));
    double step = power;
    for (const double factor : {2.0, 2.5, 5.0, 10.0}) {
        const auto misses = [&](double candidate) { return std::abs((to - from) / candidate - kSteps); };
        if (misses(factor * power) < misses(step)) step = factor * power;
    }
    std::vector<double> ticks;
    const double slack = 1e-6 * step;
    for (double k = std::ceil((from - slack) / step); k * step <= to + slack; ++k) ticks.push_back(k * step);
    return ticks;
}

PixelBox drawLabel(Image& image, const Font& font, std::string_view text, Corner corner, const Ink& ink)
{
    const float size = textSize(image.width, image.height);
    const float free = static_cast<float>(image.width) - font.width(text, size);
    const float margin = 0.7f * size;
    const float x = corner == Corner::TopLeft ? margin : corner == Corner::TopRight ? free - margin : 0.5f * free;
    return font.draw(image, text, x, margin + font.capHeight(size), size, ink);
}

PixelBox drawColorBar(Image& image, const Font& font, const ColorBar& bar, const Ink& ink, int inset)
{
    const ColorTable table = colorTable(bar.map);
    const float size = barTextSize(image), cap = font.capHeight(size);
    const std::vector<double> ticks = niceTicks(bar.range[0], bar.range[1]);
    float textWidth = 0.0f;
    for (const double tick : ticks) textWidth = std::max(textWidth, font.width(tickText(tick), size));

    const int height = rounded(0.42f * static_cast<float>(image.height)), width = std::max(4, rounded(0.65f * size));
    const int right = image.width - inset - rounded(0.8f * size);
    const PixelBox box = {right - rounded(textWidth + 0.6f * size) - width, (image.height - height) / 2, width, height};
    for (int i = 0; i < height; ++i) fill(image, {box.x, box.y + height - 1 - i, width, 1}, barColor(table, i, height));
    frame(image, box, ink.color);
    for (const double tick : ticks) {
        const int y = box.y + height - rounded(static_cast<float>(fractionOf(tick, bar.range)) * static_cast<float>(height));
        fill(image, {box.x + width + 1, std::min(y, box.y + height), std::max(2, rounded(0.2f * size)), 1}, ink.color);
        font.draw(image, tickText(tick), static_cast<float>(box.x + width) + 0.5f * size, static_cast<float>(y) + 0.5f * cap, size, ink);
    }
    const float titleX = static_cast<float>(right) - font.width(bar.title, size);
    font.draw(image, bar.title, titleX, static_cast<float>(box.y) - 0.9f * size, size, ink);
    return box;
}

void drawColorBars(Image& image, const Font& font, std::span<const ColorBar> bars, const Ink& ink)
{
    int inset = 0;
    for (const ColorBar& bar : bars) {
        const PixelBox box = drawColorBar(image, font, bar, ink, inset);
        const float size = barTextSize(image);
        const int titleWidth = rounded(0.8f * size + font.width(bar.title, size));
        inset = std::max(image.width - box.x, inset + titleWidth) + rounded(size);
    }
}

void drawAnnotations(Image& image, const Font& font, const Annotations& annotations)
{
    drawLabel(image, font, annotations.label, Corner::TopLeft, annotations.ink);
    drawLabel(image, font, annotations.time, Corner::TopRight, annotations.ink);
    drawColorBars(image, font, annotations.bars, annotations.ink);
}

PixelBox drawLyingColorBar(Image& image, const Font& font, const ColorBar& bar, const PixelBox& place, float size, const Ink& ink)
{
    const ColorTable table = colorTable(bar.map);
    const float cap = font.capHeight(size), titleWidth = font.width(bar.title, size);
    const float gap = bar.title.empty() ? 0.0f : 0.8f * size;
    const int height = std::max(4, rounded(0.6f * size));
    const int width = std::max(16, std::min(rounded(16.0f * size), place.width - rounded(titleWidth + gap + 4.0f * size)));
    const int left = place.x + rounded(0.5f * (static_cast<float>(place.width - width) - titleWidth - gap));
    const int top = place.y + rounded(0.5f * (static_cast<float>(place.height - height) - 1.5f * cap));
    const PixelBox box = {left + rounded(titleWidth + gap), top, width, height};

    for (int i = 0; i < width; ++i) fill(image, {box.x + i, box.y, 1, height}, barColor(table, i, width));
    frame(image, box, ink.color);
    for (const double tick : niceTicks(bar.range[0], bar.range[1])) {
        const int x = box.x + rounded(static_cast<float>(fractionOf(tick, bar.range)) * static_cast<float>(width));
        fill(image, {std::min(x, box.x + width), box.y + height + 1, 1, std::max(2, rounded(0.2f * size))}, ink.color);
        const std::string text = tickText(tick);
        font.draw(image, text, static_cast<float>(x) - 0.5f * font.width(text, size), static_cast<float>(box.y + height) + 0.35f * size + cap, size,
                  ink);
    }
    font.draw(image, bar.title, static_cast<float>(left), static_cast<float>(top) + 0.5f * (static_cast<float>(height) + cap), size, ink);
    return box;
}

}  // namespace render
