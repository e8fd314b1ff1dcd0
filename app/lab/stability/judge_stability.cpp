#include "app/lab/stability/stability_map.h"

#include "app/lab/endings/run_course.h"
#include "app/lab/endings/run_outcome.h"
#include "app/system/atomic_files.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

std::string withoutCommas(std::string text)
{
    std::ranges::replace(text, ',', ';');
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string whyUnstable(const StabilityRow& row, const RunCourse& course)
{
    constexpr double kLongEnough = 0.95;  // on the mean: where liquid leaves fabric, what is left is divided into pairs of steps again
    if (course.time < kLongEnough * row.dt * course.steps) return fmt::format("cut: steps of {:.3g} s", course.time / course.steps);
    return whyUnsound(course);
}

}  // namespace

StabilityRow judgeStability(const ProcessEnd& end, const std::filesystem::path& folder, StabilityRow row)
{
    constexpr int kNoPictures = 0;
    const RunVerdict outcome = judgeEnd(end, folder, kNoPictures);
    const RunCourse course = courseOf(folder);
    row.seconds = outcome.seconds;
    row.energyGain = course.energyGain;
    row.why = withoutCommas(outcome.message);
    if (outcome.ending == RunOutcome::NotFinite) {
        row.why = "not finite: " + row.why;
    } else {
        row.largestSpeed = course.largestSpeed;
        if (outcome.ending == RunOutcome::Finished) row.why = withoutCommas(whyUnstable(row, course));
        else row.why = fmt::format("{}: {}", kRunOutcomes[static_cast<int>(outcome.ending)], row.why);
    }
    row.isStable = outcome.ending == RunOutcome::Finished && row.why.empty();
    return row;
}

}  // namespace app
