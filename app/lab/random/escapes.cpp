#include "app/lab/random/escapes.h"

#include "app/checkpoint/checkpoint.h"
#include "app/checkpoint/state_files.h"
#include "sim/grid/obstacles.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace app {

namespace {

/// Deeper in a solid nothing may be [cells].
constexpr double kDeep = 0.02;

/// Counts the places that are inside of a solid, or out of the vessel: what is no number is nowhere in it.
struct Escapes {
    const sim::Obstacles& obstacles;
    const std::optional<Eigen::AlignedBox3d>& vessel;
    double tolerance;  ///< [cm]
    int inside = 0, outside = 0;
    double deepest = 0.0;  ///< [cm]

    /// @param beganOutside  it may be out of the vessel
    void look(const sim::Vec3& x, bool beganOutside = false)
    {
        if (!x.allFinite()) {
            ++outside;
            return;
        }
        const double depth = -obstacles.distance(x);
        inside += depth > tolerance;
        deepest = std::max(deepest, depth);
        outside += vessel && !beganOutside && vessel->exteriorDistance(x) > tolerance;
    }
    bool any() const { return inside + outside > 0; }
    std::string text(const char* what) const
    {
        std::string told;
        if (inside > 0) told += fmt::format("{} {} inside of solids, up to {:.2g} cm ", inside, what, deepest);
        if (outside > 0) told += fmt::format("{} {} outside of the vessel ", outside, what);
        return told;
    }
};

/// Which particles began out of the vessel, or may have come off what did.
class BeganOutside {
 public:
    /// @param tolerance  what is as near to the vessel's outside is on it [cm]
    BeganOutside(const sim::Scene& scene, const sim::State& start, const std::optional<Eigen::AlignedBox3d>& vessel, double tolerance)
        : isOutside_(start.liquid.count, vessel ? 0 : 1)
    {
        if (!vessel) return;
        const sim::Vec3 margin = sim::Vec3::Constant(tolerance);
        const Eigen::AlignedBox3d within(vessel->min() + margin, vessel->max() - margin);
        const auto isOut = [&](const sim::Vec3& x) { return !within.contains(x); };
        for (std::size_t p = 0; p < start.liquid.count; ++p) isOutside_[start.liquid.id[p]] = isOut(start.liquid.position(p)) ? 1 : 0;
        laterMay_ = std::ranges::any_of(scene.sources, [&](const sim::SourceSettings& source) { return !within.contains(source.shape.bounds()); }) ||
                    std::ranges::any_of(start.fabric.x, isOut);
    }
    bool of(std::uint32_t id) const { return id < isOutside_.size() ? isOutside_[id] != 0 : laterMay_; }

 private:
    std::vector<char> isOutside_;  ///< whether each particle there was at the start is outside, by id
    bool laterMay_ = true;
};

}  // namespace

std::string describeEscape(const std::filesystem::path& file, const std::filesystem::path& folder, const std::optional<Eigen::AlignedBox3d>& vessel)
{
    const auto frames = storedFrames(folder, StateKind::ForResuming);
    if (frames.empty()) return "";
    const sim::Scene scene = sim::loadScene(file);
    const sim::State state = loadCheckpoint(stateFile(folder, StateKind::ForResuming, frames.back())).state;
    sim::Obstacles obstacles;
    for (const sim::ObstacleSettings& obstacle : scene.obstacles) obstacles.add(obstacle.shape, obstacle.motion);
    obstacles.moveTo(state.time, state.time);
    const double tolerance = kDeep * scene.settings.cell;
    sim::Obstacles atStart = obstacles;
    atStart.moveTo(0.0, 0.0);
    const auto startsOutside = [&](const sim::Vec3& x) { return atStart.distance(x) >= 0.0 && (!vessel || vessel->contains(x)); };
    Escapes particles{obstacles, vessel, tolerance}, vertices{obstacles, vessel, tolerance};
    const sim::Simulation start(scene);
    const bool feelsSolids = scene.settings.fabric.contact;
    Escapes led{obstacles, vessel, tolerance};
    for (std::size_t v = 0; v < state.fabric.x.size(); ++v) {
        if (start.fabric().pinned[v]) led.look(state.fabric.x[v]);
        else if (feelsSolids && startsOutside(start.state().fabric.x[v])) vertices.look(state.fabric.x[v]);
    }
    const BeganOutside beganOutside(scene, start.state(), vessel, tolerance);
    // Fabric that feels no solid, or is led through one, drips wherever it has got to.
    const bool mayDripAnywhere = scene.settings.coupling.drip && !scene.fabrics.empty() && (!feelsSolids || led.any());
    for (std::size_t p = 0; !mayDripAnywhere && p < state.liquid.count; ++p)
        particles.look(state.liquid.position(p), beganOutside.of(state.liquid.id[p]));
    return particles.text("particles") + vertices.text("vertices");
}

}  // namespace app
