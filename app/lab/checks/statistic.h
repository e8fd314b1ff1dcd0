#pragma once

#include "sim/scene/choice.h"

#include <limits>
#include <span>

namespace app {

/// One reading of a run: where it was taken (a time, or what the check is plotted against), what was read, what is
/// known.
struct Sample {
    double at = 0.0, value = 0.0, expected = 0.0;
    double lower = std::numeric_limits<double>::quiet_NaN();  ///< lower end of the band that was measured; NaN: none is known
    double upper = std::numeric_limits<double>::quiet_NaN();  ///< upper end
};

/// What a check makes of its readings: one number.
enum class Statistic {
    First,
    Last,
    Mean,
    Smallest,
    Largest,
    Change,         ///< last value less the first
    Slope,          ///< slope of the straight line through them (least squares)
    Exponent,       ///< slope of ln value over ln at
    Rate,           ///< rate at which values decay: −slope of ln |value|
    EnvelopeRate,   ///< rate of the peaks between passings of the mean
    Period,         ///< twice the mean distance of passings of the mean
    MeanError,      ///< mean of |value / expected − 1|
    LargestError,   ///< largest of |value / expected − 1|
    RmsError,       ///< root mean square of value − expected, relative to that of how far the latter goes from its first
    RmsDifference,  ///< root mean square of value − expected
    ShareInside,    ///< share of readings inside the band that was measured
    Reach,          ///< place where they first pass a level upwards
    SmallestAt,     ///< place where they are smallest
    LargestAt,      ///< place where they are largest
};

/// Statistics as scene files write them.
inline std::span<const sim::Choice<Statistic>> choicesOf(Statistic)
{
    static constexpr sim::Choice<Statistic> kAll[] = {{"first", Statistic::First},
                                                      {"last", Statistic::Last},
                                                      {"mean", Statistic::Mean},
                                                      {"smallest", Statistic::Smallest},
                                                      {"largest", Statistic::Largest},
                                                      {"change", Statistic::Change},
                                                      {"slope", Statistic::Slope},
                                                      {"exponent", Statistic::Exponent},
                                                      {"rate", Statistic::Rate},
                                                      {"envelope_rate", Statistic::EnvelopeRate},
                                                      {"period", Statistic::Period},
                                                      {"mean_error", Statistic::MeanError},
                                                      {"largest_error", Statistic::LargestError},
                                                      {"rms_error", Statistic::RmsError},
                                                      {"rms_difference", Statistic::RmsDifference},
                                                      {"share_inside", Statistic::ShareInside},
                                                      {"reach", Statistic::Reach},
                                                      {"smallest_at", Statistic::SmallestAt},
                                                      {"largest_at", Statistic::LargestAt}};
    return kAll;
}

/// NaN where there are too few readings for it.
/// @param level  of Statistic::Reach
double statisticOf(Statistic what, std::span<const Sample> readings, double level = 0.0);

}  // namespace app
