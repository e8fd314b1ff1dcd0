#include "app/lab/checks/statistic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace app {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double mean(std::span<const Sample> all)
{
    return std::accumulate(all.begin(), all.end(), 0.0, [](double sum, const Sample& r) { return sum + r.value; }) / static_cast<double>(all.size());
}

/// Slope of the straight line through points.
double slope(std::span<const Sample> all)
{
    if (all.size() < 2) return kNone;
    double middle = 0.0;
    for (const Sample& r : all) middle += r.at / static_cast<double>(all.size());
    const double level = mean(all);
    double across = 0.0, along = 0.0;
    for (const Sample& r : all) {
        across += (r.at - middle) * (r.value - level);
        along += (r.at - middle) * (r.at - middle);
    }
    return across / along;
}

double slopeOfLogarithm(std::span<const Sample> all, bool isOfBoth)
{
    std::vector<Sample> logarithms;
    for (const Sample& r : all)
        if (!isOfBoth || (r.at > 0.0 && r.value > 0.0))
            logarithms.push_back({.at = isOfBoth ? std::log(r.at) : r.at, .value = std::log(std::abs(r.value))});
    return slope(logarithms);
}

/// Where readings pass their mean, and the largest distance from it between two passings.
struct Oscillations {
    std::vector<double> passings;
    std::vector<Sample> peaks;
};

Oscillations oscillationsOf(std::span<const Sample> all)
{
    Oscillations swings;
    const double level = mean(all);
    Sample peak;
    for (std::size_t i = 1; i < all.size(); ++i) {
        const double before = all[i - 1].value - level, now = all[i].value - level;
        if ((before < 0.0) != (now < 0.0)) {
            if (!swings.passings.empty()) swings.peaks.push_back(peak);  // before the first passing it may be part of one only
            swings.passings.push_back(all[i - 1].at + (all[i].at - all[i - 1].at) * before / (before - now));
            peak = {};
        }
        if (std::abs(now) > peak.value) peak = {.at = all[i].at, .value = std::abs(now)};
    }
    return swings;
}

double period(std::span<const Sample> all)
{
    const std::vector<double> passings = oscillationsOf(all).passings;
    if (passings.size() < 3) return kNone;
    return 2.0 * (passings.back() - passings.front()) / static_cast<double>(passings.size() - 1);
}

std::vector<double> errors(std::span<const Sample> all)
{
    std::vector<double> errors;
    for (const Sample& r : all) errors.push_back(std::abs(r.value / r.expected - 1.0));
    return errors;
}

double rmsError(std::span<const Sample> all)
{
    double error = 0.0, size = 0.0;
    for (const Sample& r : all) {
        error += (r.value - r.expected) * (r.value - r.expected);
        size += (r.expected - all.front().expected) * (r.expected - all.front().expected);
    }
    return std::sqrt(error / size);
}

double rmsDifference(std::span<const Sample> all)
{
    double sum = 0.0;
    for (const Sample& r : all) sum += (r.value - r.expected) * (r.value - r.expected);
    return std::sqrt(sum / static_cast<double>(all.size()));
}

double shareInside(std::span<const Sample> all)
{
    const auto inside = std::ranges::count_if(all, [](const Sample& r) { return r.lower <= r.value && r.value <= r.upper; });
    return static_cast<double>(inside) / static_cast<double>(all.size());
}

double reach(std::span<const Sample> all, double level)
{
    for (std::size_t i = 1; i < all.size(); ++i) {
        const Sample &before = all[i - 1], &now = all[i];
        if (before.value < level && now.value >= level) return before.at + (now.at - before.at) * (level - before.value) / (now.value - before.value);
    }
    return kNone;
}

}  // namespace

double statisticOf(Statistic what, std::span<const Sample> all, double level)
{
    if (all.empty()) return kNone;
    const auto byValue = [](const Sample& a, const Sample& b) { return a.value < b.value; };
    switch (what) {
        case Statistic::First: return all.front().value;
        case Statistic::Last: return all.back().value;
        case Statistic::Mean: return mean(all);
        case Statistic::Smallest: return std::ranges::min_element(all, byValue)->value;
        case Statistic::Largest: return std::ranges::max_element(all, byValue)->value;
        case Statistic::Change: return all.back().value - all.front().value;
        case Statistic::Slope: return slope(all);
        case Statistic::Exponent: return slopeOfLogarithm(all, true);
        case Statistic::Rate: return -slopeOfLogarithm(all, false);
        case Statistic::EnvelopeRate: return -slopeOfLogarithm(oscillationsOf(all).peaks, false);
        case Statistic::Period: return period(all);
        case Statistic::MeanError: {
            const auto of = errors(all);
            return std::accumulate(of.begin(), of.end(), 0.0) / static_cast<double>(of.size());
        }
        case Statistic::LargestError: return std::ranges::max(errors(all));
        case Statistic::RmsError: return rmsError(all);
        case Statistic::RmsDifference: return rmsDifference(all);
        case Statistic::ShareInside: return shareInside(all);
        case Statistic::Reach: return reach(all, level);
        case Statistic::SmallestAt: return std::ranges::min_element(all, byValue)->at;
        case Statistic::LargestAt: return std::ranges::max_element(all, byValue)->at;
    }
    return kNone;
}

}  // namespace app
