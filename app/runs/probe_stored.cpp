#include "app/runs/probe_stored.h"

#include "app/probes/probe_log.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "sim/core/check.h"

#include <fmt/format.h>

namespace app {

namespace {

/// A state as formulas look at it, without what only a run under way has.
class StoredSimulation : public SimulationHandle {
 public:
    explicit StoredSimulation(const sim::Scene& scene) : fabric_(sim::assembleFabric(scene.fabrics)) {}
    void show(const sim::State& state) { state_ = &state; }

    const sim::State& state() const override { return *state_; }
    const sim::Fabric& fabric() const override { return fabric_; }
    const sim::ActiveContacts* contacts() const override { return nullptr; }
    const sim::LiquidGrid& liquidGrid() const override { refuse("fronts and flow_error"); }
    const sim::Forces& forces() const override { return forces_; }
    sim::StepReport step(double) override { refuse("steps"); }
    sim::Energies energies() const override { refuse("energies"); }
    void bookEnergy() override { refuse("energies"); }
    std::uint64_t stateHash() const override { refuse("hashes"); }
    void setChanges(std::vector<sim::SettingsChange>) override { refuse("changes"); }

 private:
    [[noreturn]] static void refuse(const char* what)
    {
        throw sim::InputError(fmt::format("stored states do not tell of {}: run the scene anew with output.probes", what));
    }
    const sim::State* state_ = nullptr;
    const sim::Fabric fabric_;
    const sim::Forces forces_;
};

/// What only a run under way can tell is not read of its states.
void requireStored(const Probes& probes)
{
    for (const Probe& probe : probes.all)
        for (const char* means : {"force_", "torque_", "pressure_on"})
            if (probe.read.text().find(means) != std::string::npos)
                throw sim::InputError(fmt::format("output.probes: {}: stored states do not tell of {}: run the scene anew with output.probes",
                                                  probe.name, std::string_view(means) == "pressure_on" ? "pressures on discs" : "forces"));
}

}  // namespace

bool probeStoredRun(const StoredRun& run, const std::filesystem::path& out, const std::function<bool()>& stopWanted)
{
    const std::optional<Probes> probes = readProbes(run.setup);
    if (!probes)
        throw sim::InputError(
            fmt::format("{}: its scene has no output.probes; give a file of them: drench probe FOLDER PROBES", run.folder.string()));
    requireStored(*probes);
    makeFolder(out);
    const auto part = partFile(out / kProbesFile);
    try {
        StoredSimulation simulation(run.setup.scene);
        ProbeLog log(part, *probes, run.setup.scene.settings.time.start);
        const bool ended = forEachState(run, stopWanted, [&](const Checkpoint& stored) {
            simulation.show(stored.state);
            if (log.isNew()) log.initial(simulation);
            else log.step(simulation, false);
        });
        if (ended) putInPlace(part, out / kProbesFile);
        else std::filesystem::remove(part);
        if (ended && canPlot()) plotProbes(*probes, run.setup.scene.title, out);
        return ended;
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw;
    }
}

}  // namespace app
