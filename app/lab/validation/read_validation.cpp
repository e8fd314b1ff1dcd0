#include "app/lab/checks/read_check.h"
#include "app/lab/validation/validation.h"
#include "sim/scene/overrides.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

namespace {

using sim::Node;

/// What is missing for the check to be able to fail.
void requireVerdict(const Check& check, const Node& node, const std::string& path)
{
    const bool expects = check.expect || !check.table.empty(), hasTolerance = check.tolerance || check.within,
               hasBound = check.atMost || check.atLeast;
    if (check.hasCurve() && (!expects || !hasBound)) sim::fail(node.location, path + ": an error needs expect or table, and at_most");
    if (check.statistic == Statistic::ShareInside && !check.hasBand())
        sim::fail(node.location, path + ": share_inside needs a table with a band, like [[0, 1, 0.9, 1.1], [0.5, 1.2, 1.1, 1.4]]");
    if (check.hasCurve()) return;
    if (!check.table.empty())
        sim::fail(node.location, path + ": a table is compared by take: mean_error, largest_error, rms_error, rms_difference or share_inside");
    if (check.expect && !hasTolerance) sim::fail(node.location, path + ": expect needs tolerance (relative) or within (absolute)");
    if (!expects && !hasBound) sim::fail(node.location, path + ": needs expect with a tolerance, at_most, or at_least");
}

/// Profiles are read at times of readings.
void requireReading(const Check& check, const sim::TimeSettings& time, double every, const Node& node, const std::string& path)
{
    if (!check.profileAt) return;
    const double nearest = time.start + every * std::round((*check.profileAt - time.start) / every);
    if (*check.profileAt < time.start || *check.profileAt > time.start + time.duration || !check.isProfileTime(nearest))
        sim::fail(node.location, fmt::format("{}.at: nothing is read at {:g} s: needs a multiple of every, {:g} s, to the end of the run, {:g} s",
                                             path, *check.profileAt, every, time.start + time.duration));
}

Check checkIn(const Node& node, std::size_t index, KnownFrom kind, const ReadingContext& context)
{
    const std::string path = fmt::format("validate.checks.{}", index);
    Check check = readCheck(node, path, context, fmt::format("check {}", index + 1));
    requireVerdict(check, node, path);
    if (!check.outside.empty() && kind != KnownFrom::Measured)
        sim::fail(node.location, path + ".outside: is for what was measured: validate needs kind: measured, or the check another tolerance");
    return check;
}

}  // namespace

std::optional<Validation> readValidation(const LoadedScene& setup)
{
    const Node* node = setup.file.root.find("validate");
    if (!node) return std::nullopt;
    Validation validation;
    sim::SectionReader::read(node, "validate", [&](auto& v) {
        v.text("about", validation.about, "What is compared with what, as the report says it");
        v.text("source", validation.source, "Who found what is expected");
        v.choice("kind", validation.kind, "Where it is known from: theory, or measured in an experiment");
        v.formula("every", "Time between two readings [s], above 0");
        describeContext(v);
        v.other("quick", "What drench validate --quick changes, so that the run is short");
        v.other("checks", "What is compared");
    });
    sim::SectionReader section(*node, "validate");
    validation.measures = std::make_shared<Measures>(setup.scene);
    const ReadingContext context = readContext(section, setup.scene, *validation.measures);
    validation.every = readInterval(section, context);
    if (const Node* quick = section.find("quick")) {
        if (!quick->isMap())
            sim::fail(quick->location, fmt::format("validate.quick: needs a map like {{time.duration: 0.4}}, not {}", quick->called()));
        for (const sim::Override& change : sim::overridesOf(*quick, {})) validation.quick.push_back(change.text());
    }
    section.required("checks", "a list of what is compared, like checks: [{read: liquid_y, expect: 1, tolerance: 0.01}]");
    const Node& checks = *section.find("checks");
    if (!checks.isList() || checks.items.empty()) sim::fail(checks.location, "validate.checks: needs a list of at least one check");
    for (std::size_t i = 0; i < checks.items.size(); ++i) {
        validation.checks.push_back(checkIn(checks.items[i], i, validation.kind, context));
        requireReading(validation.checks.back(), setup.scene.settings.time, validation.every, checks.items[i], fmt::format("validate.checks.{}", i));
    }
    return validation;
}

}  // namespace app
