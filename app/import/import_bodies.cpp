#include "app/import/imported_bodies.h"
#include "app/import/imported_fabric.h"
#include "app/import/lattice_fit.h"
#include "app/import/recognise.h"
#include "sim/scene/node.h"
#include "sim/scene/units.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>

namespace app {

using reference::Field;
using sim::formatPlain;

namespace {

/// Fields as shapes of scenes.
class Shapes {
 public:
    Shapes(const std::vector<Field>& fields, std::filesystem::path xml, std::filesystem::path yaml)
        : fields_(fields), xml_(std::move(xml)), yaml_(std::move(yaml))
    {
    }

    /// The body itself, without regard to `inside` of the outermost.
    std::string body(const Field& f)
    {
        switch (f.type) {
            case Field::Type::Sphere: return fmt::format("{{ball: {{center: {}, radius: {}}}}}", yamlList(f.center), formatPlain(f.radius));
            case Field::Type::Box: return box(f);
            case Field::Type::Capsule: return capsule(f);
            case Field::Type::Cylinder: return cylinder(f);
            case Field::Type::File: return mesh(f);
            case Field::Type::Union: return fmt::format("{{union: [{}]}}", parts(f));
            case Field::Type::Intersect: return fmt::format("{{intersect: [{}]}}", parts(f));
        }
        return "";
    }
    /// What is inside, with `inside` taken for the outside of the body.
    std::string region(const Field& f) { return f.inside ? fmt::format("{{invert: {}}}", body(f)) : body(f); }

    std::vector<std::filesystem::path> missing;

 private:
    static sim::Vec3 turned(const Field& f, const sim::Vec3& direction) { return Eigen::AngleAxisd(f.angle, f.axis) * direction; }
    static std::string turn(const Field& f)
    {
        if (f.angle == 0.0) return "";
        return fmt::format(", rotate: {{axis: {}, angle: {}}}", yamlList(f.axis), sim::formatNumber(f.angle, sim::Quantity::Angle));
    }

    static std::string box(const Field& f)
    {
        const std::string size = fmt::format("center: {}, half: {}", yamlList(f.center), yamlList(f.half));
        if (f.radius == 0.0) return fmt::format("{{box: {{{}}}{}}}", size, turn(f));
        return fmt::format("{{rounded_box: {{{}, round: {}}}{}}}", size, formatPlain(f.radius), turn(f));
    }
    static std::string capsule(const Field& f)
    {
        const sim::Vec3 half = turned(f, f.halfLength * sim::Vec3::UnitX());
        return fmt::format("{{capsule: {{a: {}, b: {}, radius: {}}}}}", yamlList(shortest(sim::Vec3(f.center - half))),
                           yamlList(shortest(sim::Vec3(f.center + half))), formatPlain(f.radius));
    }
    static std::string cylinder(const Field& f)
    {
        return fmt::format("{{cylinder: {{center: {}, axis: {}, radius: {}, half: {}, round: {}}}}}", yamlList(f.center),
                           yamlList(shortest(turned(f, sim::Vec3::UnitY()))), formatPlain(f.radius), formatPlain(f.halfLength),
                           formatPlain(f.corner));
    }
    std::string mesh(const Field& f)
    {
        const std::string cell = f.dx > 0.0 ? fmt::format(", cell: {}", formatPlain(f.dx)) : "";
        return fmt::format("{{mesh: {{file: {}, scale: {}{}}}{}, translate: {}}}", sim::Node::scalar(located(f.file), {}).flow(),
                           formatPlain(f.scale), cell, turn(f), yamlList(f.center));
    }
    std::string parts(const Field& f)
    {
        std::string all;
        for (const int part : f.parts) all += (all.empty() ? "" : ", ") + region(fields_[part]);
        return all;
    }

    /// libWetCloth's meshes are relative to where it is started, some folder above the scene; ours are relative to the
    /// scene.
    std::string located(const std::string& file)
    {
        namespace fs = std::filesystem;
        std::error_code ignored;
        const fs::path beside = fs::absolute(yaml_, ignored).parent_path();
        fs::path folder = fs::absolute(xml_, ignored).parent_path();
        for (;; folder = folder.parent_path()) {
            if (fs::is_regular_file(folder / file, ignored)) return fs::relative(folder / file, beside, ignored).string();
            if (folder == folder.root_path() || folder.empty()) break;
        }
        missing.push_back(beside / file);
        return file;
    }

