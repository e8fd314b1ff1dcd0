#pragma once

#include <limits>
#include <string>

namespace sim {

/// What values a number of a scene may have, in the unit it is written in (cgs, degrees).
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool isLowOpen = false;   ///< low itself is not allowed
    bool isHighOpen = false;  ///< nor is high

    static Range any() { return {}; }
    static Range above(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }
    static Range atLeast(double low) { return {low, std::numeric_limits<double>::infinity(), false}; }
    static Range between(double low, double high) { return {low, high, false}; }
    static Range inside(double low, double high) { return {low, high, true, true}; }
    static Range aboveTo(double low, double high) { return {low, high, true}; }

    bool contains(double x) const { return (isHighOpen ? x < high : x <= high) && (isLowOpen ? x > low : x >= low); }
    /// "above 0 s", "at least 0", "0 to 1", "above 0, at most 1", "above -1, below 0.5"; "" for any.
    std::string text(const std::string& unit) const;
};

}  // namespace sim
