#pragma once

#include "app/frames/frame_pipeline.h"
#include "app/scene/loaded_scene.h"
#include "sim/fabric/contact/contact.h"
#include "sim/forces.h"
#include "sim/liquid/liquid_grid.h"
#include "sim/state.h"
#include "sim/step_report.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace app {

struct ViewOptions;

/// What the program needs of a simulation. The real one is in drench_backends.cpp, tests have a small one of their own.
class SimulationHandle {
 public:
    virtual ~SimulationHandle() = default;
    virtual const sim::State& state() const = 0;
    virtual const sim::Fabric& fabric() const = 0;            ///< what state().fabric is the state of
    virtual const sim::ActiveContacts* contacts() const = 0;  ///< contacts between fabric and fabric in the last step; null where there are none
    virtual const sim::LiquidGrid& liquidGrid() const = 0;    ///< fields of the last step, in state().grid
    virtual const sim::Forces& forces() const = 0;            ///< forces of the last step
    /// One time step, at most up to `until` [s]. Throws RunError.
    virtual sim::StepReport step(double until) = 0;
    virtual sim::Energies energies() const = 0;  ///< energies of the state as it is [erg]
    virtual void bookEnergy() = 0;               ///< makes reports tell from now on where energy goes
    virtual std::uint64_t stateHash() const = 0;
    virtual void setChanges(std::vector<sim::SettingsChange> changes) = 0;  ///< see sim::Simulation
};

/// Puts the triangles of every obstacle where they are at a time [s], reusing the storage.
using PlaceObstacles = std::function<void(double time, std::vector<FrameSnapshot::Mesh>&)>;

/// Pixels of a picture made of others.
struct RgbPicture {
    int width = 0, height = 0;      ///< [pixels]
    std::vector<std::uint8_t> rgb;  ///< rows from the top, 3 · width · height
};

struct Panel {
    std::filesystem::path picture;  ///< a PNG
    std::string label;
};

/// What the program is put together from.
struct Backends {
    std::function<LoadedScene(const SceneRequest&)> loadScene;                             ///< throws InputError
    std::function<std::unique_ptr<SimulationHandle>(const LoadedScene&)> startSimulation;  ///< throws InputError
    /// Starts a simulation from a state of that scene: what follows is what would have followed.
    std::function<std::unique_ptr<SimulationHandle>(const LoadedScene&, const sim::State&)> resumeSimulation;
    std::function<PlaceObstacles(const LoadedScene&)> meshObstacles;
    /// Called on the thread that will draw. Panels of a comparison have no label, time and colour bar of their own.
    std::function<DrawFrame(const LoadedScene&, bool asPanel)> startRenderer;
    /// What draws, with its version, as a run tells it. Loads it.
    std::function<std::string()> drawnBy;
    /// Pictures of one time [s], one per variant, put together into one; always of the same size for the same panels.
    std::function<RgbPicture(const std::vector<Panel>&, const PictureSettings&, double time)> putSideBySide;
    std::function<void(const RgbPicture&, const std::filesystem::path&)> writePng;  ///< whole or not at all
    /// Show a scene in a window until that is closed. Empty in a program without windows; throws RunError where there is no display.
    std::function<void(const SceneRequest&, const Backends&, const ViewOptions&)> view;
};

/// The real ones.
Backends drenchBackends();

}  // namespace app
