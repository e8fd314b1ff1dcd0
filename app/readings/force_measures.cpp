#include "app/backends.h"
#include "app/readings/measures.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

using sim::FormulaError, sim::Impulse;

/// Number of the thing of this name; none if there is no such thing.
std::optional<std::size_t> numberOf(const std::string& name, const std::vector<std::string>& names)
{
    const auto found = std::ranges::find(names, name);
    return found == names.end() ? std::nullopt : std::optional<std::size_t>(found - names.begin());
}

}  // namespace

void Measures::afterStep()
{
    interval_.forces.add(simulation_->forces());
    sumPressures();
}

/// Also while formulas are read, which find wrong names by it.
double Measures::valueBeforeSteps() const
{
    if (simulation_ && beforeSteps_ == BeforeSteps::None) throw NoStepYet();
    return 0.0;
}

std::vector<sim::FormulaNames::OfName> Measures::forces()
{
    std::vector<sim::FormulaNames::OfName> names;
    for (int a = 0; a < sim::kAxes; ++a) {
        const auto add = [&](const std::string& of, auto&& mean) {
            names.push_back({fmt::format("{}force_{}", of, "xyz"[a]), [mean, a](const std::string& name) { return mean(name).linear[a]; }});
            names.push_back({fmt::format("{}torque_{}", of, "xyz"[a]), [mean, a](const std::string& name) { return mean(name).angular[a]; }});
        };
        add("", [this](const std::string& name) { return meanOn(name, true, true); });
        add("liquid_", [this](const std::string& name) { return meanOn(name, true, false); });
        add("contact_", [this](const std::string& name) { return meanOn(name, false, true); });
        add("pin_", [this](const std::string& name) { return meanOnPins(name); });
    }
    return names;
}

Impulse Measures::meanOn(const std::string& name, bool byLiquid, bool byContact) const
{
    const auto obstacle = numberOf(name, forceNames_.obstacles), fabric = numberOf(name, forceNames_.fabrics);
    if (!obstacle && !fabric) throw FormulaError(fmt::format("there is no obstacle and no fabric \"{}\"", name));
    if (obstacle && fabric) throw FormulaError(fmt::format("both an obstacle and a fabric are called \"{}\"", name));
    if (!(interval_.forces.time > 0.0)) return valueBeforeSteps() * Impulse();
    const std::size_t load = 2 * (obstacle ? *obstacle : forceNames_.obstacles.size() + *fabric);
    Impulse sum;
    if (byLiquid) sum += interval_.forces.mean(load);
    if (byContact) sum += interval_.forces.mean(load + 1);
    return sum;
}

Impulse Measures::meanOnPins(const std::string& name) const
{
    const std::size_t first = 2 * (forceNames_.obstacles.size() + forceNames_.fabrics.size());
    Impulse sum;
    bool isFound = false;
    for (std::size_t i = 0; i < forceNames_.pins.size(); ++i) {
        const ForceNames::Pins& pins = forceNames_.pins[i];
        if (pins.name != name && pins.own != name && forceNames_.fabrics[pins.fabric] != name) continue;
        isFound = true;
        sum += interval_.forces.mean(first + i);
    }
    if (!isFound) throw FormulaError(fmt::format("no pins and no fabric with pins are called \"{}\"", name));
    return interval_.forces.time > 0.0 ? sum : valueBeforeSteps() * sum;
}

}  // namespace app
