#pragma once

#include "app/view/viewer.h"
#include "render/image.h"
#include "render/image_compare.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

// Somebody at a desktop, for tests.

namespace app::test {

inline constexpr int kWidth = 900, kHeight = 600;
inline const ViewOptions kPaused = {.width = kWidth, .height = kHeight, .paused = true};

inline SceneRequest drop()
{
    return {.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml",
            .variant = "",
            .sets = {"render.size=[900, 600]", "render.hud=false", "render.colorbar=false"}};
}

/// Four frames.
inline SceneRequest shortDrop()
{
    SceneRequest request = drop();
    request.sets.emplace_back("time.duration=0.02");
    return request;
}

inline std::uint64_t hashOfRun(const std::string& file)
{
    const LoadedScene setup = drenchBackends().loadScene({.file = file, .variant = "", .sets = {}});
    const auto run = drenchBackends().startSimulation(setup);
    for (std::int64_t frame = 1; frame <= frameCount(setup); ++frame)
        while (run->state().time < frameTime(setup, frame)) run->step(frameTime(setup, frame));
    return run->stateHash();
}

/// The right half, where there is no panel.
inline render::Image rightHalf(const render::Image& image)
{
    render::Image half(image.width / 2, image.height);
    for (int y = 0; y < image.height; ++y) std::copy_n(image.at(image.width - half.width, y), 3 * half.width, half.at(0, y));
    return half;
}

inline void doWithHands(const std::string& what) { ASSERT_EQ(std::system(("xdotool " + what).c_str()), 0) << what; }

/// A viewer in a folder of its own, where it may leave files. OpenGL must have had nothing to complain of at its end.
class Desktop {
    /// The present folder, and that of the user's own files, while it lives.
    struct Folder {
        TemporaryFolder folder;
        std::filesystem::path before = std::filesystem::current_path();
        Folder()
        {
            setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
            std::filesystem::current_path(folder.path());
        }
        ~Folder() { std::filesystem::current_path(before); }
    };
    Folder folder_;

 public:
    Desktop(const SceneRequest& request, const ViewOptions& options) : viewer(request, drenchBackends(), options) {}
    ~Desktop()
    {
        for (const std::string& complaint : viewer.takeGlMessages()) ADD_FAILURE() << complaint;
    }

    LiveStatus status() { return viewer.pair().first().status(); }
    double timeShown(int side)
    {
        const auto& shown = viewer.pair().sides().at(side)->shown;
        return shown ? shown->time : -1.0;
    }
    std::string valueOf(const std::string& setting)
    {
        const auto scene = viewer.pair().first().scene();
        return std::ranges::find(scene->parameters, setting, &sim::Parameter::path)->value;
    }
    /// Frames until it is true, for as long as any machine may take.
    template <class F>
    bool comesTrue(F&& isTrue)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(300);
        while (!isTrue()) {
            if (std::chrono::steady_clock::now() > end) return false;
            viewer.frame();
        }
        return true;
    }
    /// The frame after those in which the window has come up.
    render::Image shot()
    {
        for (int frame = 0; frame < 3; ++frame) EXPECT_TRUE(viewer.frame());
        viewer.screenshot("window.png");
        viewer.frame();
        return render::readPng("window.png");
    }
    /// There is no window manager to do it.
    void focus()
    {
        for (int frame = 0; frame < 3; ++frame) viewer.frame();
        doWithHands("search --name Drench windowfocus");
        viewer.frame();
    }
    void keys(const std::string& names)
    {
        std::istringstream in(names);
        for (std::string name; in >> name; viewer.frame()) doWithHands("key " + name);
    }
    /// Clicks into the field of a setting, types, and enters.
    void enter(const std::string& setting, const std::string& value)
    {
        for (int frame = 0; frame < 3; ++frame) viewer.frame();
        const auto place = viewer.placeOf(setting);
        ASSERT_TRUE(place) << setting << " is not to be seen";
        doWithHands("mousemove " + std::to_string(static_cast<int>((*place)[0])) + " " + std::to_string(static_cast<int>((*place)[1])));
        viewer.frame();
        doWithHands("mousedown 1");
        viewer.frame();
        doWithHands("mouseup 1");
        for (int frame = 0; frame < 3; ++frame) viewer.frame();
        doWithHands("type -- '" + value + "'");
        for (int frame = 0; frame < 3; ++frame) viewer.frame();
        keys("Return");
        viewer.frame();
    }
    /// Compared with the picture of this name in tests/app/view/golden; DRENCH_ACCEPT_GOLDENS takes it as that.
    void expectGolden(const std::string& name)
    {
        const render::Image seen = shot();
        const std::filesystem::path golden = std::filesystem::path(DRENCH_SOURCE_DIR) / "tests/app/view/golden" / (name + ".png");
        if (std::getenv("DRENCH_ACCEPT_GOLDENS")) return render::writePng(seen, golden);
        const render::Image known = render::readPng(golden);
        ASSERT_EQ(seen.width, known.width);
        ASSERT_EQ(seen.height, known.height);
        const double likeness = render::structuralSimilarity(seen, known).mean;
        EXPECT_GT(likeness, 0.97) << "drivers round edges of balls differently, and times of stages are never the same";
        if (likeness <= 0.97) render::writePng(seen, folder_.before / (name + "_seen.png"));
    }

    Viewer viewer;
};

}  // namespace app::test
