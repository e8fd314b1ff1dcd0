#pragma once

#include "app/system/csv.h"
#include "tests/app/checkpoint/small_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

// Runs of the small scene with probes, and the tables that they leave.

namespace app::test {

inline constexpr const char* kProbesOfAll = R"yaml({every: 4.0e-3,
  control_surfaces: {plane: {center: [0, 0.5, 0], normal: [0, -1, 0]}, aside: {center: [9, 0.5, 0], normal: [0, -1, 0], radius: 1}},
  readings: [{name: height, unit: cm, read: liquid_y}, {name: through, unit: g/s, read: flux("plane")}, {name: aside, unit: g/s, read: flux("aside")},
             {name: wetness, unit: "-", read: "saturation_at(x, y, z)", along: {from: [-1, 0, 0], to: [1, 0, 0], points: 5}}, {read: "vertex_y(14)", unit: cm}]})yaml";

class ProbedRuns : public testing::Test, protected SmallRuns {
 protected:
    static std::string probes(const std::string& all) { return "output.probes=" + all; }
    /// Columns of a table by name.
    std::map<std::string, std::vector<double>> table(const std::string& file) const
    {
        std::map<std::string, std::vector<double>> columns;
        const std::vector<std::string> lines = linesOf(folder / file), names = csvCells(lines.at(0));
        for (std::size_t row = 1; row < lines.size(); ++row) {
            const std::vector<std::string> cells = csvCells(lines[row]);
            for (std::size_t c = 0; c < names.size(); ++c)
                columns[names[c]].push_back(c < cells.size() && !cells[c].empty() ? std::stod(cells[c]) : std::nan(""));
        }
        return columns;
    }
};

}  // namespace app::test
