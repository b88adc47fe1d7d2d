#include "gl/window.h"

#include <stdexcept>

#include <GLFW/glfw3.h>

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

}  // namespace livery
