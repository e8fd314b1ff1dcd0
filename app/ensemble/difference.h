#pragma once

#include "app/ensemble/ensemble.h"

#include <string>
#include <vector>

namespace app {

/// One number of two ensembles.
struct ColumnDifference {
    std::string name;
    Spread a, b;
    MeanDifference found;  ///< difference of b against a

    /// How far beyond its margin a difference is; above 1 it is seen.
    double clearness() const;
};

/// Two ensembles.
struct EnsembleDifference {
    std::string a, b;                         ///< labels
    double confidence = 0.99;                 ///< confidence with which all intervals together hold
    std::vector<ColumnDifference> judged;     ///< differences that are judged, each with 1 − (1 − confidence) / count, after Bonferroni
    std::vector<ColumnDifference> ofMachine;  ///< seconds and memory, which depend on what else the machine does: each at `confidence`, not judged
    std::vector<std::string> constant;        ///< what is the same in all runs of both, or in both runs of each pair, beside what is 0
    std::size_t runsA = 0, runsB = 0;
    bool isPaired = false;  ///< runs with one draw are held against each other

    std::size_t seen() const;  ///< how many of the judged differ
};

/// How b differs from a. Where runs of both have one distribution a difference is seen in any of the numbers with a probability of
/// 1 − confidence at most. Where all runs of the smaller ensemble have the draws of runs of the other, pairs are compared.
EnsembleDifference differenceOf(const Ensemble& a, const Ensemble& b, double confidence);

/// How b differs from a, of numbers that are there.
/// @param isPaired  values of one number belong together
EnsembleDifference differenceOf(const std::vector<EnsembleColumn>& a, const std::vector<EnsembleColumn>& b, double confidence, bool isPaired = false);

/// "No difference seen between A and B in 24 numbers, …", or in how many they differ, and most clearly in what.
std::string sentenceOf(const EnsembleDifference& difference);

/// Both means with their deviations, and the difference with its interval (Markdown).
std::string differenceTable(const EnsembleDifference& difference);

/// The table's numbers as CSV, without a head; and that head.
std::string differenceRows(const EnsembleDifference& difference);
std::string differenceHeader();

}  // namespace app
