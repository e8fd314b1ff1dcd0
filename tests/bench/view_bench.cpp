// usage: xvfb-run -s "-screen 0 1280x1024x24" view_bench [--free | --count] [SCENE [SECONDS]]
// Frames per second of the window, and how long it takes from an input to the picture with its effect, while the scene
// is simulated. With --free as beside a graphics card that draws for nothing, panels apart: what is left is the work of
// the window's own thread. With --count what such a card is given to do in one frame instead.
#include "app/view/viewer.h"

#include <GL/glcorearb.h>
#include <dlfcn.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

extern "C" void* glfwGetProcAddress(const char* name);

namespace {

enum class Card { None, Free, Counted };
Card card = Card::None;

/// Drawing commands of the renderer, those of the panels are others.
PFNGLDRAWARRAYSPROC drawArrays = nullptr;
PFNGLDRAWARRAYSINSTANCEDPROC drawArraysInstanced = nullptr;
PFNGLDRAWELEMENTSPROC drawElements = nullptr;
PFNGLBLITFRAMEBUFFERPROC blitFramebuffer = nullptr;
PFNGLBUFFERDATAPROC bufferData = nullptr;

double uploaded = 0.0;  // [bytes]

void APIENTRY countAndUpload(GLenum target, GLsizeiptr size, const void* data, GLenum usage)
{
    uploaded += static_cast<double>(size);
    bufferData(target, size, data, usage);
}

template <auto& real, class... Args>
void APIENTRY ifDrawn(Args... args)
{
    if (card != Card::Free) real(args...);
}

template <auto& real, class... Args>
void* inFrontOf(void* function, void(APIENTRYP)(Args...))
{
    real = reinterpret_cast<std::remove_reference_t<decltype(real)>>(function);
    return reinterpret_cast<void*>(&ifDrawn<real, Args...>);
}

const GLubyte* APIENTRY nameOfCard(GLenum) { return reinterpret_cast<const GLubyte*>("one that draws for nothing"); }

/// Counts what shaders are called for between begin() and end().
class WorkOfCard {
 public:
    WorkOfCard() { load<PFNGLGENQUERIESPROC>("glGenQueries")(kWhat.size(), queries_.data()); }
    void begin() const
    {
        for (std::size_t i = 0; i < kWhat.size(); ++i) load<PFNGLBEGINQUERYPROC>("glBeginQuery")(kWhat[i], queries_[i]);
    }
    void end()
    {
        for (std::size_t i = 0; i < kWhat.size(); ++i) {
            load<PFNGLENDQUERYPROC>("glEndQuery")(kWhat[i]);
            GLuint64 count = 0;
            load<PFNGLGETQUERYOBJECTUI64VPROC>("glGetQueryObjectui64v")(queries_[i], GL_QUERY_RESULT, &count);
            counts_[i] = static_cast<double>(count);
        }
    }
    double vertices() const { return counts_[0]; }
    double fragments() const { return counts_[1]; }

 private:
    template <class Function>
    static Function load(const char* name)
    {
        return reinterpret_cast<Function>(glfwGetProcAddress(name));
    }
    static constexpr std::array<GLenum, 2> kWhat = {GL_VERTEX_SHADER_INVOCATIONS, GL_FRAGMENT_SHADER_INVOCATIONS};
    std::array<GLuint, 2> queries_{};
    std::array<double, 2> counts_{};
};

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

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

/// Of frames of full quality, which cards draw while the scene is simulated, too, and software only when it is paused.
void printWorkOfCard(app::Viewer& viewer, double seconds)
{
    WorkOfCard work;
    viewer.pair().first().pause();
    timeToShow(viewer, [&] { return viewer.pair().first().status().mode == app::LiveMode::Paused; });
    std::vector<double> vertices, fragments, bytes;
    for (const auto begin = Clock::now(); since(begin) < seconds;) {
        uploaded = 0.0;
        work.begin();
        viewer.frame();
        work.end();
        vertices.push_back(work.vertices());
        fragments.push_back(work.fragments());
        bytes.push_back(uploaded);
    }
    fmt::print("one frame of a card, panels included (median of {}): {:.0f} vertices, {:.0f} fragments, {:.2f} MB of vertices uploaded\n",
               vertices.size(), medianOf(vertices), medianOf(fragments), 1.0e-6 * medianOf(bytes));
}

}  // namespace

/// In front of that of GLFW, which is asked in turn.
void* glfwGetProcAddress(const char* name)
{
    using Ask = void* (*)(const char*);
    static const auto ask = reinterpret_cast<Ask>(dlsym(RTLD_NEXT, "glfwGetProcAddress"));
    void* const function = ask(name);
    const std::string_view asked = name;
    if (card != Card::None && asked == "glGetString") return reinterpret_cast<void*>(&nameOfCard);
    if (asked == "glDrawArrays") return inFrontOf<drawArrays>(function, drawArrays);
    if (asked == "glDrawArraysInstanced") return inFrontOf<drawArraysInstanced>(function, drawArraysInstanced);
    if (asked == "glDrawElements") return inFrontOf<drawElements>(function, drawElements);
    if (asked == "glBlitFramebuffer") return inFrontOf<blitFramebuffer>(function, blitFramebuffer);
    if (asked == "glBufferData") {
        bufferData = reinterpret_cast<PFNGLBUFFERDATAPROC>(function);
        return reinterpret_cast<void*>(&countAndUpload);
    }
    return function;
}

int main(int argc, char** argv)
{
    const std::string_view first = argc > 1 ? argv[1] : "";
    card = first == "--free" ? Card::Free : first == "--count" ? Card::Counted : Card::None;
    if (card != Card::None) --argc, ++argv;
    const std::string scene = argc > 1 ? argv[1] : "scenes/dam_break_small.yaml";
    const double seconds = argc > 2 ? std::atof(argv[2]) : 20.0;
    app::Viewer viewer({.file = scene, .variant = "", .sets = {}}, app::drenchBackends(), {.width = 1280, .height = 800});
    app::LivePair& pair = viewer.pair();
    while (!pair.sides().front()->shown || pair.first().status().step < 2) viewer.frame();
    if (card == Card::Counted) {
        fmt::print("{}: {} particles\n", scene, pair.sides().front()->shown->positions.size());
        printWorkOfCard(viewer, seconds);
        return 0;
    }

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
        changes.push_back(
            timeToShow(viewer, [&] { return pair.first().scene()->setup.scene.changes.size() == static_cast<std::size_t>(repeat + 1); }));
        pair.first().play();
        const auto step = pair.first().status().step;
        timeToShow(viewer, [&] { return pair.first().status().step > step + 1; });
    }
    fmt::print("{}: {} particles\n", scene, pair.sides().front()->shown->positions.size());
    fmt::print("{:.1f} frames per second while it is simulated (median {:.1f} ms, longest {:.1f} ms of {})\n", 1.0 / medianOf(frames),
               1.0e3 * medianOf(frames), 1.0e3 * *std::ranges::max_element(frames), frames.size());
    fmt::print("from a turn of the view to its picture: one frame\n");
    fmt::print("from pause to the picture (with the step in hand): median {:.3f} s\n", medianOf(pauses));
    fmt::print("from a changed setting to the panel, paused: median {:.3f} s\n", medianOf(changes));
}
