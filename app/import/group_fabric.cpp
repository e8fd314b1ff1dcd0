#include "app/import/group_fabric.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace app {

namespace {

/// Which particles hang together.
class ConnectedParts {
 public:
    explicit ConnectedParts(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }
    int of(int p)
    {
        while (above_[p] != p) p = above_[p] = above_[above_[p]];
        return p;
    }
    void join(int a, int b) { above_[of(a)] = of(b); }

 private:
    std::vector<int> above_;
};

ConnectedParts connectedParts(const reference::Scene& scene)
{
    ConnectedParts parts(scene.particles.size());
    for (const reference::Cloth& cloth : scene.cloths) {
        for (const sim::Vec3i& f : cloth.faces) {
            parts.join(f[0], f[1]);
            parts.join(f[1], f[2]);
        }
    }
    for (const reference::Yarn& yarn : scene.yarns)
        for (std::size_t i = 1; i < yarn.particles.size(); ++i) parts.join(yarn.particles[i - 1], yarn.particles[i]);
    return parts;
}

void collectParticles(FabricGroup& group)
{
    for (const sim::Vec3i& f : group.faces) group.particles.insert(group.particles.end(), f.begin(), f.end());
    for (const std::vector<int>& s : group.strands) group.particles.insert(group.particles.end(), s.begin(), s.end());
    std::ranges::sort(group.particles);
    group.particles.erase(std::unique(group.particles.begin(), group.particles.end()), group.particles.end());
}

/// Warns where groups of different kinds or materials meet: scene files have no piece of both.
void reportTornJoints(const std::vector<FabricGroup>& groups, ImportReport& report)
{
    std::map<int, int> uses;
    for (const FabricGroup& group : groups)
        for (const int p : group.particles) ++uses[p];
    const auto torn = std::ranges::count_if(uses, [](const auto& use) { return use.second > 1; });
    if (torn > 0)
        report.warnings.push_back(
            fmt::format("{} vertices join cloth and yarns, or two materials: scene files have no piece of fabric that "
                        "is both, so these "
                        "pieces come apart there; each has a vertex of its own",
                        torn));
}

}  // namespace

std::vector<FabricGroup> groupFabric(const reference::Scene& scene, ImportReport& report)
{
    ConnectedParts parts = connectedParts(scene);
    std::map<std::tuple<int, int, bool>, FabricGroup> byPart;
    const auto groupAt = [&](int particle, int material, bool isCloth, int line) -> FabricGroup& {
        const auto [found, isNew] = byPart.try_emplace({parts.of(particle), material, isCloth});
        if (isNew) found->second.line = line;
        found->second.material = material;
        return found->second;
    };
    for (const reference::Cloth& cloth : scene.cloths)
        for (const sim::Vec3i& f : cloth.faces) groupAt(f[0], cloth.material, true, cloth.line).faces.push_back(f);
    for (const reference::Yarn& yarn : scene.yarns) groupAt(yarn.particles[0], yarn.material, false, yarn.line).strands.push_back(yarn.particles);
    std::vector<FabricGroup> groups;
    for (auto& [key, group] : byPart) {
        collectParticles(group);
        groups.push_back(std::move(group));
    }
    std::ranges::stable_sort(groups, {}, [](const FabricGroup& g) { return std::pair(g.line, g.particles.front()); });
    reportTornJoints(groups, report);
    return groups;
}

FabricGroup merged(const std::vector<FabricGroup>& groups)
{
    FabricGroup all = groups.front();
    for (std::size_t i = 1; i < groups.size(); ++i) all.strands.insert(all.strands.end(), groups[i].strands.begin(), groups[i].strands.end());
    all.particles.clear();
    collectParticles(all);
    return all;
}

}  // namespace app
