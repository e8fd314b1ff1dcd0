#pragma once

#include "app/diff/finding.h"
#include "app/scene/tolerance.h"
#include "sim/state.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// Holds states of two runs against each other, time after time: particles by their ids, vertices by their numbers.
class StateDiff {
 public:
    /// Holds two states of one frame against each other.
    void add(const sim::State& a, const sim::State& b);
    bool isEmpty() const { return states_ == 0; }
    /// The time of the first states that are not the same to the last bit [s].
    std::optional<double> differsFrom() const { return differsFrom_; }
    /// The largest differences of positions, velocities and masses, of whom and when.
    std::vector<DiffFinding> findings(const Tolerance& tolerance) const;

 private:
    /// The largest difference of one quantity so far.
    struct Largest {
        const char* unit;
        double value = 0.0;
        std::uint64_t who = 0;
        double time = 0.0;  ///< [s]
        void offer(double difference, std::uint64_t id, double t);
    };
    /// Who has no like in the other run.
    struct Missing {
        std::size_t most = 0;     ///< largest number of them at one time
        std::uint64_t first = 0;  ///< first of them, by number
        double time = 0.0;        ///< time when there are most [s]
        void offer(const std::vector<std::uint64_t>& ids, double t);
    };
    void addLiquid(const sim::LiquidParticles& a, const sim::LiquidParticles& b, double time);
    void addFabric(const sim::FabricState& a, const sim::FabricState& b, double time);

    std::size_t states_ = 0;
    std::optional<double> differsFrom_;
    Largest position_{"cm"}, velocity_{"cm/s"}, mass_{"g"};  ///< largest differences of particles
    Largest vertexPosition_{"cm"}, vertexVelocity_{"cm/s"}, absorbed_{"g"};
    Missing onlyA_, onlyB_;  ///< particles
    std::size_t verticesA_ = 0, verticesB_ = 0;
};

}  // namespace app
