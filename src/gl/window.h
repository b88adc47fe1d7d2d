// Windows with an OpenGL 4.5 core context (GLFW). Everything here belongs to the main thread,
// except make_current, release and swap, which belong to the thread that draws.
#pragma once

#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "gl/context.h"

struct GLFWwindow;

namespace livery {

/// GLFW from construction to destruction; one a program. Throws std::runtime_error that says what
/// to do when there is no display.
class WindowSystem {
  public:
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
};

/// Wakes the main thread out of its wait for events; any thread.
void wake_main_thread();

struct WindowOptions {
    std::string title = "Livery";
    glm::ivec2 size_px{1280, 800};
    bool visible = true;
    bool decorated = true;
};

/// A window, or (invisible) just its context for a thread that draws into textures. `share` may be
/// current nowhere while this one is made. Not current after construction. Throws
/// std::runtime_error (no OpenGL 4.5).
class Window : public GlContext {
  public:
    explicit Window(const WindowOptions& options, const Window* share = nullptr);
    ~Window() override;

    void make_current() override;
    void release() override;
    void swap();                 ///< shows what was drawn
    glm::ivec2 size_px() const;  ///< of the framebuffer
    GLFWwindow* native() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
