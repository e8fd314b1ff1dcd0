#include "app/probes/probes.h"
#include "app/readings/reading_context.h"
#include "sim/scene/read_list.h"

#include <fmt/format.h>

namespace app {

namespace {

using sim::Node;
using sim::Vec3;

constexpr const char* kProbesPath = "output.probes";
constexpr int kMostPoints = 10'000;

/// What a table and a plot can show in one cell of their heads.
std::string wordIn(const Node& map, const char* key, const std::string& path, const std::string& otherwise)
{
    const Node* node = map.find(key);
    const std::string text = node ? sim::readText(*node, sim::joinPath(path, key)) : otherwise;
    if (text.find_first_of(",\"\n[]") != std::string::npos)
        sim::fail(node->location, fmt::format("{}.{}: stands in the head of a CSV file: no commas, quotes and brackets", path, key));
    return text;
}

/// Points at equal distances along a straight line, its ends included.
std::vector<Vec3> pointsAlong(const Node& node, const std::string& path)
{
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    int count = 11;
    sim::SectionReader::read(&node, path, [&](auto& v) {
        v.required("from", "one end of the line, like from: [0, 0, 0]");
        v.vector("from", from, sim::Quantity::Length, "One end of the line");
        v.required("to", "the other end of the line, like to: [10, 0, 0]");
        v.vector("to", to, sim::Quantity::Length, "The other end of the line");
        v.integer("points", count, 2, kMostPoints, "So many points, the ends included");
    });
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) points.emplace_back(from + (to - from) * i / (count - 1.0));
    return points;
}

Probe probeIn(const Node& node, const std::string& path, std::size_t number, const ReadingContext& context)
{
    sim::SectionReader section(node, path);
    sim::SectionReader::read(&node, path, [](auto& v) {
        v.other("name", "What tables and plots call it");
        v.other("unit", "As tables and plots show it");
        v.required("read", "a formula of what is read as the scene runs, like read: liquid_y");
        v.formula("read", "What is read, as in validate");
        v.other("along", "Read at points along a line, x, y, z in the formula");
    });
    sim::FormulaNames names = context.reading;
    Probe probe{.name = wordIn(node, "name", path, fmt::format("probe {}", number)),
                .unit = wordIn(node, "unit", path, "-"),
                .read = sim::Formula("0"),
                .points = {}};
    if (const Node* along = node.find("along")) {
        probe.points = pointsAlong(*along, sim::joinPath(path, "along"));
        names.variables.insert(names.variables.end(), {"x", "y", "z"});
    }
    probe.read = readFormula(*node.find("read"), sim::joinPath(path, "read"), names);
    return probe;
}

}  // namespace

std::vector<std::string> Probes::columns() const
{
    std::vector<std::string> names = {"time_s"};
    for (const Probe& probe : all) {
        if (probe.points.empty()) names.push_back(fmt::format("{} [{}]", probe.name, probe.unit));
        for (const Vec3& x : probe.points)
            names.push_back(fmt::format("{} at {:.4g} cm [{}]", probe.name, (x - probe.points.front()).norm(), probe.unit));
    }
    return names;
}

std::optional<Probes> readProbes(const LoadedScene& setup)
{
    const Node* output = setup.file.root.find("output");
    const Node* node = output ? output->find("probes") : nullptr;
    if (!node) return std::nullopt;
    if (node->location.source && node->location.source->isSi)
        sim::fail(node->location, fmt::format("{}: formulas know centimetres only; write the file in units: cgs", kProbesPath));
    sim::SectionReader section(*node, kProbesPath);
    sim::SectionReader::read(node, kProbesPath, [](auto& v) {
        v.formula("every", "Time between readings; left out: that between frames [s]");
        describeContext(v);
        v.required("readings", "a list of what is read, like readings: [{name: height, unit: cm, read: liquid_y}]");
        v.other("readings", "What is read");
    });
    Probes probes{.every = setup.pictures.output.every, .all = {}, .measures = std::make_shared<Measures>(setup.scene, BeforeSteps::None)};
    const ReadingContext context = readContext(section, setup.scene, *probes.measures);
    if (node->find("every")) probes.every = readInterval(section, context);
    const std::string path = sim::joinPath(kProbesPath, "readings");
    const Node& readings = *sim::listAt(node, "readings", path, "[{name: height, unit: cm, read: liquid_y}]");
    if (readings.items.empty()) sim::fail(readings.location, path + ": needs a list of at least one");
    for (std::size_t i = 0; i < readings.items.size(); ++i)
        probes.all.push_back(probeIn(readings.items[i], fmt::format("{}.{}", path, i), i + 1, context));
    return probes;
}

}  // namespace app
