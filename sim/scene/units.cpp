#include "sim/scene/units.h"

#include "sim/core/units.h"
#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

namespace sim {

namespace {

/// Powers of the base units: length, mass, time, and the angle, which is kept apart to catch mistakes.
struct Dimension {
    int length = 0, mass = 0, time = 0, angle = 0;
    bool operator==(const Dimension&) const = default;
};

struct QuantityInfo {
    const char* name;
    Dimension dimension;
    const char* cgs;
    const char* si;
    int siInCgs;  ///< power of ten that one SI unit is
};

const QuantityInfo& infoOf(Quantity quantity)
{
    static constexpr std::array<QuantityInfo, 17> kInfo = {{
        {"plain number", {}, "", "", 0},
        {"length", {1, 0, 0, 0}, "cm", "m", 2},
        {"time", {0, 0, 1, 0}, "s", "s", 0},
        {"mass", {0, 1, 0, 0}, "g", "kg", 3},
        {"velocity", {1, 0, -1, 0}, "cm/s", "m/s", 2},
        {"acceleration", {1, 0, -2, 0}, "cm/s^2", "m/s^2", 2},
        {"density", {-3, 1, 0, 0}, "g/cm^3", "kg/m^3", -3},
        {"pressure", {-1, 1, -2, 0}, "dyn/cm^2", "Pa", 1},
        {"viscosity", {-1, 1, -1, 0}, "P", "Pa s", 1},
        {"surface tension", {0, 1, -2, 0}, "dyn/cm", "N/m", 3},
        {"stiffness", {0, 1, -2, 0}, "dyn/cm", "N/m", 3},
        {"bending stiffness", {2, 1, -2, 0}, "dyn cm", "N m", 7},
        {"volume", {3, 0, 0, 0}, "cm^3", "m^3", 6},
        {"frequency", {0, 0, -1, 0}, "1/s", "1/s", 0},
        {"angle", {0, 0, 0, 1}, "deg", "deg", 0},
        {"angle", {0, 0, 0, 1}, "deg", "deg", 0},
        {"turn rate", {0, 0, -1, 1}, "deg/s", "deg/s", 0},
    }};
    return kInfo[static_cast<std::size_t>(quantity)];
}

struct Unit {
    const char* symbol;
    int decimals;  ///< power of ten that it is in CGS …
    Dimension dimension;
    bool takesPrefix = true;
    double factor = 1.0;  ///< … times this
};

// Angles count in degrees here: bare numbers of a scene are degrees, and the change to radians comes last.
constexpr Unit kUnits[] = {
    {"m", 2, {1, 0, 0, 0}},        {"g", 0, {0, 1, 0, 0}},
    {"s", 0, {0, 0, 1, 0}},        {"min", 0, {0, 0, 1, 0}, false, 60.0},
    {"N", 5, {1, 1, -2, 0}},       {"dyn", 0, {1, 1, -2, 0}, false},
    {"Pa", 1, {-1, 1, -2, 0}},     {"Ba", 0, {-1, 1, -2, 0}, false},
    {"bar", 6, {-1, 1, -2, 0}},    {"P", 0, {-1, 1, -1, 0}},
    {"J", 7, {2, 1, -2, 0}},       {"erg", 0, {2, 1, -2, 0}, false},
    {"Hz", 0, {0, 0, -1, 0}},      {"l", 3, {3, 0, 0, 0}},
    {"L", 3, {3, 0, 0, 0}},        {"deg", 0, {0, 0, 0, 1}, false},
    {"°", 0, {0, 0, 0, 1}, false}, {"rad", 0, {0, 0, 0, 1}, true, 180.0 / kPi},
    {"%", -2, {}, false},          {"1", 0, {}, false},
};

struct Prefix {
    const char* symbol;
    int decimals;
};
constexpr Prefix kPrefixes[] = {{"n", -9}, {"u", -6}, {"µ", -6}, {"μ", -6}, {"m", -3}, {"c", -2}, {"d", -1}, {"k", 3}, {"M", 6}, {"G", 9}};

/// Scale of a product of units: 10^decimals · factor.
struct Scale {
    int decimals = 0;
    double factor = 1.0;
    Dimension dimension;
};

std::optional<Scale> unitNamed(std::string_view symbol)
{
    for (const Unit& unit : kUnits) {
        if (symbol == unit.symbol) return Scale{unit.decimals, unit.factor, unit.dimension};
    }
    for (const Unit& unit : kUnits) {
        if (!unit.takesPrefix) continue;
        for (const Prefix& prefix : kPrefixes) {
            const std::string_view head(prefix.symbol), tail(unit.symbol);
            if (symbol.size() == head.size() + tail.size() && symbol.starts_with(head) && symbol.ends_with(tail)) {
                return Scale{prefix.decimals + unit.decimals, unit.factor, unit.dimension};
            }
        }
    }
    return std::nullopt;
}

void multiply(Scale& scale, const Scale& unit, int power)
{
    scale.decimals += power * unit.decimals;
    for (int i = 0; i < std::abs(power); ++i) scale.factor = power > 0 ? scale.factor * unit.factor : scale.factor / unit.factor;
    scale.dimension.length += power * unit.dimension.length;
    scale.dimension.mass += power * unit.dimension.mass;
    scale.dimension.time += power * unit.dimension.time;
    scale.dimension.angle += power * unit.dimension.angle;
}

bool isSeparator(char c) { return c == ' ' || c == '*' || c == '/'; }

/// Reads one factor "cm^2" or "s-1" into the scale; false if it is none.
bool readFactor(std::string_view word, bool isDivisor, Scale& scale)
{
    constexpr int kMaxPower = 9;
    std::size_t end = word.size();
    while (end > 1 && ((word[end - 1] >= '0' && word[end - 1] <= '9') || word[end - 1] == '-')) --end;
    std::string_view symbol = word.substr(0, end), exponent = word.substr(end);
    if (symbol.ends_with('^')) {
        symbol.remove_suffix(1);
        if (exponent.empty()) return false;
    }
    int power = 1;
    if (!exponent.empty()) {
        const auto [stop, error] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
        if (error != std::errc() || stop != exponent.data() + exponent.size() || std::abs(power) > kMaxPower) return false;
    }
    const std::optional<Scale> unit = unitNamed(symbol);
    if (!unit) return false;
    multiply(scale, *unit, isDivisor ? -power : power);
    return true;
}

void replaceAll(std::string& text, std::string_view from, std::string_view to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
}

/// Reads a product of units like "dyn s/cm^2"; a slash divides by the one unit after it.
std::optional<Scale> parseUnit(std::string_view given)
{
    std::string text(given);
    replaceAll(text, "²", "^2");
    replaceAll(text, "³", "^3");
    replaceAll(text, "·", " ");
    Scale scale;
    bool isDivisor = false;
    for (std::size_t i = 0; i < text.size();) {
        if (isSeparator(text[i])) {
            if (text[i] == '/' && isDivisor) return std::nullopt;
            isDivisor = isDivisor || text[i] == '/';
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < text.size() && !isSeparator(text[end])) ++end;
        if (!readFactor(std::string_view(text).substr(i, end - i), isDivisor, scale)) return std::nullopt;
        isDivisor = false;
        i = end;
    }
    if (isDivisor || !std::isfinite(scale.factor)) return std::nullopt;
    return scale;
}

std::string describeDimension(const Dimension& dimension)
{
    for (int q = 0; q <= static_cast<int>(Quantity::TurnRateDegrees); ++q) {
        const QuantityInfo& info = infoOf(static_cast<Quantity>(q));
        if (info.dimension == dimension) return info.name;
    }
    return "different quantity";
}

std::string withArticle(const std::string& name) { return (std::string_view("aeiou").find(name[0]) == std::string_view::npos ? "a " : "an ") + name; }

double toStored(double inFile, Quantity quantity) { return quantity == Quantity::Angle ? inFile * kPi / 180.0 : inFile; }

std::string example(Quantity quantity)
{
    const QuantityInfo& info = infoOf(quantity);
    return *info.cgs ? fmt::format("{} like 0.5 or \"0.5 {}\"", nameOf(quantity), info.cgs) : "a number like 0.5";
}

ParsedNumber problem(std::string text) { return {0.0, std::move(text)}; }

/// A number as it is written, times a power of ten: rounded once, so that 1.65e-4 m is 0.0165 cm to the last bit. Infinite where it is out of
/// range.
double shiftedNumber(std::string_view digits, int decimals, double number)
{
    if (decimals == 0 || number == 0.0) return number;
    const std::size_t e = digits.find_first_of("eE");
    int exponent = 0;
    if (e != std::string_view::npos) {
        const std::string_view tail = digits.substr(e + 1 + (digits[e + 1] == '+' ? 1 : 0));
        std::from_chars(tail.data(), tail.data() + tail.size(), exponent);
    }
    const std::string text = fmt::format("{}e{}", digits.substr(0, e), exponent + decimals);
    double shifted = 0.0;
    const std::errc error = std::from_chars(text.data(), text.data() + text.size(), shifted).ec;
    return error == std::errc() ? shifted : std::numeric_limits<double>::infinity();
}

/// -0 is 0: there is no other scene with it.
double unsignedZero(double value) { return value == 0.0 ? 0.0 : value; }

}  // namespace

std::string nameOf(Quantity quantity) { return withArticle(infoOf(quantity).name); }

const char* unitOf(Quantity quantity, bool isSi) { return isSi ? infoOf(quantity).si : infoOf(quantity).cgs; }

double inFileUnits(double stored, Quantity quantity) { return quantity == Quantity::Angle ? stored * 180.0 / kPi : stored; }

ParsedNumber parseNumber(std::string_view text, Quantity quantity, bool isSi)
{
    const std::string_view given = text;
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::result_out_of_range) return problem(fmt::format("{} is out of the range of numbers", inQuotes(given)));
    const std::string_view magnitude = text.starts_with('-') ? text.substr(1) : text;
    for (const char* word : {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"}) {
        if (magnitude == word) return problem(fmt::format("{} is not finite; write a number", inQuotes(given)));
    }
    if (error != std::errc()) return problem(fmt::format("{} is no number; needs {}", inQuotes(given), example(quantity)));
    if (!std::isfinite(number)) return problem(fmt::format("{} is not finite; write a number", inQuotes(given)));

    std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    const QuantityInfo& info = infoOf(quantity);
    if (quantity == Quantity::Angle && unit == "rad") return {unsignedZero(number), ""};  // as it is stored: not through degrees and back
    const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.data()));
    double inFile = isSi ? shiftedNumber(digits, info.siInCgs, number) : number;
    if (!unit.empty()) {
        const std::optional<Scale> scale = parseUnit(unit);
        if (!scale) return problem(fmt::format("{} has the unknown unit {}; needs {}", inQuotes(given), inQuotes(unit), example(quantity)));
        if (!(scale->dimension == info.dimension)) {
            return problem(fmt::format("{} is {}, needs {}{}", inQuotes(given), withArticle(describeDimension(scale->dimension)), nameOf(quantity),
                                       *info.cgs ? fmt::format(" (in {})", info.cgs) : ""));
        }
        inFile = shiftedNumber(digits, scale->decimals, number) * scale->factor;
    }
    if (!std::isfinite(inFile)) return problem(fmt::format("{} is out of the range of numbers", inQuotes(given)));
    return {unsignedZero(toStored(inFile, quantity)), ""};
}

std::string formatPlain(double value)
{
    std::string text = fmt::format("{}", unsignedZero(value));
    const std::size_t exponent = text.find('e');
    // YAML 1.1 readers take 1e-05 for a word; 1.0e-05 is a number everywhere.
    if (exponent != std::string::npos && text.find('.') == std::string::npos) text.insert(exponent, ".0");
    return text;
}

std::string formatNumber(double stored, Quantity quantity)
{
    if (quantity != Quantity::Angle) return formatPlain(stored);
    // The nearest short number of degrees that turns back into the same radians; else radians, which need no change.
    const double degrees = inFileUnits(stored, quantity);
    for (int digits = 6; digits <= 17; ++digits) {
        const std::string text = fmt::format("{:.{}g}", degrees, digits);
        if (parseNumber(text, quantity, false).value == stored) return text;
    }
    for (const double near : {std::nextafter(degrees, -1.0e9), std::nextafter(degrees, 1.0e9)}) {
        if (toStored(near, quantity) == stored) return formatPlain(near);
    }
    return formatPlain(stored) + " rad";
}

}  // namespace sim
