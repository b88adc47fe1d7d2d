#include "gl/window.h"

#include <array>
#include <stdexcept>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include "gl/program.h"

namespace livery {

namespace {

std::string glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

}  // namespace

WindowSystem::WindowSystem() {
#ifdef GLFW_PLATFORM  // GLFW 3.4 prefers Wayland, where no program may place its windows.
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (!glfwInit()) {
        throw std::runtime_error("no window can be opened: " + glfw_error() +
                                 ". Is DISPLAY set? Without a display every command but the "
                                 "desktop works; `livery demo` shows a whole session");
    }
}

WindowSystem::~WindowSystem() { glfwTerminate(); }

void wake_main_thread() { glfwPostEmptyEvent(); }

struct Window::State {
    GLFWwindow* window = nullptr;
    ~State() {
        if (window) glfwDestroyWindow(window);
    }
};

Window::Window(const WindowOptions& options, const Window* share)
    : state_(std::make_unique<State>()) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DECORATED, options.decorated ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "livery");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "livery");
    state_->window = glfwCreateWindow(options.size_px.x,
                                      options.size_px.y,
                                      options.title.c_str(),
                                      nullptr,
                                      share ? share->native() : nullptr);
    if (!state_->window) {
        throw std::runtime_error("no window with OpenGL 4.5: " + glfw_error());
    }
    GLFWwindow* before = glfwGetCurrentContext();
    Window::make_current();  // this one's, whoever derives from it
    read_names();
    glfwMakeContextCurrent(before);
}

Window::~Window() = default;

void Window::make_current() { glfwMakeContextCurrent(state_->window); }

void Window::release() { glfwMakeContextCurrent(nullptr); }

void Window::swap() { glfwSwapBuffers(state_->window); }

glm::ivec2 Window::size_px() const {
    glm::ivec2 size{0};
    glfwGetFramebufferSize(state_->window, &size.x, &size.y);
    return size;
}

GLFWwindow* Window::native() const { return state_->window; }

WindowBlit::~WindowBlit() {
    if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
}

void WindowBlit::black(glm::ivec2 window_px) {
    constexpr std::array<float, 4> kBlack = {0.0f, 0.0f, 0.0f, 1.0f};
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    // The scissor also cuts clears and blits.
    glDisable(GL_SCISSOR_TEST);
    // Says the window's size anew: drivers look after a resized window here.
    glViewport(0, 0, window_px.x, window_px.y);
    glClearNamedFramebufferfv(0, GL_COLOR, 0, kBlack.data());
    check_gl("clearing a window");
}

void WindowBlit::show(unsigned texture,
                      glm::ivec2 texture_px,
                      const PixelRect& target,
                      glm::ivec2 window_px) {
    black(window_px);
    if (framebuffer_ == 0) glCreateFramebuffers(1, &framebuffer_);
    // Attached anew each time: that is when another context's work on it becomes visible here.
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture, 0);
    const bool exact = texture_px == glm::ivec2(target.width, target.height);
    glBlitNamedFramebuffer(framebuffer_,
                           0,
                           0,
                           0,
                           texture_px.x,
                           texture_px.y,
                           target.x,
                           window_px.y - target.y,
                           target.x + target.width,
                           window_px.y - target.y - target.height,
                           GL_COLOR_BUFFER_BIT,
                           exact ? GL_NEAREST : GL_LINEAR);
    check_gl("copying a picture into a window");
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
}

unsigned PictureFade::between(unsigned from, unsigned to, float share, glm::ivec2 size_px) {
    if (!program_) program_ = Program::screen_pass(load_shader("projection/fade.frag"));
    if (!mixed_ || glm::ivec2(mixed_.width(), mixed_.height()) != size_px) {
        target_ = {};
        mixed_ = Texture2D(size_px.x, size_px.y, TexelFormat::rgba8);
        target_ = Framebuffer({&mixed_});
    }
    // Bound anew each time: that is when another context's work on them becomes visible here
    bind_texture(0, from);
    bind_texture(1, to);
    program_.set("share", share);
    pass_.run(program_, target_);
    return mixed_.name();
}

}  // namespace livery
