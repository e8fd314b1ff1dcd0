#include "app/lab/precision/pareto.h"

#include <algorithm>
#include <cmath>

namespace app {

std::vector<Cost> paretoFront(std::vector<Cost> all)
{
    std::erase_if(all, [](const Cost& c) { return !std::isfinite(c.error) || !std::isfinite(c.seconds) || c.error <= 0.0 || c.seconds <= 0.0; });
    std::ranges::sort(all, [](const Cost& a, const Cost& b) { return a.seconds < b.seconds || (a.seconds == b.seconds && a.error < b.error); });
    std::vector<Cost> front;
    for (const Cost& cost : all)
        if (front.empty() || cost.error < front.back().error) front.push_back(cost);
    return front;
}

std::optional<double> secondsAt(const std::vector<Cost>& front, double error)
{
    const auto after = std::ranges::find_if(front, [&](const Cost& c) { return c.error <= error; });
    if (after == front.end()) return std::nullopt;
    if (after == front.begin()) return after->seconds;
    const auto before = std::prev(after);
    const double part = std::log(before->error / error) / std::log(before->error / after->error);
    return before->seconds * std::pow(after->seconds / before->seconds, part);
}

}  // namespace app
