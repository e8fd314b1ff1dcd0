#pragma once

#include "app/readings/measures.h"
#include "app/real_simulation.h"
#include "drench/simulation.h"
#include "sim/scene/formula.h"

#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace drench {

/// A simulation with what is copied out of it to be read, once for each step and only if it is asked for.
struct Simulation::Parts {
    /// @param threads  0: as many as there are
    Parts(const sim::Scene& scene, int threads);

    const app::RealSimulation& real() const { return *simulation_; }
    sim::StepReport step(double until);
    void advanceTo(double until);
    Particles particles();
    Fabric fabric();
    double read(const std::string& formula, const Vec3& at);

 private:
    template <class Body>
    auto withThreads(Body&& body) const;
    void beginStep();
    void copyLinks();

    int threads_;
    std::unique_ptr<app::RealSimulation> simulation_;
    app::Measures measures_;
    sim::FormulaNames names_;
    std::map<std::string, sim::Formula> formulas_;

    bool hasParticles_ = false, hasFabric_ = false;  ///< what follows is of the state as it is
    std::array<std::vector<double>, 3> velocity_;    ///< velocity of each particle [cm/s]
    std::vector<Vec3> position_, vertexVelocity_;    ///< position and velocity of each vertex [cm], [cm/s]
    std::vector<double> saturation_;                 ///< saturation of each vertex [0..1]
    std::vector<std::array<int, 2>> edges_;
    std::vector<std::array<int, 3>> triangles_;
};

}  // namespace drench
