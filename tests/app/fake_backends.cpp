#include "tests/app/fake_backends.h"

#include "app/runs/paper_runs.h"
#include "sim/core/check.h"

#include <fmt/format.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>

namespace app::test {

namespace {

constexpr int kWidth = 32, kHeight = 16;

void wait(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

/// One particle that moves along x; nothing else.
class ToySimulation : public SimulationHandle {
 public:
    explicit ToySimulation(const ToySettings& toy) : toy_(toy)
    {
        state_.liquid.add(sim::Vec3::Zero(), 2.0, 0, sim::Vec3(toy.speed, 0.0, 0.0));
        state_.ledger.emittedMass = 2.0;
    }
    ToySimulation(const ToySettings& toy, const sim::State& state) : toy_(toy), state_(state) {}
    const sim::State& state() const override { return state_; }
    const sim::Fabric& fabric() const override { return fabric_; }
    const sim::ActiveContacts* contacts() const override { return nullptr; }
    const sim::LiquidGrid& liquidGrid() const override { return grid_; }
    const sim::Forces& forces() const override { return forces_; }
    void bookEnergy() override { booksEnergy_ = true; }
    sim::Energies energies() const override { return {{.kinetic = toy_.speed * toy_.speed, .potential = -state_.liquid.x[0][0]}, {}}; }
    void setChanges(std::vector<sim::SettingsChange>) override {}
    std::uint64_t stateHash() const override { return static_cast<std::uint64_t>(1.0e9 * state_.liquid.x[0][0]) + 1; }

    sim::StepReport step(double until) override
    {
        wait(toy_.stepMilliseconds);
        if (++state_.step == toy_.failAtStep) throw sim::RunError("toy.yaml: step 3, pressure: the toy fell over");
        sim::StepReport report;
        report.dt = std::min(toy_.dt, until - state_.time);
        state_.time = until - state_.time <= toy_.dt ? until : state_.time + toy_.dt;
        state_.liquid.x[0][0] += toy_.speed * report.dt;
        const auto pressure = static_cast<std::size_t>(sim::Stage::Pressure);
        report.stageRan[pressure] = true;
        report.stageSeconds[pressure] = 0.001 * static_cast<double>(state_.step);
        report.pressure.iterations = static_cast<int>(state_.step);
        report.particles = 1;
        report.liquidCells = 7;
        report.energies = energies();
        if (booksEnergy_) report.energyChanges.emplace()[sim::EnergyChange::Gravity] = -0.75 * toy_.speed * report.dt;  // a quarter is missing
        report.liquidMass = 2.0;
        if (toy_.push != 0.0) {
            forces_.obstacles.resize(1);
            forces_.fabrics.resize(1);
            forces_.pins.resize(2);
            forces_.begin(report.dt);
            const sim::Impulse impulse =
                sim::Impulse::at(sim::Vec3(0.0, 3.0, 0.0), {report.dt * toy_.push * static_cast<double>(state_.step), 0.0, 0.0});
            forces_.obstacles[0].liquid = impulse;
            forces_.fabrics[0].contact = -impulse;
            forces_.pins = {impulse, 2.0 * impulse};
            forces_.balance.borne = sim::Vec3(0.5, 0.0, 0.0);
        }
        if (toy_.shutAtStep > 0) {
            state_.memory.sources.resize(1);
            state_.memory.sources[0].isShut = state_.step >= toy_.shutAtStep ? 1.0 : 0.0;
            state_.emittedVolume = {0.25 * static_cast<double>(state_.step)};
        }
        return report;
    }

 private:
    const ToySettings toy_;
    const sim::Fabric fabric_;
    const sim::LiquidGrid grid_;
    sim::Forces forces_;
    sim::State state_;
    bool booksEnergy_ = false;
};

void writePicture(const RgbPicture& picture, const std::filesystem::path& file)
{
    if (stbi_write_png(file.c_str(), picture.width, picture.height, 3, picture.rgb.data(), 3 * picture.width) == 0)
        throw std::runtime_error("cannot write " + file.string());
}

RgbPicture greyPicture(std::uint8_t grey)
{
    return {.width = kWidth, .height = kHeight, .rgb = std::vector<std::uint8_t>(3 * kWidth * kHeight, grey)};
}

std::uint8_t greyOf(const std::filesystem::path& file)
{
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(stbi_load(file.c_str(), &width, &height, &channels, 3), &stbi_image_free);
    if (!pixels || width != kWidth || height != kHeight) throw std::runtime_error("cannot read " + file.string());
    return pixels.get()[0];
}

Picture drawToy(const ToySettings& toy, const FrameSnapshot& snapshot)
{
    wait(toy.drawMilliseconds);
    if (snapshot.number == toy.failAtDrawing) throw std::runtime_error("the toy has no more colours");
    const auto number = snapshot.number;
    return [toy, number](const std::filesystem::path& file) {
        wait(toy.writeMilliseconds);
        if (number == toy.failAtWriting) throw std::runtime_error("cannot write " + file.string() + ": No space left on device");
        writePicture(greyPicture(static_cast<std::uint8_t>(number)), file);
    };
}

RgbPicture putToysSideBySide(const std::vector<Panel>& panels)
{
    RgbPicture all;
    all.width = kWidth * static_cast<int>(panels.size());
    all.height = kHeight;
    for (const auto& panel : panels) all.rgb.insert(all.rgb.end(), 3 * kWidth * kHeight, greyOf(panel.picture));
    return all;
}

/// "key: number" or "key=number"
void readLine(const std::string& line, char between, ToySettings& toy)
{
    constexpr std::string_view kSeed = "liquid.sources.0.fill.seed=";
    if (line.starts_with(kSeed)) {
        toy.speed += 0.001 * std::stod(line.substr(kSeed.size()));
        return;
    }
    const std::map<std::string, double*> doubles = {{"duration", &toy.duration}, {"every", &toy.every}, {"dt", &toy.dt}, {"speed", &toy.speed}};
    const std::map<std::string, int*> ints = {{"step_ms", &toy.stepMilliseconds}, {"fail_at_step", &toy.failAtStep}};
    const auto split = line.find(between);
    const std::string key = line.substr(0, split);
    if (split == std::string::npos || (!doubles.contains(key) && !ints.contains(key)))
        throw sim::InputError(fmt::format("toy.yaml: unknown key \"{}\"", key));
    const double value = std::stod(line.substr(split + 1));
    if (doubles.contains(key)) *doubles.at(key) = value;
    if (ints.contains(key)) *ints.at(key) = static_cast<int>(value);
}

ToySettings readToy(const SceneRequest& request)
{
    std::ifstream in(request.file);
    if (!in) throw sim::InputError(fmt::format("{}: cannot read this scene", request.file));
    ToySettings toy;
    for (std::string line; std::getline(in, line);) readLine(line, ':', toy);
    if (request.variant == "b") toy.speed = 2.0;
    if (request.variant == "paper_polypic") toy.speed = 1.5;
    for (const auto& set : request.sets) readLine(set, '=', toy);
    return toy;
}

}  // namespace

LoadedScene toySetup(const ToySettings& toy)
{
    LoadedScene setup;
    setup.scene.name = "toy";
    setup.scene.settings.time.duration = toy.duration;
    setup.scene.settings.time.dt = toy.dt;
    if (toy.push != 0.0) {
        setup.scene.obstacles.emplace_back().name = "wall";
        sim::FabricPiece& sheet = setup.scene.fabrics.emplace_back();
        sheet.name = "sheet";
        sheet.pins.resize(2);
        sheet.pins[1].name = "left";
    }
    setup.pictures.output.every = toy.every;
    setup.pictures.compare.variants = {{"a", "A", {}}, {"b", "B|2", {}}};
    setup.pictures.compare.sheet = true;
    setup.resolved = fmt::format("duration: {}\nevery: {}\ndt: {}\nspeed: {}\n", toy.duration, toy.every, toy.dt, toy.speed);
    setup.identity = setup.resolved;
    return setup;
}

Backends toyBackends(const ToySettings& toy)
{
    Backends backends;
    backends.loadScene = [toy](const SceneRequest&) { return toySetup(toy); };
    backends.startSimulation = [toy](const LoadedScene&) { return std::make_unique<ToySimulation>(toy); };
    backends.resumeSimulation = [toy](const LoadedScene&, const sim::State& state) { return std::make_unique<ToySimulation>(toy, state); };
    backends.meshObstacles = [](const LoadedScene&) { return [](double, std::vector<FrameSnapshot::Mesh>&) {}; };
    backends.startRenderer = [toy](const LoadedScene&, bool) { return [toy](FrameSnapshot& snapshot) { return drawToy(toy, snapshot); }; };
    backends.drawnBy = [] { return "toy"; };
    backends.putSideBySide = [](const std::vector<Panel>& panels, const PictureSettings&, double) { return putToysSideBySide(panels); };
    backends.writePng = writePicture;
    return backends;
}

Backends toyBackendsFromFiles()
{
    // The scene that was loaded last tells the other parts what to do.
    const auto toy = std::make_shared<ToySettings>();
    Backends backends = toyBackends({});
    backends.loadScene = [toy](const SceneRequest& request) {
        *toy = readToy(request);
        LoadedScene setup = toySetup(*toy);
        setup.request = request;
        setup.variant = request.variant.empty() ? "default" : request.variant;
        if (request.file.starts_with("scenes/")) {
            setup.scene.sources.emplace_back().fill.pattern = sim::FillSettings::Pattern::Reference;
            setup.pictures.compare.variants.clear();
            for (const PaperVariant& variant : kPaperVariants) setup.pictures.compare.variants.push_back({variant.name, variant.method, {}});
        }
        setup.label = request.variant == "b" ? "B|2" : request.variant == "a" ? "A" : "";
        return setup;
    };
    backends.startSimulation = [toy](const LoadedScene&) { return std::make_unique<ToySimulation>(*toy); };
    return backends;
}

}  // namespace app::test
