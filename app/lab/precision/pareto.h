#pragma once

#include <limits>
#include <optional>
#include <vector>

namespace app {

/// What a run took and how far off it was.
struct Cost {
    double seconds = 0.0;
    double error = 0.0;
    bool operator==(const Cost&) const = default;
};

/// The costs to which no other is both faster and nearer: seconds ascend, errors descend. Only finite, positive ones.
std::vector<Cost> paretoFront(std::vector<Cost> all);

/// Time that a front needs for an error, between its points by powers; the fastest for errors above all of them,
/// nothing below.
std::optional<double> secondsAt(const std::vector<Cost>& front, double error);

}  // namespace app
