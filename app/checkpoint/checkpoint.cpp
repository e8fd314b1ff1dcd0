#include "app/checkpoint/checkpoint.h"

#include "app/checkpoint/field_files.h"
#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/particles/velocity_modes.h"
#include "sim/scene/load_scene.h"
#include "sim/state_fields.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace app {

namespace {

// A file begins with lines of text, filled up with zeros to where HDF5 looks for its beginning next, that say whether
// what follows is what was written:
//   Drench checkpoint 2
//   bytes 123456
//   xxh3 0123456789abcdef
constexpr std::size_t kHeaderBytes = 512;
constexpr std::string_view kMagic = "Drench checkpoint ";
constexpr int kVersion = 15;

std::string checksum(std::string_view content) { return hexDigits(XXH3_64bits(content.data(), content.size())); }

std::string headerFor(std::string_view content)
{
    std::string header = fmt::format("{}{}\nbytes {}\nxxh3 {}\n", kMagic, kVersion, content.size(), checksum(content));
    header.resize(kHeaderBytes, '\0');
    return header;
}

/// The word behind `name` in the header.
std::string_view wordBehind(std::string_view header, std::string_view name)
{
    const std::size_t at = header.find(name);
    if (at == std::string_view::npos) return {};
    const std::string_view rest = header.substr(at + name.size());
    return rest.substr(0, rest.find('\n'));
}

/// Throws InputError unless the bytes are those that were written.
void requireWhole(std::string_view bytes, const std::filesystem::path& file)
{
    const auto refuse = [&](const std::string& why) {
        throw sim::InputError(fmt::format("{}: {}; take an earlier one with --from-frame, or start anew", file.string(), why));
    };
    const std::string_view header = bytes.substr(0, kHeaderBytes);
    if (!header.starts_with(kMagic)) refuse("this is no checkpoint of Drench");
    if (const auto version = wordBehind(header, kMagic); version != std::to_string(kVersion))
        refuse(fmt::format("a checkpoint of version {}, where this program has {}", version, kVersion));
    if (bytes.size() < kHeaderBytes) refuse("the checkpoint is cut off in its header");
    const std::string_view content = bytes.substr(kHeaderBytes);
    if (const auto size = wordBehind(header, "\nbytes "); size != std::to_string(content.size()))
        refuse(fmt::format("the checkpoint is cut off: {} of its {} bytes are there", content.size(), size));
    if (wordBehind(header, "\nxxh3 ") != checksum(content)) refuse("the checkpoint is damaged: its content is not that of its checksum");
}

template <class V, class Times>
void visitTimes(V& v, Times& times)
{
    v.list("logs/seconds/step", "s", times.total);
    for (int s = 0; s < sim::kStages; ++s) v.list("logs/seconds/" + std::string(sim::kStageNames[s]), "s", times.stages[s]);
}

template <class V, class Summary>
void visitSummary(V& v, Summary& s)
{
    v.number("logs/steps", "-", s.steps);
    v.number("logs/frames", "-", s.frames);
    v.number("logs/simulated_time", "s", s.simulatedTime);
    v.number("logs/wall_seconds", "s", s.wallSeconds);
    visitTimes(v, s.times);
    v.number("logs/particles", "-", s.particles);
    v.number("logs/cells", "-", s.cells);
    v.number("logs/particle_sum", "-", s.particleSum);
    v.number("logs/iterations", "-", s.totalIterations);
    v.number("logs/most_iterations", "-", s.maxIterations);
    v.number("logs/fabric_vertices", "-", s.fabricVertices);
    v.number("logs/fabric_elements", "-", s.fabricElements);
    v.number("logs/fabric_mass", "g", s.fabricMass);
    v.number("logs/fabric_iterations", "-", s.fabricIterations);
    v.number("logs/fabric_substep_splits", "-", s.fabricSubstepSplits);
    v.number("logs/fabric_truncated_substeps", "-", s.fabricTruncatedSubsteps);
    v.number("logs/least_accepted_fraction", "-", s.leastAcceptedFraction);
    v.number("logs/rejected_steps", "-", s.rejectedSteps);
    v.number("logs/largest_cfl", "-", s.largestCfl);
    v.number("logs/mass_error", "-", s.massError);
    v.number("logs/forces/time", "s", s.forces.time);
    v.number("logs/forces/first_time", "s", s.forces.firstTime);
    v.list("logs/forces/numbers", "cgs", s.forces.numbers);
}

template <class V, class Logs>
void visitLogs(V& v, Logs& logs)
{
    visitSummary(v, logs.summary);
    v.number("logs/steps_bytes", "-", logs.stepsBytes);
    v.number("logs/energy_bytes", "-", logs.energyBytes);
    v.number("logs/ledger_bytes", "-", logs.ledgerBytes);
    v.number("logs/probes_bytes", "-", logs.probesBytes);
    v.number("logs/since_reading/time", "s", logs.sinceReading.forces.time);
    v.number("logs/since_reading/first_time", "s", logs.sinceReading.forces.firstTime);
    v.list("logs/since_reading/numbers", "cgs", logs.sinceReading.forces.numbers);
    v.number("logs/since_reading/pressure_time", "s", logs.sinceReading.pressures.time);
    v.list("logs/since_reading/pressures", "dyn s/cm^2", logs.sinceReading.pressures.sums);
    EnergyLedger::Summary ledger = logs.summary.energyLedger.value_or(EnergyLedger::Summary());
    v.number("logs/ledger/first", "erg", ledger.first);
    v.number("logs/ledger/largest_kinetic", "erg", ledger.largestKinetic);
    v.number("logs/ledger/largest_residual", "erg", ledger.largestResidual);
    v.rows("logs/ledger/changes", "erg", 1, sim::kEnergyChanges, [&](std::size_t) { return &ledger.changes.of[0]; });
    if constexpr (V::kFills)
        if (logs.ledgerBytes > 0) logs.summary.energyLedger = ledger;
}

template <class V, class Origin>
void visitOrigin(V& v, Origin& origin)
{
    v.number("program", "-", origin.program);
    v.number("state_hash", "-", origin.stateHash);
    v.number("frame", "-", origin.frame);
    visitLogs(v, origin.logs);
}

}  // namespace

