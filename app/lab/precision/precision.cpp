#include "app/lab/precision/precision.h"

#include <algorithm>
#include <cmath>

namespace app {

bool Precision::needsConverged() const
{
    return std::ranges::any_of(errors, [](const Check& check) { return !check.expect && check.table.empty(); });
}

double errorOf(const Check& check, std::span<const Sample> readings)
{
    const Finding finding = judge(check, readings);
    if (check.hasCurve()) return finding.value;
    const double distance = std::abs(finding.value - finding.expected);
    return finding.expected == 0.0 ? distance : distance / std::abs(finding.expected);
}

}  // namespace app
