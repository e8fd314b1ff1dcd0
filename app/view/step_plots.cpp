#include "app/view/step_plots.h"

#include "app/view/readable_number.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace app {

namespace {

constexpr std::size_t kMostPoints = 2000;  ///< points of a plot: older steps are forgotten

void addTo(std::vector<float>& values, double value)
{
    if (values.size() == kMostPoints) values.erase(values.begin(), values.begin() + kMostPoints / 2);
    values.push_back(static_cast<float>(value));
}

/// A quantity of every step.
struct Course {
    const char *name, *unit, *help;
    int digits = 4;  ///< digits of the plot's values
};

/// The course over the width of the panel, with its name and last value written into it.
void plot(const Course& course, const std::vector<float>& values)
{
    std::string text = course.name;
    if (!values.empty()) text += fmt::format(": {} {}", readableNumber(values.back(), course.digits), course.unit);
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 2.6f * ImGui::GetTextLineHeight());
    ImGui::PushID(course.name);
    ImGui::PlotLines("##course", values.data(), static_cast<int>(values.size()), 0, text.c_str(), FLT_MAX, FLT_MAX, size);
    ImGui::PopID();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s%s%s%s", course.help, *course.unit ? " [" : "", course.unit, *course.unit ? "]" : "");
}

/// Share of the liquid that came in which is in no particle, in no fabric, and has not left, negative where it is missing [-].
double massError(const LiveStep& step)
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
        addTo(massError_, massError(step));
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
    if (wall_.empty()) ImGui::TextUnformatted("no step yet");
    else ImGui::Text("%zu particles, %zu contacts", report.particles, report.fabric.contacts);
    plot({"energy", "erg", "kinetic, potential and elastic energy of everything"}, energy_);
    plot({"mass error", "", "liquid in particles, in fabric and gone, relative to what came in, less 1", 2}, massError_);
    plot({"dt", "ms", "length of the step"}, milliseconds_);
    plot({"CFL", "", "cells that the fastest goes in a step"}, cfl_);
    plot({"iterations", "", "of the solves for pressure and fabric"}, iterations_);
    plot({"wall time", "ms", "that the step took"}, wall_);
    drawStages();
}

/// Draws the times of the stages that ran.
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
