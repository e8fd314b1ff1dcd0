#include "app/scene/read_picture_settings.h"

#include "app/scene/describe_picture.h"
#include "sim/scene/section_reader.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

using sim::Node;

std::vector<Variant> variantsOf(const sim::SceneFile& file)
{
    std::vector<Variant> variants;
    for (const sim::SceneVariant& v : file.variants) {
        Variant& out = variants.emplace_back(Variant{v.name, v.label, {}});
        for (const sim::Override& change : v.overrides) out.overrides.push_back(change.text());
    }
    return variants;
}

void checkReference(const Node& root, const CompareSettings& compare)
{
    std::vector<std::string> labels;
    for (const Variant& v : compare.variants) labels.push_back(v.label);
    if (compare.reference.empty() || std::find(labels.begin(), labels.end(), compare.reference) != labels.end()) return;
    sim::fail(root.find("compare")->find("reference")->location,
              fmt::format("compare.reference: {} is the label of no variant{}", sim::inQuotes(compare.reference),
                          sim::suggestion(compare.reference, labels)));
}

void checkEnergyPlot(const Node& root, const PictureSettings& settings)
{
    if (settings.compare.variants.empty() || !settings.compare.energyPlot || settings.output.energy) return;
    sim::fail(root.find("output")->find("data")->location,
              "output.data: has no energy, which compare.products: energy_plot draws; add energy, or take energy_plot out");
}

void writeVariants(sim::SectionWriter& w, const std::vector<Variant>& variants)
{
    if (variants.empty()) return;
    w.line("variants", "", "The runs to compare");
    for (const Variant& v : variants) {
        std::string text = "{name: " + Node::scalar(v.name, {}).flow() + ", label: " + Node::scalar(v.label, {}).flow();
        for (const std::string& change : v.overrides) {
            const std::size_t equals = change.find('=');
            text += ", " + Node::scalar(change.substr(0, equals), {}).flow() + ": " + change.substr(equals + 1);
        }
        w.item(text + "}");
    }
}

}  // namespace

PictureSettings readPictureSettings(const sim::SceneFile& file)
{
    PictureSettings settings;
    const Node& root = file.root;
    sim::SectionReader::read(root.find("render"), "render", [&](auto& v) { visitFields(v, settings.render); });
    sim::SectionReader::read(root.find("output"), "output", [&](auto& v) { visitFields(v, settings.output); });
    sim::SectionReader::read(root.find("compare"), "compare", [&](auto& v) { visitFields(v, settings.compare); });
    if (const Node* output = root.find("output"))
        if (const Node* probes = output->find("probes")) settings.output.probes = probes->flow();
    settings.compare.variants = variantsOf(file);
    // A scene that does not say what is made of its runs asks for no plot of what they do not keep.
    if (!root.find("compare") || !root.find("compare")->find("products")) settings.compare.energyPlot = settings.output.energy;
    checkReference(root, settings.compare);
    checkEnergyPlot(root, settings);
    return settings;
}

std::string printPictureSettings(const PictureSettings& settings)
{
    PictureSettings copy = settings;
    sim::SectionWriter w;
    w.section("render", copy.render, "");
    w.below("output", "", [&](sim::SectionWriter& inner) {
        visitFields(inner, copy.output);
        if (!copy.output.probes.empty()) inner.line("probes", copy.output.probes, "What is read as the run goes, into probes.csv");
    });
    w.below("compare", "", [&](sim::SectionWriter& inner) {
        visitFields(inner, copy.compare);
        writeVariants(inner, copy.compare.variants);
    });
    return w.take();
}

SceneContents contentsOf(const sim::Scene& scene)
{
    SceneContents contents;
    for (const sim::FabricPiece& piece : scene.fabrics) {
        contents.yarns = contents.yarns || !piece.strands.empty();
        contents.cloth = contents.cloth || !piece.faces.empty();
    }
    contents.liquid = !scene.sources.empty() || !contents.fabric();
    contents.obstacles = !scene.obstacles.empty();
    contents.rooms = std::ranges::any_of(scene.obstacles, &sim::ObstacleSettings::inside);
    return contents;
}

}  // namespace app
