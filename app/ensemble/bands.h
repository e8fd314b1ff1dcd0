#pragma once

#include "app/ensemble/ensemble.h"

#include <string>
#include <vector>

namespace app {

/// One column of a log over time, in all runs of an ensemble.
struct Band {
    std::string column;
    std::vector<Spread> at;  ///< spread of each time; counts 0 where no run has a value
};

/// A log over time.
struct Bands {
    std::string log;            ///< "energy" of energy.csv
    std::vector<double> times;  ///< [s]
    std::vector<Band> all;

    const Band* find(const std::string& column) const;
};

/// Bands at the times of the first run, as far as all have come; other runs are interpolated to them where their steps differ.
Bands bandsOf(const std::vector<Series>& log);

/// A table: the time, then of each column its mean, its standard deviation, and the lowest and the highest of all runs.
std::string bandsText(const Bands& bands);

/// Which column of that table has the mean, as gnuplot counts them, from 1; behind it stand deviation, lowest and highest.
std::size_t placeOfMean(const Bands& bands, const std::string& column);

}  // namespace app
