#pragma once

#include "sim/simulation.h"
#include "tests/physics/intersection_check.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <vector>

namespace sim::test {

/// A scene of fabric, looked at every so often for what must not happen by a checker that shares nothing with the solver.
class WatchedRun {
 public:
    struct Seen {
        bool isFinite = true;
        int flipped = 0, undecided = 0;                            ///< crossings of yarns, the most at one look
        int pierced = 0;                                           ///< faces of cloth
        double spare = std::numeric_limits<double>::infinity();    ///< Crossings::Nearness, the least [cm]
        double nearest = std::numeric_limits<double>::infinity();  ///< of d / (r_A + r_B)
        int substepSplits = 0, truncatedSubsteps = 0;
        double leastAcceptedFraction = 1.0;  ///< of its way that a vertex was let go
        std::vector<double> milliseconds;    ///< of every step
    };

    /// @param up  across the fabric at rest, for yarns
    explicit WatchedRun(const Scene& scene, const Vec3& up = Vec3::UnitY()) : simulation_(scene)
    {
        if (simulation_.fabric().strands.count() > 0) crossings_.emplace(simulation_.fabric(), up);
    }

    /// On to `duration` with a look every `between` seconds, or to the first look at which something is not finite.
    const Seen& run(double duration, double between)
    {
        for (int n = 1; n * between < duration * (1.0 + 1.0e-9) && seen_.isFinite; ++n) {
            advance(n * between);
            look();
        }
        return seen_;
    }

    const Simulation& simulation() const { return simulation_; }

 private:
    void advance(double until)
    {
        while (simulation_.state().time < until * (1.0 - 1.0e-12)) {
            const auto begin = std::chrono::steady_clock::now();
            const StepReport report = simulation_.step(until);
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
            seen_.milliseconds.push_back(took.count());
            seen_.substepSplits += report.fabric.substepSplits;
            seen_.truncatedSubsteps += report.fabric.truncatedSubsteps;
            seen_.leastAcceptedFraction = std::min(seen_.leastAcceptedFraction, report.fabric.acceptedFraction);
        }
    }

    void look()
    {
        const std::vector<Vec3>&x = simulation_.state().fabric.x, &v = simulation_.state().fabric.v;
        const auto finite = [](const Vec3& value) { return value.allFinite(); };
        seen_.isFinite = std::ranges::all_of(x, finite) && std::ranges::all_of(v, finite);
        if (!seen_.isFinite) return;
        if (crossings_) {
            const auto [flipped, undecided] = crossings_->count(x);
            const auto [spare, relative] = crossings_->nearness(x);
            seen_.flipped = std::max(seen_.flipped, flipped);
            seen_.undecided = std::max(seen_.undecided, undecided);
            seen_.spare = std::min(seen_.spare, spare);
            seen_.nearest = std::min(seen_.nearest, relative);
        }
        if (simulation_.fabric().faces.size() > 0) seen_.pierced = std::max(seen_.pierced, piercedFaces(simulation_.fabric(), x));
    }

    Simulation simulation_;
    std::optional<Crossings> crossings_;
    Seen seen_;
};

}  // namespace sim::test