std::string trajectoryHash(const LoadedScene& setup)
{
    sim::Scene scene = setup.scene;
    scene.title.clear();
    scene.settings.time.duration = 1.0;
    for (sim::SettingsChange& change : scene.changes) change.settings.time.duration = 1.0;
    const std::string text = fmt::format("{}\nframes every {:.17g} s\n", sim::printScene(scene), setup.pictures.output.every);
    return checksum(text);
}

void saveCheckpoint(const CheckpointOrigin& origin, const sim::State& state, const std::filesystem::path& file)
{
    Hdf5Writer hdf5;
    hdf5.text("scene", origin.scene);
    hdf5.text("variant", origin.variant);
    hdf5.text("label", origin.label);
    hdf5.text("trajectory", origin.trajectory);
    hdf5.text("provenance", origin.provenance);
    FieldWriter writer(hdf5);
    visitOrigin(writer, origin);
    sim::visitState(writer, state);
    const std::string content = hdf5.finish();
    writeWhole(file, {headerFor(content), content});
}

Checkpoint loadCheckpoint(const std::filesystem::path& file)
{
    const std::string bytes = readWhole(file);
    requireWhole(bytes, file);
    try {
        const Hdf5Reader hdf5(std::string_view(bytes).substr(kHeaderBytes));
        Checkpoint checkpoint;
        checkpoint.origin.scene = hdf5.text("scene");
        checkpoint.origin.variant = hdf5.text("variant");
        checkpoint.origin.label = hdf5.text("label");
        checkpoint.origin.trajectory = hdf5.text("trajectory");
        checkpoint.origin.provenance = hdf5.text("provenance");
        FieldReader reader(hdf5);
        visitOrigin(reader, checkpoint.origin);
        sim::visitState(reader, checkpoint.state);
        if (const int modes = checkpoint.state.liquid.modeCount; modes != sim::storedModes(modes))
            throw std::runtime_error("a number of modes that there is not");
        return checkpoint;
    } catch (const std::runtime_error& error) {
        throw sim::InputError(fmt::format("{}: not understood: {}; was it written by another version?", file.string(), error.what()));
    }
}

void copyForPictures(const sim::State& state, sim::State& lean)
{
    const sim::LiquidParticles& liquid = state.liquid;
    sim::LiquidParticles few = std::move(lean.liquid);
    lean.liquid = {};
    few.changeModes(1);
    few.resize(liquid.count);
    for (int axis = 0; axis < sim::kAxes; ++axis) std::copy_n(liquid.x[axis].data(), liquid.count, few.x[axis].data());
    std::copy_n(liquid.mass.data(), liquid.count, few.mass.data());
    std::copy_n(liquid.id.data(), liquid.count, few.id.data());
    constexpr std::size_t kGrain = 4096;
    sim::parallelFor(liquid.count, kGrain, [&](std::size_t p) {
        const sim::Vec3 v = liquid.velocity(p);
        for (int axis = 0; axis < sim::kAxes; ++axis) few.mode(axis, 0)[p] = v[axis];
    });
    lean.time = state.time;
    lean.step = state.step;
    lean.grid = state.grid;
    lean.pressure = state.pressure;
    lean.fabric = state.fabric;
    lean.emittedVolume = state.emittedVolume;
    lean.nextId = state.nextId;
    lean.liquid = std::move(few);
}

}  // namespace app
