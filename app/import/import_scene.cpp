#include "app/import/import_scene.h"

#include "app/import/import_decisions.h"
#include "app/import/read_back.h"
#include "app/import/read_reference.h"
#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/scene/variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace app {

namespace fs = std::filesystem;

namespace {

/// Files that have their part names until all are written and found good; what is not kept is removed.
class NewFiles {
 public:
    NewFiles() = default;
    NewFiles(const NewFiles&) = delete;
    NewFiles& operator=(const NewFiles&) = delete;
    ~NewFiles()
    {
        std::error_code ignored;
        for (const fs::path& target : targets_) fs::remove(partFile(target), ignored);
    }
    void write(const fs::path& target, const std::string& text)
    {
        if (std::ranges::find(targets_, target) == targets_.end()) targets_.push_back(target);
        writeWhole(partFile(target), text);
    }
    void keepAll()
    {
        for (const fs::path& target : targets_) putInPlace(partFile(target), target);
        targets_.clear();
    }

 private:
    std::vector<fs::path> targets_;
};

fs::path fileOf(const ImportedPiece& piece, const fs::path& yaml)
{
    return yaml.parent_path() / fmt::format("{}_{}.obj", yaml.stem().string(), piece.name);
}

fs::path reportFile(fs::path yaml) { return yaml.replace_extension(".import.txt"); }

/// Motions of the groups that hold vertices; what turns about itself turns about the middle of these.
std::vector<std::pair<int, std::string>> pinMotions(const ImportedScene& scene, ImportReport& report)
{
    std::map<int, std::pair<sim::Vec3, int>> sums;
    for (const ImportedPiece& piece : scene.pieces) {
        for (const ImportedPin& pin : piece.pins) {
            for (const int v : pin.group < 0 ? std::vector<int>{} : pin.vertices) {
                auto& [sum, count] = sums.try_emplace(pin.group, sim::Vec3::Zero(), 0).first->second;
                sum += scene.reference.particles[piece.particles[v]].x;
                ++count;
            }
        }
    }
    std::vector<std::pair<int, std::string>> motions;
    for (const auto& [group, sum] : sums) {
        const std::string text = motionText(scene.reference, group, sum.first / sum.second, report);
        if (!text.empty()) motions.emplace_back(group, text);
    }
    return motions;
}

void reportIdleScripts(const ImportedScene& scene, ImportReport& report)
{
    std::set<int> moved;
    for (const auto& [group, text] : scene.motions) moved.insert(group);
    for (const reference::Field& f : scene.reference.fields)
        if (!f.isPart) moved.insert(f.group);
    for (const reference::Script& s : scene.reference.scripts)
        if (!moved.contains(s.group))
            report.decisions.push_back(
                fmt::format("the script of line {} moves group {}, in which nothing is held and no body stands: left out", s.line, s.group));
}

/// "scene.yaml.part:14: what" as a complaint about the line of the XML that line 14 comes from.
[[noreturn]] void failAtXml(const std::string& message, const fs::path& part, const XmlFile& xml, const SceneLines& lines)
{
    const std::string head = part.string() + ":";
    if (!message.starts_with(head)) throw sim::InputError(fmt::format("{}: {}", xml.path().string(), message));
    int line = 0;
    const char* end = message.data() + message.size();
    const auto [rest, problem] = std::from_chars(message.data() + head.size(), end, line);
    xml.fail(problem == std::errc() ? lines.xmlLine(line) : 1, fmt::format("makes no scene{}", std::string(rest, end)));
}

std::string readBack(const ImportedScene& scene, const fs::path& part, const XmlFile& xml, const SceneLines& lines, const Backends& backends)
{
    if (!scene.bodies.missingFiles.empty()) return "not done, as a mesh is missing; drench check does it when it is there";
    try {
        return compareWithReference(backends.loadScene({part.string(), "", {}}).scene, scene);
    } catch (const sim::InputError& error) {
        failAtXml(error.what(), part, xml, lines);
    }
}

ImportedScene importAll(const XmlFile& file, const fs::path& yaml, const ImportOptions& options, ImportReport& report)
{
    NamesRead names;
    ImportedScene scene;
    scene.from = file.path().filename().string();
    scene.name = sim::asName(yaml.stem().string());
    scene.report = reportFile(yaml).filename().string();
    scene.reference = readReferenceScene(file, options, names);
    scene.vertexSolver = options.vertexSolver;
    scene.method = chosenMethod(scene.reference.run, options).name;
    scene.pieces = importFabrics(scene.reference, report);
    scene.bodies = importBodies(scene.reference, file.path(), yaml, report);
    scene.motions = pinMotions(scene, report);
    reportIdleScripts(scene, report);
    reportCounts(scene, report);
    reportDecisions(scene, options, report);
    report.ignored = ignoredNames(file, names);
    return scene;
}

}  // namespace

std::string importScene(const fs::path& xml, const fs::path& yaml, const ImportOptions& options, const Backends& backends)
{
    if (!yaml.parent_path().empty() && !fs::is_directory(yaml.parent_path()))
        throw sim::InputError(fmt::format("-o: there is no folder {}; make it, or write elsewhere", yaml.parent_path().string()));
    std::error_code ignored;
    if (fs::equivalent(xml, yaml, ignored)) throw sim::InputError(fmt::format("-o: {} is the file to be read; write to another one", yaml.string()));
    const XmlFile file(xml);
    ImportReport report;
    const ImportedScene scene = importAll(file, yaml, options, report);
    NewFiles files;
    for (const ImportedPiece& piece : scene.pieces)
        if (piece.hasFile()) files.write(fileOf(piece, yaml), objText(piece.shape.geometry));
    const auto partName = [&](const ImportedPiece& piece) { return partFile(fileOf(piece, yaml)).filename().string(); };
    const SceneLines asParts = writeScene(scene, partName);
    files.write(yaml, asParts.text());
    report.readBack = readBack(scene, partFile(yaml), file, asParts, backends);

    const std::string text = reportText(report, xml.string(), yaml.string());
    files.write(reportFile(yaml), text);
    files.write(yaml, writeScene(scene, [&](const ImportedPiece& piece) { return fileOf(piece, yaml).filename().string(); }).text());
    files.keepAll();
    return text;
}

}  // namespace app
