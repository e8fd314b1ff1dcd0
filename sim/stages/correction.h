#pragma once

namespace sim {

/// Largest share of an error of the particles' spacing, or of the liquid's volume, that is corrected at once [-]. A correction waits while
/// several short steps together would correct less.
inline constexpr double kGentleCorrection = 0.2;

/// Is it time for a correction that acts at `rate` [1/s] and was last made `interval` [s] before the end of this step?
inline bool isDue(double rate, double interval, double dt)
{
    constexpr double kRoundOff = 1.0 + 1.0e-9;  // eight steps of 2e-4 s at the default rates make exactly the gentle share
    return rate > 0.0 && rate * (interval + dt) > kGentleCorrection * kRoundOff;
}

}  // namespace sim
