// Panels without a window: Dear ImGui takes its mouse from the test.
#include "app/view/look_panel.h"

#include "app/drawing/look_from_settings.h"
#include "app/frames/snapshot_from_state.h"
#include "app/live/live_simulation.h"
#include "tests/app/fake_backends.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <chrono>
#include <map>
#include <random>
#include <thread>

namespace app::test {
namespace {

PictureSettings settings()
{
    PictureSettings pictures;
    pictures.contents = {.liquid = true, .yarns = true, .cloth = true};
    pictures.render.colorBy = ColorBy::Pressure;
    pictures.render.range = {0.0, 3000.0};
    pictures.render.yarns.colorBy = FabricColorBy::Strain;
    pictures.render.yarns.range = {0.0, 0.4};
    return pictures;
}

TEST(LookPanel, BeginsAsTheSceneIsDrawn)
{
    const PictureSettings pictures = settings();
    const LookPanel panel(pictures);
    EXPECT_EQ(panel.wanted(), extrasOf(pictures.render));
    FrameSnapshot snapshot;
    snapshot.extras = panel.wanted();
    const render::Look look = panel.lookFor(snapshot), scene = lookOf(pictures, "", false);
    EXPECT_EQ(look.liquid.range, scene.liquid.range);
    EXPECT_EQ(look.overlay.colorBarTitle, scene.overlay.colorBarTitle);
    EXPECT_EQ(look.yarns.range, scene.yarns.range);
    EXPECT_EQ(look.yarns.colorBarTitle, scene.yarns.colorBarTitle);
    EXPECT_TRUE(look.yarns.byValue);
    EXPECT_FALSE(look.cloth.byValue);
}

/// A snapshot from before a change has the values of before: its bars say so.
TEST(LookPanel, BarsTellWhatTheSnapshotShows)
{
    const LookPanel panel(settings());
    FrameSnapshot snapshot;
    snapshot.extras = {.pressure = false, .yarns = FabricColorBy::Material, .cloth = FabricColorBy::Saturation};
    const render::Look look = panel.lookFor(snapshot);
    EXPECT_EQ(look.overlay.colorBarTitle, "speed [cm/s]");
    EXPECT_EQ(look.liquid.range, (std::array{0.0f, 200.0f}));
    EXPECT_FALSE(look.yarns.byValue);
    EXPECT_TRUE(look.cloth.byValue);
    EXPECT_EQ(look.cloth.colorBarTitle, "saturation");
    EXPECT_EQ(look.cloth.range, (std::array{0.0f, 1.0f}));
}

/// The surface comes with the next snapshot; until then there is something to see.
TEST(LookPanel, SurfaceIsDrawnWhereThereIsOne)
{
    PictureSettings pictures = settings();
    pictures.render.liquidStyle = LiquidStyle::Surface;
    const LookPanel panel(pictures);
    EXPECT_TRUE(panel.wanted().surface);
    FrameSnapshot snapshot;
    EXPECT_EQ(panel.lookFor(snapshot).liquid.style, render::LiquidStyle::Spheres);
    snapshot.extras.surface = true;
    EXPECT_EQ(panel.lookFor(snapshot).liquid.style, render::LiquidStyle::Surface);
}

/// A screen that is drawn nowhere, and a mouse.
class Screen {
 public:
    Screen()
    {
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(kWidth, kHeight);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    ~Screen() { ImGui::DestroyContext(context_); }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    template <class Draw>
    void clickAt(float x, float y, Draw&& draw)
    {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = ImVec2(x, y);
        frame(draw);
        io.MouseDown[0] = true;
        frame(draw);
        io.MouseDown[0] = false;
        frame(draw);
        frame(draw);
    }
    template <class Draw>
    void pointAt(float x, float y, Draw&& draw)
    {
        ImGui::GetIO().MousePos = ImVec2(x, y);
        frame(draw);
        frame(draw);
    }
    static constexpr float kWidth = 400.0f, kHeight = 800.0f;

 private:
    template <class Draw>
    void frame(Draw&& draw)
    {
        ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
        ImGui::SetNextWindowSize(ImVec2(kWidth, kHeight));
        draw();
        ImGui::Render();
    }
    ImGuiContext* context_ = ImGui::CreateContext();
};

/// Clicking here and there, everything comes up that there is to choose; every change is told, and no look is one that
/// cannot be drawn.
TEST(LookPanel, AllCanBeChosenAndEveryChangeIsTold)
{
    Screen screen;
    LookPanel panel(settings());
    std::array<bool, 7> seen{};
    std::array<bool, 4> yarns{}, styles{};
    std::array<bool, 3> liquids{};
    const auto draw = [&] {
        const SnapshotExtras before = panel.wanted();
        ImGui::Begin("Picture", nullptr, ImGuiWindowFlags_NoDecoration);
        const bool isTold = panel.draw();
        ImGui::End();
        ASSERT_EQ(isTold, !(panel.wanted() == before));
    };
    std::mt19937 random(5);
    for (int click = 0; click < 20000; ++click) {
        screen.clickAt(static_cast<float>(random() % 300), static_cast<float>(random() % 400), draw);
        const SnapshotExtras& wanted = panel.wanted();
        FrameSnapshot snapshot;
        snapshot.extras = wanted;
        const render::Look look = panel.lookFor(snapshot);
        for (const auto& range : {look.liquid.range, look.yarns.range, look.cloth.range}) ASSERT_LT(range[0], range[1]);
        ASSERT_GT(wanted.arrowTime, 0.0);
        const std::array now = {wanted.blocks,    wanted.arrows,        wanted.contacts,    !wanted.pressure,
                                look.liquid.flat, !look.liquid.isShown, !look.yarns.isShown};
        for (std::size_t i = 0; i < now.size(); ++i) seen[i] = seen[i] || now[i];
        yarns[static_cast<std::size_t>(wanted.yarns)] = true;
        styles[static_cast<std::size_t>(look.obstacles.style)] = true;
        liquids[static_cast<std::size_t>(look.liquid.style)] = true;
        ASSERT_EQ(look.liquid.style == render::LiquidStyle::Surface, wanted.surface);
    }
    EXPECT_EQ(std::ranges::count(seen, true), 7) << "blocks, arrows, contacts, speed, one colour, no liquid, no fabric";
    EXPECT_EQ(std::ranges::count(yarns, true), 4);
    EXPECT_EQ(std::ranges::count(styles, true), 4);
    EXPECT_EQ(std::ranges::count(liquids, true), 3);
}

/// Whatever has a key in a scene's file is explained as the file's declarations have it, with the unit of what the colours show.
TEST(LookPanel, SettingsAreExplainedByTheirDeclarations)
{
    Screen screen;
    LookPanel panel(settings());
    const auto draw = [&] {
        ImGui::Begin("Picture", nullptr, ImGuiWindowFlags_NoDecoration);
        panel.draw();
        ImGui::End();
    };
    std::map<std::string, sim::Parameter> explained;
    for (float y = 2.0f; y < 400.0f; y += 4.0f) {
        screen.pointAt(40.0f, y, draw);
        if (const auto& parameter = panel.explained()) explained[parameter->path] = *parameter;
    }
    // Yarns show strain, cloth its material, which has no range.
    std::vector<std::string> paths;
    for (const auto& [path, parameter] : explained) {
        paths.push_back(path);
        EXPECT_FALSE(parameter.help.empty()) << path;
    }
    EXPECT_EQ(paths, (std::vector<std::string>{"render.background", "render.cloth.color_by", "render.liquid.color_by", "render.liquid.colormap",
                                               "render.liquid.range", "render.liquid.style", "render.obstacles.style", "render.yarns.color_by",
                                               "render.yarns.colormap", "render.yarns.range"}));
    EXPECT_EQ(explained["render.liquid.range"].unit, "dyn/cm^2");
    EXPECT_EQ(explained["render.yarns.range"].unit, "");
    EXPECT_EQ(explained["render.liquid.style"].words, (std::vector<std::string>{"points", "spheres", "surface"}));
    screen.pointAt(390.0f, 790.0f, draw);
    EXPECT_FALSE(panel.explained());
}

/// From a click to a snapshot that has what was clicked, while the simulation rests.
TEST(LookPanel, WhatIsChosenComesWithTheNextSnapshot)
{
    Screen screen;
    LookPanel panel(settings());
    LiveSimulation live(SceneRequest(), toyBackends({}));
    std::mt19937 random(7);
    bool hasArrows = false, hasPressure = false;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(300);
    while (!(hasArrows && hasPressure) && std::chrono::steady_clock::now() < end) {
        for (int click = 0; click < 20; ++click)
            screen.clickAt(static_cast<float>(random() % 300), static_cast<float>(random() % 400), [&] {
                ImGui::Begin("Picture", nullptr, ImGuiWindowFlags_NoDecoration);
                if (panel.draw()) live.show(panel.wanted());
                ImGui::End();
            });
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const auto snapshot = live.takeSnapshot();
        hasArrows = hasArrows || (snapshot && snapshot->lines.size() == 2u);
        hasPressure = hasPressure || (snapshot && snapshot->extras.pressure);
    }
    EXPECT_TRUE(hasArrows);
    EXPECT_TRUE(hasPressure);
    EXPECT_EQ(live.status().step, 0);
}

}  // namespace
}  // namespace app::test
