#include "app/import/import_report.h"

#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <map>

namespace app {

namespace {

constexpr std::string_view kDead = "without effect in libWetCloth too";
constexpr std::string_view kOwnWay = "of its solvers and windows, which are others here";
constexpr std::string_view kMissing = "this version has nothing like it";
constexpr std::string_view kOld = "of 2018, not read by the present libWetCloth";
constexpr std::string_view kDefect = "where libWetCloth's choice is a defect and this program's stays";

constexpr std::size_t kMostNames = 100;  // of a line

struct KnownName {
    std::string_view name, why;
};

constexpr KnownName kKnown[] = {
    {"scene/simtype", kDead},
    {"scene/viewport", kDead},
    {"scene/collision", kDead},
    {"bucketinfo@kernelorder", kDead},
    {"integrator@useImplicitDensityProjection", kDead},
    {"liquidinfo/useLagrangianMPM", kDead},
    {"ElasticParameters/haircolor", kDead},
    {"ElasticParameters/straightHairs", kDead},
    {"ElasticParameters/postProjectFixed", kDead},
    {"ElasticParameters/useApproxJacobian", kDead},
    {"ElasticParameters/useTournierJacobian", kDead},
    {"integrator@criterion", kOwnWay},
    {"integrator@pressurecriterion", kOwnWay},
    {"integrator@viscouscriterion", kOwnWay},
    {"integrator@quasistaticcriterion", kOwnWay},
    {"integrator@manifoldsubsteps", kOwnWay},
    {"integrator@surftensionsubsteps", kOwnWay},
    {"liquidinfo/useBiCGSTAB", kOwnWay},
    {"liquidinfo/useAMGPCGSolid", kOwnWay},
    {"liquidinfo/usePCR", kOwnWay},
    {"liquidinfo/useCosolveAngular", kOwnWay},
    {"liquidinfo/useGroupPrecondition", kOwnWay},
    {"liquidinfo/checkDivergence", kOwnWay},
    {"liquidinfo/iterationPrintStep", kOwnWay},
    {"liquidinfo/implicitViscosity", kOwnWay},
    {"liquidinfo/airDensity", kMissing},
    {"liquidinfo/airViscosity", kMissing},
    {"scene/maxsimfreq", kOwnWay},
    {"camera@radius", kOwnWay},
    {"distancefield@cached", kOwnWay},
    {"distancefield@cachename", kOwnWay},
    {"distancefield@params", kOwnWay},
    {"liquidinfo/propagateSolidVelocity", kDefect},
    {"pose@path", kMissing},
    {"springforce@edge", kMissing},
    {"springforce@k", kMissing},
    {"springforce@l0", kMissing},
    {"springforce@b", kMissing},
    {"liquidinfo/halfThickness", kOld},
    {"liquidinfo/fabricThreadCount", kOld},
    {"liquidinfo/multiLevel", kOld},
    {"liquidinfo/applyViscositySolid", kOld},
    {"ElasticParameters/variableRadiusHair", kOld},
};

std::string_view reasonOf(std::string name)
{
    if (name.starts_with("StrandParameters")) name.replace(0, std::string_view("StrandParameters").size(), "ElasticParameters");
    for (const KnownName& known : kKnown)
        if (known.name == name) return known.why;
    return "not in the vocabulary of libWetCloth: perhaps misspelt";
}

/// Counts the names of an element and of all in it that were not asked for; what stands in an unknown element is left
/// out with it.
void countIgnored(const pugi::xml_node& node, const NamesRead& names, std::map<std::string, int>& counts)
{
    const std::string here = node.name();
    for (const pugi::xml_attribute& attribute : node.attributes()) {
        const std::string name = here + "@" + attribute.name();
        if (!names.contains(name)) ++counts[name];
    }
    for (const pugi::xml_node& child : node.children()) {
        if (child.type() != pugi::node_element) continue;
        const std::string name = here + "/" + child.name();
        if (names.contains(name)) countIgnored(child, names, counts);
        else ++counts[name];
    }
}

void addPart(std::string& text, const char* heading, const std::vector<std::string>& lines)
{
    if (lines.empty()) return;
    text += fmt::format("\n{}\n", heading);
    for (const std::string& line : lines) text += fmt::format("- {}\n", line);
}

}  // namespace

std::vector<std::string> ignoredNames(const XmlFile& file, const NamesRead& names)
{
    std::map<std::string, int> counts;
    countIgnored(file.root(), names, counts);
    std::map<std::string_view, std::vector<std::string>> byReason;
    for (const auto& [name, count] : counts) {
        const std::string shown = sim::inQuotes(name, 100);
        byReason[reasonOf(name)].push_back(shown.substr(1, shown.size() - 2) + (count > 1 ? fmt::format(" ({} times)", count) : ""));
    }
    std::vector<std::string> lines;
    for (const auto& [reason, all] : byReason) lines.push_back(fmt::format("{}: {}", reason, sim::listed(all, kMostNames)));
    return lines;
}

std::string reportText(const ImportReport& report, const std::string& from, const std::string& to)
{
    std::string text = fmt::format("Import of {} to {}\n", from, to);
    addPart(text, "Counts", report.counts);
    addPart(text, "Recognised", report.recognised);
    addPart(text, "Decisions", report.decisions);
    addPart(text, "Not in the scene", report.warnings);
    addPart(text, "Names that were not read", report.ignored);
    if (!report.readBack.empty()) addPart(text, "Read back", {report.readBack});
    return text;
}

}  // namespace app
