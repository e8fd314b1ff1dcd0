#include "app/view/window.h"

#include "render/font.h"
#include "render/gl_context_glfw.h"
#include "sim/core/check.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

namespace app {

namespace {

std::string lastGlfwError()
{
    const char* reason = nullptr;
    return glfwGetError(&reason) == GLFW_NO_ERROR || reason == nullptr ? "no reason is given" : reason;
}

[[noreturn]] void failWithoutWindow()
{
    throw sim::RunError(fmt::format("no window can be opened ({}); without a display, use drench run", lastGlfwError()));
}

/// The letters of pictures [pixels], or Dear ImGui's own where they cannot be read, which is told.
void addFont(float height)
{
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    const std::filesystem::path file = render::usualFontFile();
    try {
        const render::Font isReadable(file);  // Dear ImGui would end the program
        if (fonts.AddFontFromFileTTF(file.c_str(), height) != nullptr) return;
    } catch (const std::runtime_error& error) {
        spdlog::warn("{}; panels have small letters", error.what());
    }
    ImFontConfig font;
    font.SizePixels = height;
    fonts.AddFontDefault(&font);
}

}  // namespace

Window::Window(const std::string& title, int width, int height)
{
    if (glfwInit() == GLFW_FALSE) failWithoutWindow();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);  // it tells what is wrong: see GlContext::takeGlMessages
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string reason = lastGlfwError();
        glfwTerminate();
        throw sim::RunError(fmt::format("no window with OpenGL 3.3 core can be opened ({}); use drench run", reason));
    }
    context_ = render::contextOf(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, &events_);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action != GLFW_PRESS) return;
        static_cast<Events*>(glfwGetWindowUserPointer(window))->keys.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
        std::vector<std::string>& all = static_cast<Events*>(glfwGetWindowUserPointer(window))->files;
        all.insert(all.end(), files, files + count);
    });
    panels_ = ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // nothing is left behind in the folder that the program is started in
    scalePanels();
    ImGui_ImplGlfw_InitForOpenGL(window_, true);  // it hands keys on to the callback above
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

/// Dear ImGui sees what is down when a frame begins: a key that came and went since the last frame stays down for this
/// one.
void Window::showKey(int key, bool isDown)
{
    if (key >= 0 && key < IM_ARRAYSIZE(ImGui::GetIO().KeysDown)) ImGui::GetIO().KeysDown[key] = isDown;
}

/// Makes panels as large as the monitor's owner wants everything to be.
void Window::scalePanels()
{
    float scale = 1.0f, across = 1.0f;
    glfwGetWindowContentScale(window_, &across, &scale);
    if (!(scale > 0.0f)) return;
    constexpr float kPixels = 14.0f;  // height of the font at scale 1
    addFont(std::round(kPixels * scale));
    ImGui::GetStyle().ScaleAllSizes(scale);
}

void Window::setTitle(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

Window::~Window()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext(panels_);
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::begin()
{
    for (const Key& key : events_.keys) showKey(key.code, glfwGetKey(window_, key.code) == GLFW_PRESS);
    events_ = {};
    glfwPollEvents();
    for (const Key& key : events_.keys) showKey(key.code, true);
    glfwGetFramebufferSize(window_, &width_, &height_);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    return glfwWindowShouldClose(window_) == GLFW_FALSE;
}

void Window::drawPanels()
{
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::present() { glfwSwapBuffers(window_); }

}  // namespace app
