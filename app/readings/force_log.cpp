#include "app/readings/force_log.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace app {

namespace {

using Json = nlohmann::ordered_json;
using sim::Impulse, sim::Vec3;

constexpr std::size_t kNumbers = 14, kLargest = 6, kFirst = 8;  ///< numbers of a load in ForceTotals, and places among them

Json vectorJson(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// f(impulse) of each load, in the order of ForceTotals.
template <class F>
void forEachLoad(const sim::Forces& forces, F&& f)
{
    for (const std::vector<sim::Load>* loads : {&forces.obstacles, &forces.fabrics})
        for (const sim::Load& load : *loads) f(load.liquid), f(load.contact);
    for (const Impulse& pins : forces.pins) f(pins);
}

/// What tell() says of each load, in the order of forEachLoad, by names.
template <class Tell>
Json byNames(const ForceNames& names, Tell&& tell)
{
    Json json = Json::object();
    const auto addLoads = [&](const char* kind, const std::vector<std::string>& things) {
        for (const std::string& name : things) {
            Json& of = json[kind][name];
            of["liquid"] = tell();
            of["contact"] = tell();
        }
    };
    addLoads("obstacles", names.obstacles);
    addLoads("fabrics", names.fabrics);
    for (const ForceNames::Pins& pins : names.pins) json["pins"][pins.name] = tell();
    return json;
}

}  // namespace

ForceNames::ForceNames(const sim::Scene& scene)
{
    for (const sim::ObstacleSettings& obstacle : scene.obstacles) obstacles.push_back(obstacle.name);
    for (const sim::FabricPiece& piece : scene.fabrics) {
        for (std::size_t i = 0; i < piece.pins.size(); ++i) {
            const std::string& own = piece.pins[i].name;
            const bool isAll = own.empty() && piece.pins.size() == 1;
            const std::string name = isAll ? piece.name : fmt::format("{}.{}", piece.name, own.empty() ? std::to_string(i) : own);
            pins.push_back({name, own, static_cast<int>(fabrics.size())});
        }
        fabrics.push_back(piece.name);
    }
}

void ForceTotals::add(const sim::Forces& forces, bool isFirst)
{
    if (!(forces.dt > 0.0)) return;
    time += forces.dt;
    const double length = firstTime + forces.dt;
    std::size_t at = 0;
    forEachLoad(forces, [&](const Impulse& impulse) {
        if (numbers.size() < at + kNumbers) numbers.resize(at + kNumbers, 0.0);
        double* n = numbers.data() + at;
        Impulse both = impulse;
        for (int a = 0; a < sim::kAxes; ++a) {
            n[a] += impulse.linear[a];
            n[3 + a] += impulse.angular[a];
            both.linear[a] += n[kFirst + a];
            both.angular[a] += n[kFirst + 3 + a];
            n[kFirst + a] = isFirst ? impulse.linear[a] : 0.0;
            n[kFirst + 3 + a] = isFirst ? impulse.angular[a] : 0.0;
        }
        if (!isFirst) {
            n[kLargest] = std::max(n[kLargest], both.linear.norm() / length);
            n[kLargest + 1] = std::max(n[kLargest + 1], both.angular.norm() / length);
        }
        at += kNumbers;
    });
    firstTime = isFirst ? forces.dt : 0.0;
}

sim::Impulse ForceTotals::mean(std::size_t load) const
{
    const std::size_t at = load * kNumbers;
    if (!(time > 0.0) || numbers.size() < at + kNumbers) return {};
    const double* n = numbers.data() + at;
    return {Vec3(n[0], n[1], n[2]) / time, Vec3(n[3], n[4], n[5]) / time};
}

Json forcesJson(const ForceNames& names, const sim::Forces& forces)
{
    std::vector<Impulse> loads;
    forEachLoad(forces, [&](const Impulse& impulse) { loads.push_back((1.0 / forces.dt) * impulse); });
    std::size_t n = 0;
    return byNames(names, [&]() -> Json {
        const Impulse& load = loads.at(n++);
        return {{"force", vectorJson(load.linear)}, {"torque", vectorJson(load.angular)}};
    });
}

Json balanceJson(const sim::Forces& forces)
{
    const sim::MomentumBalance& balance = forces.balance;
    Vec3 onSolids = Vec3::Zero();
    for (const sim::Load& load : forces.obstacles) onSolids += load.sum().linear;
    return {{"change", vectorJson(balance.change)},        {"weight", vectorJson(balance.weight)},
            {"entered", vectorJson(balance.entered)},      {"left", vectorJson(balance.left)},
            {"solid_impulse", vectorJson(onSolids)},       {"support_residual", vectorJson(balance.borne)},
            {"unresolved", vectorJson(balance.unresolved)}};
}

Json forcesJson(const ForceNames& names, const ForceTotals& totals)
{
    std::size_t load = 0;
    return byNames(names, [&]() -> Json {
        const Impulse mean = totals.mean(load);
        const double* largest = totals.numbers.data() + load++ * kNumbers + kLargest;
        return {{"mean_force", vectorJson(mean.linear)},
                {"largest_force", largest[0]},
                {"mean_torque", vectorJson(mean.angular)},
                {"largest_torque", largest[1]}};
    });
}

}  // namespace app
