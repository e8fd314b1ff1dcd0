#pragma once

#include <drench/error.h>
#include <drench/readings.h>
#include <drench/scene.h>
#include <drench/version.h>

#include <cstdint>
#include <memory>
#include <string>

namespace drench {

/// A scene under way. The same scene gives the same bits for any number of threads, and whatever options the program that calls it was
/// compiled with. One thread at a time may use it; several may run beside each other.
class Simulation {
 public:
    /// The scene at its start, a copy of it: what becomes of `scene` later does not matter.
    /// @param threads  for its loops; 0: as many as there are
    /// Throws InputError.
    explicit Simulation(const Scene& scene, int threads = 0);
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    /// One step towards a time [s], which the last of several hits exactly. Throws RunError.
    Step step(double until);
    /// Steps until a time [s], where velocities are those of the flow; nothing if it is there already. Throws RunError.
    void advanceTo(double until);

    double time() const;         ///< [s]
    std::int64_t steps() const;  ///< taken so far
    double end() const;          ///< when the scene's time.duration is over [s]

    Particles particles() const;
    Fabric fabric() const;
    Energies energies() const;
    /// Mean over the last step, or over the last two if they belong together, or over the last call of advanceTo: what acts on an obstacle or a
    /// fabric by its name, by liquid and contact. 0 before the first step. Throws InputError where there is no such thing.
    Load on(const std::string& name) const;
    /// A formula of what is read as the scene runs, in the words of probes: "pressure(0, 1, 0)", "front_x(0.5)", "velocity_y(x, y, z)" with a
    /// place for x, y and z [cm]; forces as `force_y("ball")` are means as on() gives. NaN where it has no value. Throws InputError where it is none.
    double read(const std::string& formula, const Vec3& at = {}) const;

    /// Hash of all that evolves: equal hashes, equal states.
    std::uint64_t stateHash() const;

    struct Parts;  // what stands behind it
    const Parts& parts() const { return *parts_; }

 private:
    std::unique_ptr<Parts> parts_;
};

}  // namespace drench
