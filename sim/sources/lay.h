#pragma once

#include "sim/scene/scene.h"
#include "sim/sources/seed.h"
#include "sim/state.h"

#include <numeric>
#include <span>
#include <string>

// What is laid at once into a source, and what it is laid by.

namespace sim {

/// The source in messages, with its file: `drop.yaml: source 1 "drop" `.
std::string nameOf(const Scene& scene, std::size_t source);

/// The obstacles where they are at a time.
std::vector<Shape> solidsAt(const Scene& scene, double time);

/// Plan that fills a source as it is at a time, with the obstacles where they are then.
SeedPlan planFor(const Scene& scene, std::size_t source, double time, const State& state);

/// Liquid in the source of a plan and around it.
LiquidNearby liquidNear(const LiquidParticles& liquid, const SeedPlan& plan, double density);

/// seedParticles, whose complaints name the source.
Seeds seedsFor(const Scene& scene, std::size_t source, const SeedPlan& plan, const LiquidNearby& nearby);

/// Particles to be laid.
struct NewParticles {
    std::span<const Vec3> positions;
    double volume;                      ///< volume of each particle, or their mean [cm³]
    std::span<const double> volumes{};  ///< volume of each particle, where they are not alike [cm³]

    double volumeOf(std::size_t n) const { return volumes.empty() ? volume : volumes[n]; }
    double sum() const
    {
        return volumes.empty() ? static_cast<double>(positions.size()) * volume : std::accumulate(volumes.begin(), volumes.end(), 0.0);
    }
};

/// Does it lay a body at once?
inline bool isInstant(const Emission& e) { return e.to <= e.from; }

/// How many particles of a volume there are until a volume is reached: the last one may pass it.
std::size_t countUpTo(double volume, double perParticle);

/// The first of some seeds.
NewParticles firstOf(const Seeds& seeds, std::size_t most);

/// Particles that move with a velocity, numbered on; entered nowhere yet.
void addParticles(const NewParticles& particles, double density, const Vec3& velocity, State& state);

/// Particles of a source, entered in what it has given and in the ledger.
void lay(const Scene& scene, std::size_t source, const Emission& emission, const NewParticles& particles, State& state);

}  // namespace sim
