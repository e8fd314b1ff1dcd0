#pragma once

#include "render/gl_context.h"

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;
struct ImGuiContext;

namespace app {

/// A window with OpenGL and Dear ImGui.
class Window {
 public:
    /// Throws RunError where there is no display or no OpenGL 3.3 core.
    Window(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    render::GlContext& context() { return *context_; }
    /// Take the events that wait, begin the next frame of the panels. False once the window is to be closed.
    bool begin();
    void drawPanels();  ///< over what is in the window
    void present();     ///< show what was drawn
    struct Key {
        int code = 0;            ///< as GLFW numbers them: letters are their capitals
        bool isControl = false;  ///< the control key was down, too
    };
    /// Pressed since the frame before. None is lost, however short or slow the frame.
    const std::vector<Key>& keys() const { return events_.keys; }
    /// Files that were dropped on the window since then.
    const std::vector<std::string>& dropped() const { return events_.files; }
    void setTitle(const std::string& title);
    void close();                         ///< begin() says so from now on
    int width() const { return width_; }  ///< [pixels], 0 while it is iconified
    int height() const { return height_; }

 private:
    void scalePanels();
    static void showKey(int key, bool isDown);

    GLFWwindow* window_ = nullptr;
    ImGuiContext* panels_ = nullptr;
    std::unique_ptr<render::GlContext> context_;
    struct Events {
        std::vector<Key> keys;
        std::vector<std::string> files;
    };
    Events events_;  ///< events since the last frame
    int width_ = 0, height_ = 0;
};

}  // namespace app
