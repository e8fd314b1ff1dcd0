#include "app/lab/precision/precision_cases.h"

#include <algorithm>

namespace app {

std::vector<Cost> PrecisionCase::front() const
{
    std::vector<Cost> costs;
    for (const PrecisionRow& row : rows) costs.push_back({row.wallSeconds, row.error});
    return paretoFront(std::move(costs));
}

std::vector<Cost> PrecisionCase::costsOf(const std::string& method, const std::string& integrator) const
{
    std::vector<Cost> costs;
    for (const PrecisionRow& row : rows)
        if (row.names.method == method && row.names.integrator == integrator) costs.push_back({row.wallSeconds, row.error});
    return costs;
}

bool PrecisionCase::isOnFront(const PrecisionRow& row) const
{
    const std::vector<Cost> all = front();
    return std::ranges::find(all, Cost{row.wallSeconds, row.error}) != all.end();
}

bool PrecisionCase::isPublished(const PrecisionRow& row) const
{
    PrecisionNames wanted = precision.published;
    wanted.resolution = row.names.resolution;
    return row.names == wanted;
}

std::vector<Gain> gainsOf(const PrecisionCase& of)
{
    const std::vector<Cost> front = of.front();
    std::vector<Gain> gains;
    for (const PrecisionRow& published : of.rows) {
        const auto seconds = of.isPublished(published) ? secondsAt(front, published.error) : std::nullopt;
        if (!seconds) continue;
        Gain gain{&published, *seconds, &published};
        for (const PrecisionRow& row : of.rows)
            if (row.error <= published.error && row.wallSeconds < gain.ours->wallSeconds) gain.ours = &row;
        gains.push_back(gain);
    }
    return gains;
}

}  // namespace app
