#pragma once

#include "sim/forces.h"
#include "sim/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace app {

/// What forces act on, as a scene calls it, in the order of sim::Forces.
struct ForceNames {
    ForceNames() = default;
    explicit ForceNames(const sim::Scene& scene);

    /// A group of pins: "sheet" where it is all pins of a fabric and has no name, else "sheet.left", or "sheet.0" by its number.
    struct Pins {
        std::string name, own;  ///< own: what the group itself is called; may be empty
        int fabric = 0;
    };
    std::vector<std::string> obstacles, fabrics;
    std::vector<Pins> pins;
};

/// Forces of steps that follow each other, summed up: their mean, and the largest of a step. Loads are those by liquid and by contact of the first
/// obstacle, of the second and so on, then of each fabric, then of each group of pins.
struct ForceTotals {
    double time = 0.0;            ///< [s]
    double firstTime = 0.0;       ///< length of the last step, if it is the first of two [s]
    std::vector<double> numbers;  ///< numbers of each load: impulse [g cm/s] and its moment [g cm^2/s], largest force [dyn] and torque [dyn cm], and
                                  ///< impulse and moment of the first of two steps
    /// @param isFirst  of two steps, of which this one reflects: only both together tell of forces how large they are
    void add(const sim::Forces& forces, bool isFirst = false);
    /// Mean force [dyn] and torque [dyn cm] of a load, by its number.
    sim::Impulse mean(std::size_t load) const;
};

/// Forces [dyn] and torques about the origin [dyn cm] of one step, and where momentum went [g cm/s]: for steps.jsonl.
nlohmann::ordered_json forcesJson(const ForceNames& names, const sim::Forces& forces);
nlohmann::ordered_json balanceJson(const sim::Forces& forces);
/// Mean and largest: for report.json.
nlohmann::ordered_json forcesJson(const ForceNames& names, const ForceTotals& totals);

}  // namespace app
