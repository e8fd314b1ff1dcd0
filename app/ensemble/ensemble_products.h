#pragma once

#include "app/ensemble/difference.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// Mean, deviation, range and the interval of the mean at 95 % confidence of each number of an ensemble that is not 0 in all runs (Markdown).
std::string ensembleTable(const Ensemble& ensemble);

/// ensemble.md, ensemble.csv, and of each log a table and a plot of its bands: energy_bands.csv, energy.png, probes_bands.csv, probes.png. Returns
/// the text of the first.
std::string writeEnsemble(const Ensemble& ensemble, const std::string& title, const std::filesystem::path& folder);

/// Ensembles side by side, each held against the first: compare.md, compare.csv and the same tables and plots of all of them. Returns the text of the
/// first.
std::string writeDifferences(const std::vector<Ensemble>& ensembles, const std::string& title, double confidence,
                             const std::filesystem::path& folder);

}  // namespace app
