#include "app/view/look_panel.h"

#include "app/drawing/look_from_settings.h"
#include "app/frames/snapshot_from_state.h"
#include "app/scene/describe_picture.h"
#include "app/scene/picture_parameters.h"
#include "app/view/explain.h"

#include <imgui.h>

#include <algorithm>
#include <string>

namespace app {

namespace {

ColorBy liquidColorBy(const SnapshotExtras& extras) { return extras.pressure ? ColorBy::Pressure : ColorBy::Speed; }

std::array<std::array<float, 2>, 2> liquidRanges(const RenderSettings& settings)
{
    std::array ranges = {toFloat(usualRange(ColorBy::Speed)), toFloat(usualRange(ColorBy::Pressure))};
    ranges[settings.colorBy == ColorBy::Pressure ? 1 : 0] = toFloat(settings.range);
    return ranges;
}

std::array<std::array<float, 2>, 4> fabricRanges(const FabricLookSettings& settings)
{
    std::array<std::array<float, 2>, 4> ranges;
    for (const FabricColorBy by : {FabricColorBy::Material, FabricColorBy::Speed, FabricColorBy::Strain, FabricColorBy::Saturation})
        ranges[static_cast<std::size_t>(by)] = toFloat(usualRange(by));
    if (settings.colorBy != FabricColorBy::Material) ranges[static_cast<std::size_t>(settings.colorBy)] = toFloat(settings.range);
    return ranges;
}

void fillIn(FabricColorBy colorBy, const std::array<std::array<float, 2>, 4>& ranges, render::FabricLook& look)
{
    look.byValue = colorBy != FabricColorBy::Material;
    look.range = ranges[static_cast<std::size_t>(colorBy)];
    look.colorBarTitle = titleOf(colorBy);
}

/// The words of a scene's file for a choice whose values count from 0, as a combo wants them.
template <class E>
std::string wordsOf()
{
    std::string words;
    for (const sim::Choice<E>& choice : choicesOf(E{})) (words += choice.word) += '\0';
    return words;
}

/// True when another one is chosen.
template <class E>
bool choose(const char* label, const char* words, E& choice)
{
    int index = static_cast<int>(choice);
    if (!ImGui::Combo(label, &index, words)) return false;
    choice = static_cast<E>(index);
    return true;
}

}  // namespace

LookPanel::LookPanel(const PictureSettings& pictures)
    : contents_(pictures.contents),
      liquidStyle_(pictures.render.liquidStyle),
      look_(lookOf(pictures, "", false)),
      wanted_(extrasOf(pictures.render)),
      liquidRanges_(liquidRanges(pictures.render)),
      yarnRanges_(fabricRanges(pictures.render.yarns)),
      clothRanges_(fabricRanges(pictures.render.cloth))
{
}

render::Look LookPanel::lookFor(const FrameSnapshot& snapshot) const
{
    render::Look look = look_;
    look.liquid.range = liquidRanges_[snapshot.extras.pressure ? 1 : 0];
    if (look.liquid.style == render::LiquidStyle::Surface && !snapshot.extras.surface) look.liquid.style = render::LiquidStyle::Spheres;
    look.overlay.colorBarTitle = titleOf(liquidColorBy(snapshot.extras));
    fillIn(snapshot.extras.yarns, yarnRanges_, look.yarns);
    fillIn(snapshot.extras.cloth, clothRanges_, look.cloth);
    return look;
}

bool LookPanel::draw()
{
    const SnapshotExtras before = wanted_;
    explained_.reset();
    drawVisibility();
    drawMarks();
    if (contents_.liquid && look_.liquid.isShown) drawLiquid();
    if (contents_.yarns && look_.yarns.isShown) drawFabric("yarns", wanted_.yarns, yarnRanges_, look_.yarns);
    if (contents_.cloth && look_.cloth.isShown) drawFabric("cloth", wanted_.cloth, clothRanges_, look_.cloth);
    ImGui::ColorEdit3("background", look_.background.data(), ImGuiColorEditFlags_NoInputs);
    explainSetting("background");
    return wanted_ != before;
}

void LookPanel::drawVisibility()
{
    if (contents_.liquid) {
        ImGui::Checkbox("liquid", &look_.liquid.isShown);
        explain("whether it is drawn");
    }
    if (!contents_.fabric()) return;
    if (contents_.liquid) ImGui::SameLine();
    bool isFabricShown = look_.yarns.isShown;
    if (ImGui::Checkbox("fabric", &isFabricShown)) look_.yarns.isShown = look_.cloth.isShown = isFabricShown;
    explain("whether it is drawn");
}

void LookPanel::drawMarks()
{
    ImGui::Checkbox("blocks", &wanted_.blocks);
    explain("of 8 x 8 x 8 cells: where the grid is");
    if (contents_.fabric()) {
        ImGui::SameLine();
        ImGui::Checkbox("contacts", &wanted_.contacts);
        explain("pairs of fabric that push on each other");
    }
    if (contents_.liquid) {
        ImGui::SameLine();
        ImGui::Checkbox("arrows", &wanted_.arrows);
        explain("where the liquid goes");
    }
    if (wanted_.arrows) {
        auto milliseconds = static_cast<float>(1000.0 * wanted_.arrowTime);
        if (ImGui::SliderFloat("arrows [ms]", &milliseconds, 0.1f, 1000.0f, "%.1f", ImGuiSliderFlags_Logarithmic))
            wanted_.arrowTime = 0.001 * milliseconds;
        explain("simulated time in which the liquid would go as far as an arrow is long [ms]");
    }
    choose("obstacles", "translucent\0wire\0hidden\0solid\0", look_.obstacles.style);
    explainSetting("obstacles.style");
}

void LookPanel::drawLiquid()
{
    ImGui::PushID("liquid");
    if (choose("liquid as", wordsOf<LiquidStyle>().c_str(), liquidStyle_)) {
        look_.liquid.style = liquidStyleOf(liquidStyle_);
        wanted_.surface = liquidStyle_ == LiquidStyle::Surface;
    }
    explainSetting("liquid.style");
    ColorBy colorBy = look_.liquid.flat ? ColorBy::Flat : liquidColorBy(wanted_);
    if (choose("liquid by", "speed\0pressure\0one colour\0", colorBy)) {
        look_.liquid.flat = colorBy == ColorBy::Flat;
        wanted_.pressure = colorBy == ColorBy::Pressure;
    }
    explainSetting("liquid.color_by");
    if (!look_.liquid.flat)
        chooseColors("liquid", colorBy == ColorBy::Pressure ? "dyn/cm^2" : "cm/s", liquidRanges_[wanted_.pressure ? 1 : 0], look_.liquid.colorMap);
    ImGui::PopID();
}

void LookPanel::drawFabric(const std::string& group, FabricColorBy& colorBy, FabricRanges& ranges, render::FabricLook& look)
{
    ImGui::PushID(group.c_str());
    choose((group + " by").c_str(), "material and wetness\0speed\0strain\0saturation\0", colorBy);
    explainSetting(group + ".color_by");
    if (colorBy != FabricColorBy::Material)
        chooseColors(group, colorBy == FabricColorBy::Speed ? "cm/s" : "range", ranges[static_cast<std::size_t>(colorBy)], look.colorMap);
    ImGui::PopID();
}

void LookPanel::chooseColors(const std::string& group, const char* rangeLabel, Range& range, render::ColorMap& map)
{
    const float step = std::max(1.0e-4f, 0.005f * (range[1] - range[0]));
    ImGui::DragFloatRange2(rangeLabel, &range[0], &range[1], step, 0.0f, 0.0f, "%.4g");
    range[1] = std::max(range[1], range[0] + std::max(1.0e-6f, 1.0e-6f * std::abs(range[0])));
    explainSetting(group + ".range");
    choose("colour map", "jet\0turbo\0viridis\0", map);
    explainSetting(group + ".colormap");
}

/// While the pointer is on the widget that was drawn last.
/// @param path  below render
void LookPanel::explainSetting(const std::string& path)
{
    if (!ImGui::IsItemHovered()) return;
    RenderSettings now;  // which unit a range has, and whether there is one, depends on what the colours show
    now.colorBy = liquidColorBy(wanted_);
    now.yarns.colorBy = wanted_.yarns;
    now.cloth.colorBy = wanted_.cloth;
    explained_ = pictureParameter(now, "render." + path);
    if (explained_) explain(*explained_);
}

}  // namespace app
