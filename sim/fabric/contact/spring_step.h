#pragma once

namespace sim {

/// What stiffer springs may give, relative to the energy of the fabric's motion: none [-].
inline constexpr double kStiffeningGain = 1.0e-2;

/// Springs of contact go by mass over the square of a time: the length of the step, for whose sake they are as stiff as they are. Where shorter
/// steps made springs that are pressed stiffer, they would hold more energy than was put into them; then they stay as they are.
/// @param before    the time that they have gone by [s]; 0 before the first step
/// @param h         length of the step [s]
/// @param stored    energy that they hold [erg]
/// @param bearable  energy that may come from nothing [erg]
inline double springStepFor(double before, double h, double stored, double bearable)
{
    if (before <= h) return h;
    const double stiffer = (before / h) * (before / h);
    return stored * (stiffer - 1.0) <= bearable ? h : before;
}

}  // namespace sim
