#pragma once

#include "app/lab/checks/statistic.h"
#include "sim/scene/formula.h"

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace app {

/// What is known at a place of `against`: a row of a table.
struct Known {
    double at = 0.0, value = 0.0;
    double lower = std::numeric_limits<double>::quiet_NaN();  ///< lower end of the band that was measured; NaN: none is known
    double upper = std::numeric_limits<double>::quiet_NaN();  ///< upper end
};

/// One comparison with what is known. Formulas know the names of measures.h, the scene's constants and those of `let`.
struct Check {
    std::string name;
    sim::Formula read;     ///< what is read as the scene runs
    sim::Formula against;  ///< what readings are ordered by; the time, unless given
    double from = -std::numeric_limits<double>::infinity(),
           to = std::numeric_limits<double>::infinity();  ///< end of `against`
    Statistic statistic = Statistic::Last;
    double level = 0.0;                       ///< level of Statistic::Reach
    std::string unit = {};                    ///< unit of what is read
    std::optional<sim::Formula> expect = {};  ///< expected value as a formula of the time
    std::vector<Known> table = {};            ///< measured, in its place
    std::optional<double> otherwise = {};     ///< what counts where a reading has no value
    std::optional<double> profileAt = {};     ///< time at which a profile is read, at the places of the table [s]; none: read all the time
    std::string outside = {};                 ///< why it is known to be outside of what was measured; empty: it is not
    std::optional<double> tolerance = {};     ///< relative to what is expected
    std::optional<double> within = {};        ///< absolute bound of the difference
    std::optional<double> atMost = {}, atLeast = {};

    /// Is what its readings are compared with known at each of them?
    bool hasCurve() const
    {
        using enum Statistic;
        return statistic == MeanError || statistic == LargestError || statistic == RmsError || statistic == RmsDifference || statistic == ShareInside;
    }
    /// Tells whether the table has a band around what was measured.
    bool hasBand() const { return !table.empty() && std::isfinite(table.front().lower); }
    /// Is it the time of its profile?
    bool isProfileTime(double time) const;
    /// NaN beyond the table, and where nothing is expected.
    Known knownAt(double time, double at) const;
};

/// What is found of one check.
struct Finding {
    double value = 0.0;
    double expected = std::numeric_limits<double>::quiet_NaN();  ///< NaN where there are bounds only
    bool passes = false;
};

/// Adds what is read of the simulation that `measures` looks at: one reading, but none outside from … to; of a profile one at each place of the
/// table, when it is time. Throws FormulaError where there is no value and the check says nothing else.
void readNow(const Check& check, double time, std::vector<Sample>& readings);

Finding judge(const Check& check, std::span<const Sample> readings);

/// "within 3 %", "at least 0.1, at most 1.2".
std::string bounds(const Check& check);

}  // namespace app
