#include "app/lab/stability/stability_map.h"

#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

struct Transfer {
    std::string name;
    std::vector<std::string> sets;
};

const std::vector<Transfer>& transfers()
{
    static const std::vector<Transfer> all = {{"pic", {"transfer.method=pic"}},
                                              {"apic", {"transfer.method=apic"}},
                                              {"polypic_8", {"transfer.method=polypic", "transfer.modes=8"}},
                                              {"polypic_11", {"transfer.method=polypic", "transfer.modes=11"}},
                                              {"polypic_15", {"transfer.method=polypic", "transfer.modes=15"}},
                                              {"polypic_27", {"transfer.method=polypic", "transfer.modes=27"}}};
    return all;
}

void requireMethod(const std::string& name)
{
    std::vector<std::string> known;
    for (const Transfer& transfer : transfers()) known.push_back(transfer.name);
    if (std::ranges::find(known, name) == known.end()) throw sim::InputError(fmt::format("--method {}: there are {}", name, fmt::join(known, ", ")));
}

std::vector<std::string> parameterOverrides(const LoadedScene& setup, const std::string& parameter, double factor)
{
    const sim::LiquidSettings& liquid = setup.scene.settings.liquid;
    if (parameter == "density") return {fmt::format("liquid.density={:.6g}", factor * liquid.density)};
    if (parameter == "cell") return {fmt::format("grid.cell={:.6g}", factor * setup.scene.settings.cell)};
    if (parameter == "viscosity") return {fmt::format("liquid.viscosity={:.6g}", factor * liquid.viscosity), "liquid.solve_viscosity=true"};
    if (parameter != "stiffness") throw sim::InputError(fmt::format("--parameter {}: there are stiffness, density, viscosity, cell", parameter));
    std::vector<std::string> sets;
    for (const sim::NamedMaterial& material : setup.scene.materials)
        sets.push_back(fmt::format("materials.{}.young={:.6g}", material.name, factor * material.material.young));
    if (sets.empty()) throw sim::InputError(fmt::format("--parameter stiffness: {} has no materials", setup.scene.name));
    return sets;
}

}  // namespace

std::vector<StabilityMethod> stabilityMethods(const LoadedScene& setup, const std::vector<std::string>& names)
{
    std::ranges::for_each(names, requireMethod);
    std::vector<StabilityMethod> methods;
    for (const Transfer& transfer : transfers()) {
        if (!names.empty() && std::ranges::find(names, transfer.name) == names.end()) continue;
        if (setup.scene.fabrics.empty()) methods.push_back({transfer.name, transfer.sets});
        for (const char* solver : {"vertex", "grid"}) {
            if (setup.scene.fabrics.empty()) continue;
            StabilityMethod& method = methods.emplace_back(StabilityMethod{transfer.name + ' ' + solver, transfer.sets});
            method.sets.push_back(fmt::format("fabric.solver={}", solver));
        }
    }
    return methods;
}

std::vector<StabilityMethod> withParameter(const std::vector<StabilityMethod>& methods, const LoadedScene& setup, const std::string& parameter,
                                           const std::vector<double>& factors)
{
    std::vector<StabilityMethod> all;
    for (const StabilityMethod& method : methods) {
        for (const double factor : factors) {
            StabilityMethod& turned = all.emplace_back(method);
            turned.name += fmt::format(" {}*{:g}", parameter, factor);
            std::ranges::copy(parameterOverrides(setup, parameter, factor), std::back_inserter(turned.sets));
        }
    }
    return all;
}

}  // namespace app
