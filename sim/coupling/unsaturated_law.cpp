#include "sim/coupling/unsaturated_law.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr double kAlike = 1.0e-4;  ///< relative difference below which the middle does for a mean: off by its square [-]

}  // namespace

double UnsaturatedLaw::suction(double saturation) const { return a_ == 1.0 ? 1.0 - saturation : 1.0 - std::pow(saturation, a_); }

double UnsaturatedLaw::permeability(double saturation) const { return b_ == 1.0 ? saturation : std::pow(saturation, b_); }

double UnsaturatedLaw::meanPermeability(double one, double other) const
{
    const double low = std::min(one, other), high = std::max(one, other);
    if (high - low <= kAlike * high) return permeability(0.5 * (low + high));
    const double ratio = low / high;  // powers of it leave no 0/0 where next to nothing is held
    return a_ / (a_ + b_) * std::pow(high, b_) * (1.0 - std::pow(ratio, a_ + b_)) / (1.0 - std::pow(ratio, a_));
}

}  // namespace sim
