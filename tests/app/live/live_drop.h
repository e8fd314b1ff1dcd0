#pragma once

#include "app/live/live_simulation.h"
#include "app/probes/probe_reader.h"
#include "app/system/atomic_files.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <chrono>
#include <thread>

// A drop that is simulated live.

namespace app::test {

inline SceneRequest shortDrop()
{
    return {.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml", .variant = "", .sets = {"time.duration=0.02", "output.every=0.005", "time.dt=1.0e-3"}};
}

inline std::uint64_t hashOfRun(const SceneRequest& request)
{
    const LoadedScene setup = drenchBackends().loadScene(request);
    const auto run = drenchBackends().startSimulation(setup);
    for (std::int64_t frame = 1; frame <= frameCount(setup); ++frame)
        while (run->state().time < frameTime(setup, frame)) run->step(frameTime(setup, frame));
    return run->stateHash();
}

struct LiveDrop {
    LiveSimulation live;

    explicit LiveDrop(const SceneRequest& request = shortDrop()) : live(request, drenchBackends()) {}

    template <class F>
    bool comesTrue(F&& isTrue)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (!isTrue()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }
    void steps(int n)
    {
        for (int i = 0; i < n; ++i) live.stepOnce();
        live.stateHash();  // when all that was asked for is done
    }
    void change(std::vector<std::string> sets)
    {
        live.change(std::move(sets));
        live.stateHash();
    }
    std::uint64_t end()
    {
        live.play();
        EXPECT_TRUE(comesTrue([&] { return live.status().mode == LiveMode::Ended; }));
        return live.stateHash();
    }
    /// The next one: none waits while another is being made.
    std::unique_ptr<FrameSnapshot> snapshot()
    {
        std::unique_ptr<FrameSnapshot> taken;
        EXPECT_TRUE(comesTrue([&] { return (taken = live.takeSnapshot()) != nullptr; }));
        return taken;
    }
    std::string valueOf(const std::string& path) const
    {
        const auto scene = live.scene();
        const auto found = std::ranges::find(scene->parameters, path, &sim::Parameter::path);
        return found == scene->parameters.end() ? "" : found->value;
    }
    /// Its scene in a file, as somebody would send it to a machine without a display.
    std::uint64_t hashOfSaved() const
    {
        const TemporaryFolder folder;
        writeWhole(folder / "saved.yaml", live.scene()->setup.resolved);
        return hashOfRun({.file = (folder / "saved.yaml").string(), .variant = "", .sets = {}});
    }
};

}  // namespace app::test
