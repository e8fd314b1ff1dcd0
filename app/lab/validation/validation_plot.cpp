#include "app/lab/validation/validation_plot.h"

#include "app/system/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// Is what is expected drawn beside the readings: where it is known at each, or is what one of them or their mean is
/// compared with?
bool hasLine(const Check& check) { return check.hasCurve() || (check.expect && check.statistic <= Statistic::Largest); }

/// Is a place on the axis of `against` expected?
bool expectsPlace(const Check& check)
{
    using enum Statistic;
    return check.statistic == Reach || check.statistic == SmallestAt || check.statistic == LargestAt;
}

/// Is its unit that of the readings?
bool isOfReadings(const Check& check) { return check.statistic <= Statistic::Change || check.hasCurve(); }

/// A formula as the label of an axis; none where it is too long for one.
std::string shortText(const std::string& formula)
{
    constexpr std::size_t kLongest = 36;
    return formula.size() > kLongest ? "" : formula;
}

std::string labelOf(const std::string& text) { return gnuplotText(text) + " noenhanced"; }

std::string abscissaLabel(const Check& check)
{
    if (check.profileAt) return labelOf("s [cm]");
    const std::string& against = check.against.text();
    if (against == "t") return labelOf("time [s]");
    const bool isShifted = against.starts_with("t - ") || against.starts_with("t + ");
    return labelOf(isShifted ? against + " [s]" : shortText(against));
}

/// Label of the axis of readings: their unit where one of the checks has it, else what is read.
std::string readingsLabel(const std::vector<const Check*>& checks)
{
    for (const Check* check : checks)
        if (isOfReadings(*check) && !check->unit.empty()) return gnuplotUnit(check->unit);
    return labelOf(shortText(checks.front()->read.text()));
}

/// Name of the check about the whole course where there is one, else of the first; it says so where there are more.
std::string titleOf(const std::vector<const Check*>& checks)
{
    const auto whole = std::ranges::find_if(checks, [](const Check* check) { return check->hasCurve(); });
    if (whole != checks.end()) return (*whole)->name;
    return checks.front()->name + (checks.size() > 1 ? ", …" : "");
}

/// Lines of one panel, one after the other; each is named in the key once.
class Panel {
 public:
    Panel(const CaseResult& result, const std::vector<std::size_t>& numbers) : result_(&result), file_(gnuplotText(result.name + ".csv"))
    {
        for (const std::size_t i : numbers) hasCourse_ = hasCourse_ || check(i).hasCurve();
        for (const std::size_t i : numbers) addBand(i);
        for (const std::size_t i : numbers) addKnown(i);
        for (const std::size_t i : numbers) addLine(i, fmt::format("3 with lines lw 2 lc rgb '{}'", kPlotColors[2]), "found");
    }
    const std::string& text() const { return text_; }

 private:
    const Check& check(std::size_t i) const { return result_->validation.checks[i]; }
    void add(const std::string& line, const std::string& name)
    {
        const bool isNew = std::ranges::find(named_, name) == named_.end();
        if (isNew) named_.push_back(name);
        text_ += fmt::format("{}{} {}", text_.empty() ? "" : ", ", line, isNew ? "title " + gnuplotText(name) : "notitle");
    }
    void addLine(std::size_t i, const std::string& columns, const std::string& name)
    {
        add(fmt::format("{} skip 1 using ($1=={}?$2:NaN):{}", file_, i, columns), name);
    }
    /// The band around a measured course, or between the ends of a measured value; where none is known, what is allowed of it.
    void addBand(std::size_t i)
    {
        constexpr const char *kStyle = "with filledcurves fc rgb '#dddddd' fs solid noborder",
                             *kAllowedStyle = "with filledcurves fc rgb '#f0f0f0' fs solid noborder";
        const bool isValue = result_->validation.kind == KnownFrom::Measured && hasLine(check(i)) && !hasCourse_;
        const bool hasEnds =
            result_->validation.kind == KnownFrom::Measured && check(i).statistic <= Statistic::Largest && check(i).atLeast && check(i).atMost;
        if (check(i).hasBand()) addLine(i, fmt::format("5:6 {}", kStyle), "scatter");
        else if (hasEnds) addLine(i, fmt::format("({}):({}) {}", *check(i).atLeast, *check(i).atMost, kStyle), "scatter");
        else if (isValue && check(i).tolerance)
            addLine(i, fmt::format("($4*{}):($4*{}) {}", 1.0 - *check(i).tolerance, 1.0 + *check(i).tolerance, kAllowedStyle), "allowed");
        else if (isValue && check(i).within) addLine(i, fmt::format("($4-{0}):($4+{0}) {1}", *check(i).within, kAllowedStyle), "allowed");
    }
    /// A measured course, or a value where there is no course, as a grey line along the readings, a time as an upright one between the smallest
    /// and the largest of them.
    void addKnown(std::size_t i)
    {
        const std::string name = knownAs(result_->validation.kind);
        if (check(i).hasCurve() || (hasLine(check(i)) && !hasCourse_)) addLine(i, "4 with lines lw 3 lc rgb '#aaaaaa'", name);
        const auto& readings = result_->readings[i];
        if (!expectsPlace(check(i)) || i >= result_->findings.size() || !std::isfinite(result_->findings[i].expected) || readings.empty()) return;
        const auto [low, high] = std::ranges::minmax(readings, {}, &Sample::value);
        add(fmt::format("{} skip 1 every ::0::1 using ({}):($0==0?{}:{}) with lines lw 1 dt 2 lc rgb '#777777'", file_, result_->findings[i].expected,
                        low.value, high.value),
            "its time");
    }

