#pragma once

#include "app/diff/finding.h"
#include "app/diff/picture_diff.h"
#include "app/options.h"
#include "app/scene/tolerance.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace app {

/// What two results have been found to be.
struct DiffResult {
    DiffOptions of;
    Tolerance tolerance;
    std::vector<DiffFinding> findings;   ///< findings of states, series and reports
    std::vector<PictureDiff> pictures;   ///< the worst first
    std::shared_ptr<const void> frames;  ///< keeps pictures that were taken out of videos

    bool differs() const;
    /// "same: 12 pictures", or "different: " with what differs most, and where.
    std::string verdict() const;
};

/// Two pictures, folders of pictures, videos, runs, series (.csv, .jsonl), reports (.json) or states (.h5); or a folder of
/// pictures and a run.
/// @param sets  tolerances "key=value", over those of the file
/// Throws InputError where they cannot be compared.
DiffResult diffResults(const DiffOptions& options, const std::vector<std::string>& sets, const std::function<bool()>& stopWanted);

}  // namespace app
