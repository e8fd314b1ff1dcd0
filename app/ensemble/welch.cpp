#include "app/ensemble/welch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace app {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The continued fraction of the incomplete beta function by the method of Lentz (Press et al. 2007, Numerical Recipes, section 6.4).
double betaFraction(double a, double b, double x)
{
    constexpr double kTiny = 1.0e-300;
    constexpr int kMostTerms = 10'000;
    const auto notZero = [](double y) { return std::abs(y) < kTiny ? kTiny : y; };
    double c = 1.0, d = 1.0 / notZero(1.0 - (a + b) * x / (a + 1.0)), value = d;
    for (int m = 1; m <= kMostTerms; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
        double factor = 1.0;
        for (const double term : {even, odd}) {
            d = 1.0 / notZero(1.0 + term * d);
            c = notZero(1.0 + term / c);
            factor *= c * d;
        }
        value *= factor;
        if (std::abs(factor - 1.0) < std::numeric_limits<double>::epsilon()) break;
    }
    return value;
}

/// The regularised incomplete beta function I_x(a, b).
double incompleteBeta(double a, double b, double x)
{
    if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * betaFraction(a, b, x) / a;
    return 1.0 - front * betaFraction(b, a, 1.0 - x) / b;
}

/// Probability that chance puts all that are alike into one group: of the ways to choose one group's numbers two are so.
double chanceOfSorting(double na, double nb) { return 2.0 * std::exp(std::lgamma(na + 1.0) + std::lgamma(nb + 1.0) - std::lgamma(na + nb + 1.0)); }

}  // namespace

double Spread::marginOfMean(double confidence) const
{
    if (count < 2) return kInfinity;
    const auto n = static_cast<double>(count);
    return deviation > 0.0 ? studentQuantile(1.0 - confidence, n - 1.0) * deviation / std::sqrt(n) : 0.0;
}

Spread spreadOf(std::span<const double> numbers)
{
    Spread spread = {.count = 0, .mean = 0.0, .deviation = 0.0, .lowest = kInfinity, .highest = -kInfinity};
    double squares = 0.0;  // of distances to the mean, by Welford's update
    for (const double x : numbers) {
        if (!std::isfinite(x)) continue;
        const double before = x - spread.mean;
        spread.mean += before / static_cast<double>(++spread.count);
        squares += before * (x - spread.mean);
        spread.lowest = std::min(spread.lowest, x);
        spread.highest = std::max(spread.highest, x);
    }
    if (spread.count > 1 && spread.lowest < spread.highest) spread.deviation = std::sqrt(squares / static_cast<double>(spread.count - 1));
    return spread;
}

std::string textOf(const Spread& spread)
{
    constexpr double kSmallest = 1.0e-6, kLargest = 1.0e7;  // with exponents beyond
    if (!(spread.deviation >= kSmallest) || std::max(std::abs(spread.mean), spread.deviation) >= kLargest)
        return fmt::format("{:.5g} ± {:.2g}", spread.mean, spread.deviation);
    const int lastDigit = static_cast<int>(std::floor(std::log10(spread.deviation))) - 1;
    if (lastDigit <= 0) return fmt::format("{:.{}f} ± {:.{}f}", spread.mean, -lastDigit, spread.deviation, -lastDigit);
    const double unit = std::pow(10.0, lastDigit);
    return fmt::format("{:.0f} ± {:.0f}", unit * std::round(spread.mean / unit), unit * std::round(spread.deviation / unit));
}

double studentTail(double t, double degrees) { return incompleteBeta(0.5 * degrees, 0.5, degrees / (degrees + t * t)); }

double studentQuantile(double tail, double degrees)
{
    double low = 0.0, high = 1.0;
    while (studentTail(high, degrees) > tail) high *= 2.0;
    while (high - low > 1.0e-12 * high) {
        const double middle = 0.5 * (low + high);
        (studentTail(middle, degrees) > tail ? low : high) = middle;
    }
    return high;
}

MeanDifference welchDifference(const Spread& a, const Spread& b, double confidence)
{
    MeanDifference found = {b.mean - a.mean, kInfinity};
    if (a.count < 2 || b.count < 2) return found;
    const double na = static_cast<double>(a.count), nb = static_cast<double>(b.count), variance = a.variance() / na + b.variance() / nb;
    if (variance > 0.0) found.margin = studentQuantile(1.0 - confidence, std::min(na, nb) - 1.0) * std::sqrt(variance);
    else if (found.difference == 0.0 || chanceOfSorting(na, nb) <= 1.0 - confidence) found.margin = 0.0;
    return found;
}

MeanDifference pairedDifference(std::span<const double> a, std::span<const double> b, double confidence)
{
    std::vector<double> differences;
    for (std::size_t n = 0; n < a.size(); ++n) differences.push_back(b[n] - a[n]);
    const Spread spread = spreadOf(differences);
    MeanDifference found = {spread.mean, kInfinity};
    if (spread.count < 2) return found;
    // Without a spread: chance gives all of them one sign once in 2^(n-1) times.
    if (spread.deviation > 0.0) found.margin = spread.marginOfMean(confidence);
    else if (spread.mean == 0.0 || std::ldexp(2.0, -static_cast<int>(spread.count)) <= 1.0 - confidence) found.margin = 0.0;
    return found;
}

}  // namespace app