    const std::vector<Field>& fields_;
    std::filesystem::path xml_, yaml_;
};

const char* wordOf(const Field& f)
{
    constexpr const char* kWords[] = {"ball", "box", "capsule", "cylinder", "mesh", "union", "overlap"};
    return f.inside ? "tank" : kWords[static_cast<int>(f.type)];
}

std::string listed(const std::vector<std::string>& shapes) { return fmt::format("[{}]", fmt::join(shapes, ", ")); }

/// Sources of one group that give liquid at the same times are one.
void importSources(const reference::Scene& scene, Shapes& shapes, ImportedBodies& out, ImportReport& report)
{
    std::vector<char> isDone(scene.fields.size(), 0);
    for (std::size_t i = 0; i < scene.fields.size(); ++i) {
        const Field& first = scene.fields[i];
        if (isDone[i] || first.isPart || first.usage != Field::Usage::Source) continue;
        if (!first.sampled) {
            report.decisions.push_back(fmt::format("the source of line {} has sampled=0, so it never gives liquid, and is left out", first.line));
            continue;
        }
        std::vector<std::string> together;
        for (std::size_t k = i; k < scene.fields.size(); ++k) {
            const Field& f = scene.fields[k];
            if (f.isPart || f.usage != Field::Usage::Source || !f.sampled || f.group != first.group || f.emissions != first.emissions) continue;
            isDone[k] = 1;
            together.push_back(shapes.region(f));
        }
        const std::string shape = together.size() == 1 ? together[0] : fmt::format("{{union: {}}}", listed(together));
        out.sources.push_back({fmt::format("{}{}", wordOf(first), i), shape, first.emissions, first.line});
        if (isMovedGroup(scene, first.group))
            report.warnings.push_back(fmt::format("a script moves the source of line {}; sources of scene files stand still", first.line));
    }
}

void importObstacles(const reference::Scene& scene, Shapes& shapes, ImportedBodies& out, ImportReport& report)
{
    for (std::size_t i = 0; i < scene.fields.size(); ++i) {
        const Field& f = scene.fields[i];
        if (f.isPart || f.usage != Field::Usage::Solid) continue;
        const std::string motion = isMovedGroup(scene, f.group) ? motionText(scene, f.group, f.center, report) : "";
        out.obstacles.push_back({fmt::format("{}{}", wordOf(f), i), shapes.body(f), f.inside, f.sampled, motion, f.line});
        if (f.type == Field::Type::File && f.angle != 0.0)
            report.decisions.push_back(
                fmt::format("the mesh of line {} turns about the middle of its bounds; libWetCloth turns it about its centroid", f.line));
    }
}

/// Liquid stays within every terminator of the kind `inside`, and outside of all others.
void importDomain(const reference::Scene& scene, Shapes& shapes, ImportedBodies& out, ImportReport& report)
{
    std::vector<std::string> within, without;
    for (const Field& f : scene.fields) {
        if (f.isPart || f.usage != Field::Usage::Terminator) continue;
        if (within.empty() && without.empty()) out.domainLine = f.line;
        (f.inside ? within : without).push_back(shapes.body(f));
        if (isMovedGroup(scene, f.group))
            report.warnings.push_back(fmt::format("a script moves the terminator of line {}; the domain of scene files stands still", f.line));
    }
    if (within.empty() && without.empty()) return;
    if (within.size() == 1 && without.empty()) out.domain = within[0];
    else if (without.empty()) out.domain = fmt::format("{{intersect: {}}}", listed(within));
    else if (within.empty())
        out.domain = fmt::format("{{invert: {}}}", without.size() == 1 ? without[0] : fmt::format("{{union: {}}}", listed(without)));
    else {
        without.insert(without.begin(), within.size() == 1 ? within[0] : fmt::format("{{intersect: {}}}", listed(within)));
        out.domain = fmt::format("{{subtract: {}}}", listed(without));
    }
}

}  // namespace

ImportedBodies importBodies(const reference::Scene& scene, const std::filesystem::path& xml, const std::filesystem::path& yaml, ImportReport& report)
{
    ImportedBodies out;
    Shapes shapes(scene.fields, xml, yaml);
    importSources(scene, shapes, out, report);
    importObstacles(scene, shapes, out, report);
    importDomain(scene, shapes, out, report);
    out.missingFiles = shapes.missing;
    for (const std::filesystem::path& file : out.missingFiles)
        report.warnings.push_back(fmt::format("the mesh {} is not there; put it there before the scene is run", file.string()));
    return out;
}

}  // namespace app
