#include "app/library/convert_errors.h"
#include "app/library/scene_parts.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/overrides.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <cmath>

namespace drench {

namespace {

using sim::Node;

/// Where mistakes in what a program says are told: "obstacle paddle: …".
std::shared_ptr<const sim::TextSource> said(const std::string& what)
{
    auto source = std::make_shared<sim::TextSource>();
    source->name = what;
    source->numbered = false;
    return source;
}

Node readMap(const std::string& keys, const std::string& what) { return sim::parseYaml("{" + keys + "}", said(what)); }

/// What a program says in keys of its own, behind those that it has in words.
void append(Node& root, std::initializer_list<const char*> path, const Node& element)
{
    Node* list = &root;
    for (const char* key : path) {
        if (list->isNull()) *list = Node::map(element.location);
        if (!list->isMap()) sim::fail(element.location, fmt::format("{} has no place in {}", key, list->called()));
        list = &list->at(key, element.location);
    }
    if (list->isNull()) list->kind = Node::Kind::List;
    if (!list->isList()) sim::fail(element.location, fmt::format("{} is no list", *(path.end() - 1)));
    list->items.push_back(element);
    sim::expandShortForms(root);
}

std::string behind(const std::string& more) { return more.empty() ? "" : ", " + more; }

bool isFinite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// The motion of a program as sim has it.
std::function<Eigen::Isometry3d(double)> given(const std::string& name, const Motion& motion)
{
    return [name, motion](double t) {
        const Pose pose = motion(t);
        if (!isFinite(pose.shift) || !isFinite(pose.turn) || !isFinite(pose.about))
            throw sim::RunError(fmt::format("the motion of obstacle {} is not finite at t = {:.6g} s", name, t));
        const sim::Vec3 turn = toSim(pose.turn), about = toSim(pose.about);
        const double angle = turn.norm();
        const Eigen::AngleAxisd rotation(angle, angle > 0.0 ? sim::Vec3(turn / angle) : sim::Vec3::UnitX());
        return Eigen::Isometry3d(Eigen::Translation3d(toSim(pose.shift) + about) * rotation * Eigen::Translation3d(-about));
    };
}

}  // namespace

std::string flow(const Vec3& v) { return fmt::format("[{}, {}, {}]", sim::formatPlain(v.x), sim::formatPlain(v.y), sim::formatPlain(v.z)); }

sim::Scene Scene::Parts::read() const
{
    sim::Scene scene = sim::readScene(file);
    for (sim::ObstacleSettings& obstacle : scene.obstacles)
        if (const auto own = motions.find(obstacle.name); own != motions.end()) obstacle.motion.addGiven(given(own->first, own->second));
    return scene;
}

Scene::Scene(const std::string& name) : parts_(std::make_unique<Parts>())
{
    parts_->file.file = name;
    parts_->file.root = readMap("", "scene " + name);
}

Scene::Scene(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Scene::Scene(const Scene& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene& Scene::operator=(Scene other) noexcept
{
    parts_.swap(other.parts_);
    return *this;
}

Scene Scene::load(const std::string& file, const std::string& variant)
{
    return convertErrors([&] { return Scene(std::make_unique<Parts>(Parts{sim::loadSceneFile(file, {.variant = variant}), {}})); });
}

Scene Scene::parse(const std::string& text)
{
    return convertErrors([&] { return Scene(std::make_unique<Parts>(Parts{sim::sceneFileFromText(text, "scene"), {}})); });
}

void Scene::set(std::string_view key, std::string_view value)
{
    convertErrors([&] {
        Node& root = parts_->file.root;
        sim::apply(sim::parseOverride(fmt::format("{}={}", key, value), root.location.source->isSi, &parts_->file.notes), root);
    });
}

void Scene::set(std::string_view key, const Vec3& value) { set(key, flow(value)); }

void Scene::setNumber(std::string_view key, double value) { set(key, sim::formatPlain(value)); }

void Scene::add(const Source& source)
{
    convertErrors([&] {
        const std::string keys = fmt::format("shape: {}, velocity: {}{}{}", source.shape.text, flow(source.velocity),
                                             source.name.empty() ? "" : ", name: " + source.name, behind(source.more));
        append(parts_->file.root, {"liquid", "sources"}, readMap(keys, source.name.empty() ? "source" : "source " + source.name));
    });
}

void Scene::add(const std::string& name, const Obstacle& obstacle)
{
    convertErrors([&] {
        const std::string keys = fmt::format("name: {}, shape: {}, inside: {}{}", name, obstacle.shape.text, obstacle.inside, behind(obstacle.more));
        append(parts_->file.root, {"obstacles"}, readMap(keys, "obstacle " + name));
        if (obstacle.motion) parts_->motions[name] = obstacle.motion;
    });
}

void Scene::addFabric(const std::string& name, const std::string& keys)
{
    convertErrors([&] {
        const sim::Node own = sim::parseYaml(keys, said("fabric " + name));
        Node fabric = readMap("name: " + name, "fabric " + name);
        if (!own.isMap()) sim::fail(own.location, fmt::format("needs keys, like {{cloth_grid: {{...}}}}, not {}", own.called()));
        sim::mergeOver(fabric, own);
        append(parts_->file.root, {"fabrics"}, fabric);
    });
}

void Scene::check() const
{
    convertErrors([&] { parts_->read(); });
}

std::string Scene::resolved() const
{
    return convertErrors([&] { return sim::printScene(parts_->read()); });
}

std::vector<std::string> Scene::notes() const
{
    return convertErrors([&] { return parts_->read().notes; });
}

}  // namespace drench
