#include "app/import/read_reference.h"

#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace app {

using namespace reference;

namespace {

void requireFew(const XmlElement& element, std::size_t before)
{
    constexpr std::size_t kMost = 10'000;
    if (before >= kMost) element.fail(fmt::format("more than {} elements like this one; no scene has so many, remove some", kMost));
}

Field::Usage readUsage(const XmlElement& element)
{
    static const std::map<std::string, Field::Usage> kAll = {
        {"solid", Field::Usage::Solid}, {"source", Field::Usage::Source}, {"terminator", Field::Usage::Terminator}};
    const std::string word = element.text("usage", "solid");
    const auto found = kAll.find(word);
    if (found == kAll.end()) element.fail(fmt::format("distancefield@usage: {} is unknown; there is solid, source, terminator", sim::inQuotes(word)));
    return found->second;
}

Field::Type readType(const XmlElement& element)
{
    using T = Field::Type;
    static const std::map<std::string, T> kAll = {{"sphere", T::Sphere}, {"box", T::Box},     {"capsule", T::Capsule},    {"cylinder", T::Cylinder},
                                                  {"file", T::File},     {"union", T::Union}, {"intersect", T::Intersect}};
    const std::string word = element.text("type");
    const auto found = kAll.find(word);
    if (found == kAll.end())
        element.fail(
            fmt::format("distancefield@type: {} is unknown; there is sphere, box, capsule, cylinder, file, union, intersect", sim::inQuotes(word)));
    return found->second;
}

void readPlace(const XmlElement& element, Field& field)
{
    for (const char* coordinate : {"cx", "cy", "cz"})
        if (!element.has(coordinate))
            element.fail(fmt::format("distancefield@{} is missing, and libWetCloth has no default; write the centre", coordinate));
    field.center = Vec3(element.number("cx"), element.number("cy"), element.number("cz"));
    const Vec3 axis(element.number("rx", 0.0), element.number("ry", 1.0), element.number("rz", 0.0));
    field.angle = element.number("rw", 0.0);
    if (field.angle != 0.0 && !(axis.norm() > 0.0)) element.fail("rx, ry, rz must be a direction to turn about by rw, like 0 1 0");
    if (axis.norm() > 0.0) field.axis = axis.normalized();
    field.inside = element.flag("inside", false);
}

void requireSize(const XmlElement& element, const char* attribute, double size)
{
    if (!(size > 0.0)) element.fail(fmt::format("distancefield@{} must be above 0 here; write a length in cm", attribute));
}

void readBody(const XmlElement& element, Field& field)
{
    using T = Field::Type;
    readPlace(element, field);
    if (field.type == T::File) {
        field.file = element.text("filename");
        field.scale = element.number("scale", 0.0);
        field.dx = element.number("dx", 0.0);
        if (field.file.empty()) element.fail("distancefield@filename is missing; it is an OBJ file");
        requireSize(element, "scale", field.scale);
        return;
    }
    field.radius = element.number("radius", 0.0);
    if (field.type == T::Box) {
        field.half = Vec3(element.number("ex", 0.0), element.number("ey", 0.0), element.number("ez", 0.0));
        if (!(field.half.minCoeff() + field.radius > 0.0 && field.half.minCoeff() >= 0.0 && field.radius >= 0.0))
            element.fail("a box needs ex, ey, ez and radius of 0 or more, and not all 0; write lengths in cm");
        return;
    }
    requireSize(element, "radius", field.radius);
    if (field.type == T::Sphere) return;
    field.halfLength = element.number("halflength", 0.0);
    if (field.type == T::Capsule) return;
    field.corner = element.number("corner", 0.0);
    requireSize(element, "halflength", field.halfLength);
}

std::vector<Emission> readEmissions(const XmlElement& element)
{
    std::vector<Emission> all;
    const Vec3 velocity(element.number("vx", 0.0), element.number("vy", 0.0), element.number("vz", 0.0));
    for (const XmlElement& span : element.children("duration")) {
        Emission e{span.number("start", 0.0), span.number("end", 0.0), span.number("maxvol", std::numeric_limits<double>::infinity()),
                   Vec3(span.number("vx", 0.0), span.number("vy", 0.0), span.number("vz", 0.0))};
        if (e.end < e.start) span.fail(fmt::format("duration ends at {} s, before it starts at {} s; exchange them", e.end, e.start));
        all.push_back(e);
    }
    if (all.empty()) all.push_back({.velocity = velocity});
    return all;
}

/// Marks the parts of a union or intersection, which are no bodies of their own any more.
void takeParts(const XmlElement& element, Field& field, std::vector<Field>& earlier)
{
    field.parts = element.integers("i");
    if (field.parts.empty()) element.fail("distancefield@i is missing; it lists the fields that are put together, like i=\"0 1\"");
    for (const int part : field.parts) {
        if (part < 0 || part >= static_cast<int>(earlier.size()))
            element.fail(fmt::format("distancefield@i: there is no earlier field {}; they are counted from 0, and {} stand before this one", part,
                                     earlier.size()));
        if (earlier[part].isPart) element.fail(fmt::format("distancefield@i: field {} is part of another one already; write it once more", part));
        earlier[part].isPart = true;
    }
}

Script readScript(const XmlElement& element)
{
    Script script;
    script.line = element.line();
    const std::string type = element.text("type");
    if (type != "translate" && type != "rotate")
        element.fail(fmt::format("script@type: {} is unknown; there is translate and rotate", sim::inQuotes(type)));
    script.rotates = type == "rotate";
    script.course = element.text("func", "cubic");
    if (script.course != "cubic" && script.course != "cosine" && script.course != "weno")
        element.fail(fmt::format("script@func: {} is unknown; there is cubic, cosine, weno", sim::inQuotes(script.course)));
    script.group = element.integer("group", 0);
    script.start = element.number("start");
    script.end = element.number("end");
    if (!(script.end > script.start))
        element.fail(fmt::format("script ends at {} s, not after it starts at {} s; correct start or end", script.end, script.start));
    const double third = (script.end - script.start) / 3.0;
    script.easeStart = element.number("easestart", third);
    script.easeEnd = element.number("easeend", third);
    script.direction = Vec3(element.number("x", 0.0), element.number("y", 0.0), element.number("z", 0.0));
    script.angle = element.number("w", 0.0);
    if (element.has("ox") || element.has("oy") || element.has("oz"))
        script.origin = Vec3(element.number("ox", 0.0), element.number("oy", 0.0), element.number("oz", 0.0));
    script.isGlobal = element.flag("global", false);
    script.amplitude = element.number("amplitude", script.amplitude);
    script.frequency = element.number("frequency", script.frequency);
    if (script.course == "weno") {
        script.base = element.numbers("base");
        script.baseStep = element.number("dt", script.baseStep);
        if (script.base.size() < 2 || !(script.baseStep > 0.0))
            element.fail("script of weno needs base, two or more places, and dt above 0, the time between them");
    }
    return script;
}

}  // namespace

std::vector<Field> readReferenceFields(const XmlElement& scene)
{
    std::vector<Field> all;
    for (const XmlElement& element : scene.children("distancefield")) {
        requireFew(element, all.size());
        Field field;
        field.line = element.line();
        field.usage = readUsage(element);
        field.type = readType(element);
        field.group = element.integer("group", 0);
        field.sampled = element.flag("sampled", true);
        if (field.type == Field::Type::Union || field.type == Field::Type::Intersect) takeParts(element, field, all);
        else readBody(element, field);
        if (field.usage == Field::Usage::Source) field.emissions = readEmissions(element);
        all.push_back(std::move(field));
    }
    return all;
}

std::vector<Script> readReferenceScripts(const XmlElement& scene)
{
    std::vector<Script> all;
    for (const XmlElement& element : scene.children("script")) {
        requireFew(element, all.size());
        all.push_back(readScript(element));
    }
    return all;
}

}  // namespace app
