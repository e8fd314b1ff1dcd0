#include "app/runs/probe_stored.h"

#include "app/probes/probe_log.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <array>
#include <regex>

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

/// What a formula asks for that states do not tell of; nothing where they tell all of it.
std::string missingFrom(const std::string& formula)
{
    static const std::array<std::pair<const char*, std::regex>, 5> kinds = {{
        {"forces", std::regex("(liquid_|contact_|pin_)?(force|torque)_[xyz]")},
        {"pressures on discs", std::regex("pressure_on")},
        {"energies", std::regex("kinetic|potential|energy|fabric_kinetic|elastic")},
        {"fronts", std::regex("front_[xyz]")},
        {"the flow", std::regex("flow_(error|part)")},
    }};
    static const std::regex name("\"[^\"]*\"|[A-Za-z_]\\w*");  // texts in quotes are names of things in the scene
    for (std::sregex_iterator word(formula.begin(), formula.end(), name), none; word != none; ++word)
        for (const auto& [kind, names] : kinds)
            if (std::regex_match(word->str(), names)) return kind;
    return {};
}

/// Leaves out what only a run under way can tell, and says in one line what that is. Throws InputError where nothing else is left.
void keepStored(Probes& probes)
{
    std::vector<std::string> leftOut;
    std::erase_if(probes.all, [&](const Probe& probe) {
        const std::string missing = missingFrom(probe.read.text());
        if (!missing.empty()) leftOut.push_back(fmt::format("{} ({})", probe.name, missing));
        return !missing.empty();
    });
    if (leftOut.empty()) return;
    const std::string text =
        fmt::format("output.probes: left out {}: stored states do not tell of that, only a run with output.probes does", fmt::join(leftOut, ", "));
    if (probes.all.empty()) throw sim::InputError(text);
    spdlog::warn(text);
}

}  // namespace

bool probeStoredRun(const StoredRun& run, const std::filesystem::path& out, const std::function<bool()>& stopWanted)
{
    std::optional<Probes> probes = readProbes(run.setup);
    if (!probes)
        throw sim::InputError(
            fmt::format("{}: its scene has no output.probes; give a file of them: drench probe FOLDER PROBES", run.folder.string()));
    keepStored(*probes);
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
