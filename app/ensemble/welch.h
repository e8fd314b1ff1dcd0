#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

// Mean and spread of repeated runs, and whether two means differ.

namespace app {

/// Mean and spread of some numbers; those that are not finite are left out.
struct Spread {
    std::size_t count = 0;
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation, with count − 1 below; 0 for a single number
    double lowest = 0.0, highest = 0.0;

    double variance() const { return deviation * deviation; }
    /// A mean within its own deviation of 0 is no measure for what is beside it.
    bool isAwayFromZero() const { return std::abs(mean) > deviation; }
    /// Half the width of the interval around the mean in which the true one lies with this confidence; none for a single number.
    double marginOfMean(double confidence) const;
};

Spread spreadOf(std::span<const double> numbers);

/// "880 ± 150": mean ± standard deviation, both as far as two digits of the latter go.
std::string textOf(const Spread& spread);

/// Probability that Student's t with so many degrees of freedom is at least this far from 0.
double studentTail(double t, double degrees);

/// How far from 0 Student's t is with this probability at most.
/// @param tail  on both sides together, in (0, 1)
double studentQuantile(double tail, double degrees);

/// The difference of two means.
struct MeanDifference {
    double difference = 0.0;
    double margin = 0.0;  ///< the true one is within so much of it, with the confidence that was asked for; infinite for too few numbers

    bool isSeen() const { return difference > margin || -difference > margin; }
};

/// Difference of numbers that come in pairs, of which one may have none: from the spread of each pair's own difference, however much the pairs
/// differ.
/// @param confidence  in (0, 1)
MeanDifference pairedDifference(std::span<const double> a, std::span<const double> b, double confidence);

/// Difference of b from a, with spreads of their own (Welch 1947). Degrees of freedom are one less than the smaller number of runs, the fewest that
/// Welch allows: the more of Satterthwaite 1946 are right for normal numbers, but not for those drawn evenly from a range. Where neither has a spread
/// the difference is certain if chance alone would hardly sort as many runs so, and else open.
/// @param confidence  in (0, 1)
MeanDifference welchDifference(const Spread& a, const Spread& b, double confidence);

}  // namespace app
