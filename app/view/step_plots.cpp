#include "app/view/step_plots.h"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace app {

namespace {

constexpr std::size_t kMostPoints = 2000;  ///< of a plot: older steps are forgotten

void addTo(std::vector<float>& values, double value)
{
    if (values.size() == kMostPoints) values.erase(values.begin(), values.begin() + kMostPoints / 2);
    values.push_back(static_cast<float>(value));
}

/// The course with its last value written into it.
void plot(const char* label, const std::vector<float>& values)
{
    char last[32] = "";
    if (!values.empty()) std::snprintf(last, sizeof last, "%.4g", static_cast<double>(values.back()));
    const float height = 2.6f * ImGui::GetTextLineHeight();
    ImGui::PlotLines(label, values.data(), static_cast<int>(values.size()), 0, last, FLT_MAX, FLT_MAX, ImVec2(0.0f, height));
}

/// Of the liquid that came in, what is in no particle, in no fabric, and has not left [-].
double waterError(const LiveStep& step)
{
    const sim::Ledger& ledger = step.ledger;
    if (ledger.emittedMass == 0.0) return 0.0;
    return (step.report.liquidMass + step.report.absorbedMass + ledger.leftMass) / ledger.emittedMass - 1.0;
}

}  // namespace

void StepPlots::add(std::vector<LiveStep> steps)
{
    for (LiveStep& step : steps) {
        const sim::StepReport& report = step.report;
        if (!report.isReflected) addTo(energy_, report.energies.total());
        addTo(waterError_, waterError(step));
        addTo(milliseconds_, 1000.0 * report.dt);
        addTo(cfl_, report.cfl);
        addTo(iterations_, report.pressure.iterations + report.fabric.iterations);
        addTo(wall_, 1000.0 * step.seconds);
        last_ = std::move(step);
    }
}

void StepPlots::draw() const
{
    const sim::StepReport& report = last_.report;
    ImGui::Text("%zu particles, %zu contacts", report.particles, report.fabric.contacts);
    plot("energy [erg]", energy_);
    plot("water error", waterError_);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("share of the liquid that is in no particle, in no fabric, and has not left");
    plot("dt [ms]", milliseconds_);
    plot("CFL", cfl_);
    plot("iterations", iterations_);
    plot("wall [ms]", wall_);
    drawStages();
}

/// Only those that ran.
void StepPlots::drawStages() const
{
    const sim::StepReport& report = last_.report;
    const double whole = std::max(last_.seconds, 1.0e-9);
    for (int s = 0; s < sim::kStages; ++s) {
        if (!report.stageRan[s]) continue;
        char text[64];
        std::snprintf(text, sizeof text, "%s  %.2f ms", sim::kStageNames[s].data(), 1000.0 * report.stageSeconds[s]);
        ImGui::ProgressBar(static_cast<float>(report.stageSeconds[s] / whole), ImVec2(-FLT_MIN, 0.0f), text);
    }
}

}  // namespace app
