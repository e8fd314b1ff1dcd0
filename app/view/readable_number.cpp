#include "app/view/readable_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// "0.0200" is "0.02".
std::string withoutZerosAtEnd(std::string text)
{
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

}  // namespace

std::string readableNumber(double value, int digits)
{
    if (value == 0.0) return "0";
    if (!std::isfinite(value)) return fmt::format("{}", value);
    const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
    const std::size_t e = scientific.find('e');
    const int exponent = std::stoi(scientific.substr(e + 1));
    if (exponent >= -4 && exponent < 6) return withoutZerosAtEnd(fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent)));
    return fmt::format("{}e{}", withoutZerosAtEnd(scientific.substr(0, e)), exponent);
}

}  // namespace app
