// usage: xvfb-run -s "-screen 0 1280x1024x24" view_bench [--free] [SCENE [SECONDS]]
// Frames per second of the window, and how long it takes from an input to the picture with its effect, while the scene
// is simulated. With --free as beside a graphics card that draws for nothing, panels apart: what is left is the work of
// the window's own thread.
#include "app/view/viewer.h"

#include <GL/glcorearb.h>
#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace {

bool isFree = false;

/// Drawing commands of the renderer, those of the panels are others.
PFNGLDRAWARRAYSPROC drawArrays = nullptr;
PFNGLDRAWARRAYSINSTANCEDPROC drawArraysInstanced = nullptr;
PFNGLDRAWELEMENTSPROC drawElements = nullptr;
PFNGLBLITFRAMEBUFFERPROC blitFramebuffer = nullptr;

template <auto& real, class... Args>
void APIENTRY ifDrawn(Args... args)
{
    if (!isFree) real(args...);
}

template <auto& real, class... Args>
void* inFrontOf(void* function, void(APIENTRYP)(Args...))
{
    real = reinterpret_cast<std::remove_reference_t<decltype(real)>>(function);
    return reinterpret_cast<void*>(&ifDrawn<real, Args...>);
}

const GLubyte* APIENTRY nameOfCard(GLenum)
{
    return reinterpret_cast<const GLubyte*>("one that draws for nothing");
}

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// From when the simulation is asked for something to the end of the frame that shows it [s].
template <class IsThere>
double timeToShow(app::Viewer& viewer, IsThere&& isThere)
{
    const auto begin = Clock::now();
    do viewer.frame();
    while (!isThere() && since(begin) < 60.0);
    return since(begin);
}

double medianOf(std::vector<double> values)
{
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

}  // namespace

/// In front of that of GLFW, which is asked in turn.
extern "C" void* glfwGetProcAddress(const char* name)
{
    using Ask = void* (*)(const char*);
    static const auto ask = reinterpret_cast<Ask>(dlsym(RTLD_NEXT, "glfwGetProcAddress"));
    void* const function = ask(name);
    const std::string_view asked = name;
    if (isFree && asked == "glGetString") return reinterpret_cast<void*>(&nameOfCard);
    if (asked == "glDrawArrays") return inFrontOf<drawArrays>(function, drawArrays);
    if (asked == "glDrawArraysInstanced") return inFrontOf<drawArraysInstanced>(function, drawArraysInstanced);
    if (asked == "glDrawElements") return inFrontOf<drawElements>(function, drawElements);
    if (asked == "glBlitFramebuffer") return inFrontOf<blitFramebuffer>(function, blitFramebuffer);
    return function;
}

int main(int argc, char** argv)
{
    isFree = argc > 1 && argv[1] == std::string_view("--free");
    if (isFree) --argc, ++argv;
    const std::string scene = argc > 1 ? argv[1] : "scenes/dam_break_small.yaml";
    const double seconds = argc > 2 ? std::atof(argv[2]) : 20.0;
    app::Viewer viewer({.file = scene, .variant = "", .sets = {}}, app::drenchParts(), {.width = 1280, .height = 800});
    app::LivePair& pair = viewer.pair();
    while (!pair.sides().front()->shown || pair.first().status().step < 2) viewer.frame();

    std::vector<double> frames;
    for (const auto begin = Clock::now(); since(begin) < seconds;) {
        const auto start = Clock::now();
        viewer.frame();
        frames.push_back(since(start));
    }
    std::vector<double> pauses, changes;
    for (int repeat = 0; repeat < 5; ++repeat) {
        pair.first().pause();
        pauses.push_back(timeToShow(viewer, [&] { return pair.first().status().mode == app::LiveMode::Paused; }));
        const std::string dt = fmt::format("{}", 1.0e-4 * (repeat + 1));
        pair.first().change({"solver.pressure_tolerance=" + dt});
        changes.push_back(timeToShow(viewer, [&] {
            return pair.first().scene()->setup.scene.changes.size() == static_cast<std::size_t>(repeat + 1);
        }));
        pair.first().play();
        const auto step = pair.first().status().step;
        timeToShow(viewer, [&] { return pair.first().status().step > step + 1; });
    }
    fmt::print("{}: {} particles\n", scene, pair.sides().front()->shown->positions.size());
    fmt::print("{:.1f} frames per second while it is simulated (median {:.1f} ms, longest {:.1f} ms of {})\n",
               1.0 / medianOf(frames), 1.0e3 * medianOf(frames), 1.0e3 * *std::ranges::max_element(frames),
               frames.size());
    fmt::print("from a turn of the view to its picture: one frame\n");
    fmt::print("from pause to the picture (with the step in hand): median {:.3f} s\n", medianOf(pauses));
    fmt::print("from a changed setting to the panel, paused: median {:.3f} s\n", medianOf(changes));
}
