#include "app/readings/reading_context.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <vector>

namespace app {

namespace {

using sim::Node;

void define(const std::string& name, double value, ReadingContext& context)
{
    for (sim::FormulaNames* names : {&context.reading, &context.known, &context.constant}) names->constants[name] = value;
}

/// What formulas know of the scene.
ReadingContext contextOf(const std::string& path, const sim::Scene& scene)
{
    ReadingContext context;
    context.path = path;
    context.reading.variables = context.known.variables = {"t"};
    const sim::Settings& s = scene.settings;
    define("g", s.gravity.norm(), context);
    define("density", s.liquid.density, context);
    define("viscosity", s.liquid.viscosity, context);
    define("surface_tension", s.liquid.surfaceTension, context);
    define("dx", s.cell, context);
    define("duration", s.time.duration, context);
    return context;
}

void readConstants(const Node* let, ReadingContext& context)
{
    if (!let) return;
    const std::string path = context.path + ".let";
    if (!let->isMap()) sim::fail(let->location, path + ": needs names and formulas, like {k: pi/10}, not " + let->called());
    for (std::size_t i = 0; i < let->keys.size(); ++i) define(let->keys[i], readConstant(let->items[i], path + "." + let->keys[i], context), context);
}

void readFlow(const Node* node, const ReadingContext& context, Measures& measures)
{
    if (!node) return;
    const std::string path = context.path + ".flow";
    sim::FormulaNames names = context.constant;
    names.variables = {"x", "y", "z", "t"};
    if (!node->isList() || node->items.size() != sim::kAxes)
        sim::fail(node->location, path + ": needs three formulas of x, y, z, t like [\"-y\", \"x\", \"0\"]");
    const auto at = [&](std::size_t i) { return readFormula(node->items[i], path, names); };
    measures.setFlow({at(0), at(1), at(2)});
}

/// The motion of an obstacle, by its name.
sim::Motion motionOf(const std::string& name, const sim::Scene& scene, const Node& node, const std::string& path)
{
    std::vector<std::string> names;
    for (const sim::ObstacleSettings& obstacle : scene.obstacles) {
        if (obstacle.name == name) return obstacle.motion;
        names.push_back(obstacle.name);
    }
    sim::fail(node.location, fmt::format("{}.moves_with: there is no obstacle \"{}\": there are {}", path, name,
                                         names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

ControlSurface controlSurfaceIn(const Node& node, const std::string& path, const sim::Scene& scene)
{
    ControlSurface surface;
    std::string obstacle;
    sim::SectionReader::read(&node, path, [&](auto& v) {
        v.required("center", "a point in its plane, like center: [0, 2, 0]");
        v.vector("center", surface.center, sim::Quantity::Length, "A point of the plane, the middle of the disc");
        v.required("normal", "the direction through it that counts as positive, like normal: [0, -1, 0]");
        v.vector("normal", surface.normal, sim::Quantity::None, "Direction through it that counts as positive");
        v.numberOr("radius", surface.radius, std::numeric_limits<double>::infinity(), sim::Quantity::Length, sim::Range::above(0.0),
                   "Of a disc; left out: the whole plane");
        v.text("moves_with", obstacle, "Name of the obstacle whose motion it has; left out: it rests");
        v.require(surface.normal.norm() > 0.0, "normal", "must be a direction, like [0, -1, 0]");
    });
    surface.normal.normalize();
    if (!obstacle.empty()) surface.motion = motionOf(obstacle, scene, node, path);
    return surface;
}

void readControlSurfaces(const Node* node, const std::string& section, const sim::Scene& scene, Measures& measures)
{
    if (!node) return;
    const std::string path = section + ".control_surfaces";
    if (!node->isMap())
        sim::fail(node->location, path + ": needs names and surfaces, like {outlet: {center: [0, 2, 0], normal: [0, -1, 0]}}, not " + node->called());
    for (std::size_t i = 0; i < node->keys.size(); ++i)
        measures.addControlSurface(node->keys[i], controlSurfaceIn(node->items[i], sim::joinPath(path, node->keys[i]), scene));
}

}  // namespace

sim::Formula readFormula(const Node& node, const std::string& path, const sim::FormulaNames& names)
{
    const std::string& text = sim::readText(node, path);
    try {
        return sim::Formula(text, names);
    } catch (const sim::FormulaError& error) {
        sim::fail(node.location, fmt::format("{}: {}: {}", path, sim::inQuotes(text), error.what()));
    }
}

double readConstant(const Node& node, const std::string& path, const ReadingContext& context)
{
    const sim::Formula formula = readFormula(node, path, context.constant);
    try {
        return formula();
    } catch (const sim::FormulaError& error) {
        sim::fail(node.location, fmt::format("{}: {}: {}", path, sim::inQuotes(formula.text()), error.what()));
    }
}

ReadingContext readContext(const sim::SectionReader& section, const sim::Scene& scene, Measures& measures)
{
    ReadingContext context = contextOf(section.path(), scene);
    readConstants(section.find("let"), context);
    readFlow(section.find("flow"), context, measures);
    readControlSurfaces(section.find("control_surfaces"), context.path, scene, measures);
    context.reading.functions = measures.names();
    context.reading.ofNames = measures.forces();
    context.reading.ofNames.push_back(measures.flux());
    context.reading.ofNames.push_back(measures.pressures());
    for (sim::FormulaNames::OfName& shadow : measures.shadows()) context.reading.ofNames.push_back(std::move(shadow));
    return context;
}

double readInterval(sim::SectionReader& section, const ReadingContext& context)
{
    section.required("every", "the time between two readings, like every: 1.0e-2");
    const double every = readConstant(*section.find("every"), section.pathOf("every"), context);
    if (every <= 0.0) sim::fail(section.locationOf("every"), section.pathOf("every") + ": must be above 0 s");
    return every;
}

}  // namespace app
