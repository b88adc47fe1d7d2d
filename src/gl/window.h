// Windows with an OpenGL 4.5 core context (GLFW), and the last steps of a picture into one: faded
// into the one before, and the right way up. Everything here belongs to the main thread, except
// make_current, release, swap and what draws, which belong to the thread that draws.
#pragma once

#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "gl/context.h"
#include "gl/draw.h"
#include "gl/handles.h"
#include "gl/program.h"

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

/// Copies textures into the current window's framebuffer, turned over once (see gl/handles.h). One
/// per context, with it current from the first use to the end.
class WindowBlit {
  public:
    WindowBlit() = default;
    ~WindowBlit();
    WindowBlit(const WindowBlit&) = delete;
    WindowBlit& operator=(const WindowBlit&) = delete;

    /// The whole texture into `target` (rows down) of a window of `window_px`, black around it.
    /// Pixel for pixel where the sizes are equal, else filtered linearly.
    void show(unsigned texture,
              glm::ivec2 texture_px,
              const PixelRect& target,
              glm::ivec2 window_px);
    void black(glm::ivec2 window_px);

  private:
    unsigned framebuffer_ = 0;
};

/// One per context, with it current from the first use to the end.
class PictureFade {
  public:
    /// An RGBA8 texture with `share` (0 to 1) of the second picture and the rest of the first, both
    /// of that size; good until the next call.
    unsigned between(unsigned from, unsigned to, float share, glm::ivec2 size_px);

  private:
    Program program_;
    ScreenPass pass_;
    Texture2D mixed_;
    Framebuffer target_;
};

}  // namespace livery