    const CaseResult* result_;
    bool hasCourse_ = false;  ///< is what is known of the whole course drawn?
    std::string file_, text_;
    std::vector<std::string> named_;
};

/// Distance of ticks at which a few fit under a panel: 1, 2 or 5 times a power of ten; NaN where nothing was read at two places.
double ticksOf(const CaseResult& result, const std::vector<std::size_t>& numbers)
{
    constexpr double kMost = 5.0;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::size_t i : numbers)
        for (const Sample& sample : result.readings[i]) low = std::min(low, sample.at), high = std::max(high, sample.at);
    const double least = (high - low) / kMost, power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= least) return digit * power;
    return 10.0 * power;
}

std::string panel(const CaseResult& result, const std::vector<std::size_t>& numbers)
{
    std::vector<const Check*> checks;
    for (const std::size_t i : numbers) checks.push_back(&result.validation.checks[i]);
    const double ticks = ticksOf(result, numbers);
    std::string text =
        fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", labelOf(titleOf(checks)), abscissaLabel(*checks.front()), readingsLabel(checks));
    if (std::isfinite(ticks) && ticks > 0.0) text += fmt::format("set xtics {:.6g}\n", ticks);
    else text += "set xtics autofreq\n";
    return text + fmt::format("plot {}\n", Panel(result, numbers).text());
}

}  // namespace

const char* knownAs(KnownFrom kind) { return kind == KnownFrom::Measured ? "measured" : "known"; }

std::vector<std::vector<std::size_t>> panelsOf(const std::vector<Check>& checks)
{
    std::vector<std::vector<std::size_t>> panels;
    for (std::size_t i = 0; i < checks.size(); ++i) {
        const auto same = std::ranges::find_if(panels, [&](const auto& panel) {
            const Check& first = checks[panel.front()];
            return first.read.text() == checks[i].read.text() && first.against.text() == checks[i].against.text() &&
                   first.profileAt == checks[i].profileAt;
        });
        if (same == panels.end()) panels.push_back({i});
        else same->push_back(i);
    }
    return panels;
}

std::string validationPlotScript(const CaseResult& result, const std::string& picture)
{
    constexpr std::size_t kMostInRow = 4;
    const auto panels = panelsOf(result.validation.checks);
    const std::size_t rows = (panels.size() + kMostInRow - 1) / kMostInRow, columns = (panels.size() + rows - 1) / rows;
    std::string text = fmt::format(
        "set terminal pngcairo size {},{} font 'DejaVu Sans,11'\nset output {}\nset datafile separator ','\n"
        "set multiplot layout {},{} title {} noenhanced font ',13'\nset border 3 lw 1\nset tics nomirror out scale 0.6\n"
        "set grid ytics lc rgb '#dddddd' lw 1\nset key below horizontal samplen 1.2\nset bmargin 5.5\n"
        "set format y '%.4g'\n",
        std::max<std::size_t>(560, 400 * columns), 380 * rows + 40, gnuplotText(picture), rows, columns, gnuplotText(result.setup.scene.title));
    for (const auto& numbers : panels) text += panel(result, numbers);
    return text + "unset multiplot\n";
}

}  // namespace app
