#include "app/lab/stability_map.h"

#include "app/csv.h"
#include "app/lab/stress_ending.h"
#include "app/output_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace app {

namespace {

using nlohmann::json;

struct Energy {
    double gain = 0.0, largestKinetic = 0.0;  ///< [erg]
};

/// From energy_ledger.csv: what of the energy's rise nothing outside of liquid and fabric has paid for.
Energy energyOf(const std::filesystem::path& csv)
{
    std::ifstream in(csv);
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = csvCells(line);
    const std::vector<std::string> outside = {"sources_erg", "suction_erg", "surface_tension_erg", "obstacles_erg", "pins_erg"};
    Energy energy;
    double start = std::numeric_limits<double>::quiet_NaN();
    while (std::getline(in, line)) {
        const std::vector<std::string> cells = csvCells(line);
        double paid = 0.0, total = 0.0;
        for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i) {
            const double value = std::strtod(cells[i].c_str(), nullptr);
            if (names[i] == "total_erg") total = value;
            if (names[i] == "kinetic_erg") energy.largestKinetic = std::max(energy.largestKinetic, value);
            if (std::ranges::find(outside, names[i]) != outside.end()) paid += std::max(0.0, value);
        }
        if (std::isnan(start)) start = total;
        energy.gain = std::max(energy.gain, total - start - paid);
    }
    return energy;
}

struct Steps {
    int count = 0;
    double sum = 0.0;            ///< of their lengths [s]
    double largestSpeed = 0.0;   ///< of the liquid [cm/s]
    double liquidMass = 0.0;     ///< at the start [g]
};

Steps stepsOf(const std::filesystem::path& log)
{
    std::ifstream in(log);
    Steps steps;
    for (std::string line; std::getline(in, line);) {
        const json step = json::parse(line, nullptr, false);
        if (!step.is_object()) continue;
        ++steps.count;
        steps.sum += step.value("dt", 0.0);
        steps.largestSpeed = std::max(steps.largestSpeed, step.value("max_speed", 0.0));
        if (steps.liquidMass == 0.0) steps.liquidMass = step.at("ledger").value("liquid_mass", 0.0);
    }
    return steps;
}

std::string withoutCommas(std::string text)
{
    std::ranges::replace(text, ',', ';');
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string whyUnstable(const StabilityRow& row, const Steps& steps, const Energy& energy)
{
    constexpr double kLongEnough = 0.95;  // on the mean: where liquid leaves fabric, what is left is divided into pairs of steps again
    if (steps.sum < kLongEnough * row.dt * steps.count) return fmt::format("cut: steps of {:.3g} s", steps.sum / steps.count);
    if (row.energyGain > kAllowedGain) return fmt::format("energy: gained {:.3g} of its largest kinetic energy", row.energyGain);
    if (steps.liquidMass == 0.0) return "";
    const double speed = std::sqrt(2.0 * energy.largestKinetic / steps.liquidMass);
    if (row.largestSpeed > kAllowedSpeed * speed)
        return fmt::format("speed: a particle at {:.3g} cm/s; all liquid {:.3g} cm/s", row.largestSpeed, speed);
    return "";
}

}  // namespace

StabilityRow judgeStability(const CrewEnd& end, const std::filesystem::path& folder, StabilityRow row)
{
    constexpr int kNoPictures = 0;
    const StressOutcome outcome = judgeEnd(end, folder, kNoPictures);
    const Energy energy = energyOf(folder / "energy_ledger.csv");
    row.seconds = outcome.seconds;
    row.energyGain = energy.largestKinetic > 0.0 ? energy.gain / energy.largestKinetic : 0.0;
    row.why = withoutCommas(outcome.message);
    if (outcome.ending == StressEnding::NotFinite) {
        row.why = "not finite: " + row.why;
    } else {
        const Steps steps = stepsOf(folder / "steps.jsonl");
        row.largestSpeed = steps.largestSpeed;
        if (outcome.ending == StressEnding::Finished) row.why = withoutCommas(whyUnstable(row, steps, energy));
        else row.why = fmt::format("{}: {}", kStressEndings[static_cast<int>(outcome.ending)], row.why);
    }
    row.isStable = outcome.ending == StressEnding::Finished && row.why.empty();
    return row;
}

}  // namespace app
