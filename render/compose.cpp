#include "render/compose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {

namespace {

/// The measures of a composed picture [pixels].
struct Plan {
    int columns = 1, rows = 1;
    int panelWidth = 0, panelHeight = 0;
    float letter = 0.0f;                     ///< size of text
    int gap = 0;                             ///< gap between panels and around all
    int header = 0, labels = 0, footer = 0;  ///< heights of the strips of text

    int width() const { return evened(columns * panelWidth + (columns + 1) * gap); }
    int height() const { return evened(header + rows * (labels + panelHeight) + (rows + 1) * gap + footer); }
    PixelBox panel(int i) const
    {
        const int column = i % columns, row = i / columns;
        return {gap + column * (panelWidth + gap), header + gap + row * (labels + panelHeight + gap) + labels, panelWidth, panelHeight};
    }

 private:
    static int evened(int n) { return n + n % 2; }
};

int columnsFor(PanelLayout layout, int panels)
{
    switch (layout) {
        case PanelLayout::Columns: return panels;
        case PanelLayout::Rows: return 1;
        default: return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(panels))));
    }
}

Plan planFor(std::span<const Image> panels, bool hasLabels, const ComposeLook& look)
{
    Plan plan;
    const int count = static_cast<int>(panels.size());
    plan.panelWidth = panels.front().width;
    plan.panelHeight = panels.front().height;
    plan.columns = columnsFor(look.layout, count);
    plan.rows = (count + plan.columns - 1) / plan.columns;
    const auto inLetters = [&](float n) { return static_cast<int>(std::lround(n * plan.letter)); };
    // Read at the size of the whole: a row of many panels needs larger letters than one of them would.
    plan.letter = std::max(1.15f * textSize(plan.panelWidth, plan.panelHeight), static_cast<float>(plan.columns * plan.panelWidth) / 75.0f);
    plan.gap = std::max(2, inLetters(0.25f));
    plan.labels = hasLabels ? inLetters(1.7f) : 0;
    plan.header = look.title.empty() && !look.time ? 0 : inLetters(1.6f);
    plan.footer = look.colorBar ? inLetters(2.4f) : 0;
    return plan;
}

void requireComposable(std::span<const Image> panels, std::span<const std::string> labels)
{
    if (panels.empty()) throw std::invalid_argument("compose: no pictures");
    if (!labels.empty() && labels.size() != panels.size())
        throw std::invalid_argument("compose: " + std::to_string(labels.size()) + " labels for " + std::to_string(panels.size()) + " pictures");
    for (const Image& panel : panels)
        if (panel.width != panels.front().width || panel.height != panels.front().height || panel.width <= 0)
            throw std::invalid_argument("compose: pictures differ in size");
}

void drawHeader(Image& image, const Font& font, const Plan& plan, const ComposeLook& look, Rgb ink)
{
    const float baseline = 0.5f * (static_cast<float>(plan.header + plan.gap) + font.capHeight(plan.letter));
    const float margin = static_cast<float>(plan.gap) + 0.3f * plan.letter;
    font.draw(image, look.title, margin, baseline, plan.letter, ink);
    if (!look.time) return;
    const std::string time = timeText(*look.time);
    const float right = static_cast<float>(image.width) - margin;
    font.draw(image, time, right - font.width(time, plan.letter), baseline, plan.letter, ink);
}

void drawPanelLabel(Image& image, const Font& font, const Plan& plan, const PixelBox& panel, const std::string& label, Rgb ink)
{
    const float x = static_cast<float>(panel.x) + 0.5f * (static_cast<float>(panel.width) - font.width(label, plan.letter));
    const float middle = static_cast<float>(panel.y) - 0.5f * static_cast<float>(plan.labels);
    font.draw(image, label, x, middle + 0.5f * font.capHeight(plan.letter), plan.letter, ink);
}

}  // namespace

Composition compose(std::span<const Image> panels, std::span<const std::string> labels, const Font& font, const ComposeLook& look)
{
    requireComposable(panels, labels);
    const Plan plan = planFor(panels, !labels.empty(), look);
    const Rgb ink = contrastingColor(look.background);
    Composition result{Image(plan.width(), plan.height(), look.background), {}};
    Image& image = result.image;
    drawHeader(image, font, plan, look, ink);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const PixelBox box = plan.panel(static_cast<int>(i));
        if (!labels.empty()) drawPanelLabel(image, font, plan, box, labels[i], ink);
        result.panels.push_back(box);
    }
    if (look.colorBar) {
        const PixelBox footer = {plan.gap, image.height - plan.footer - plan.gap / 2, image.width - 2 * plan.gap, plan.footer};
        drawLyingColorBar(image, font, *look.colorBar, footer, 0.9f * plan.letter, ink);
    }
    // Panels last: a label that is too long for its panel ends at its neighbour, never on it.
    for (std::size_t i = 0; i < panels.size(); ++i) paste(panels[i], result.panels[i].x, result.panels[i].y, image);
    return result;
}

}  // namespace render
