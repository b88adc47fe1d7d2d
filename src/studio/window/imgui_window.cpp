#include "studio/window/imgui_window.h"

#include <algorithm>
#include <array>
#include <cfloat>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "studio/kit/imgui_versions.h"
#include "studio/kit/widgets.h"
#include "studio/trace.h"

namespace livery {

namespace {

InputQueue& queue_of(GLFWwindow* window) {
    return *static_cast<InputQueue*>(glfwGetWindowUserPointer(window));
}

InputEvent event_of(InputEvent::Kind kind) {
    InputEvent event;
    event.kind = kind;
    event.time_s = now_s();
    return event;
}

void on_pointer(GLFWwindow* window, double x, double y) {
    InputEvent event = event_of(InputEvent::Kind::pointer);
    event.x = x;
    event.y = y;
    queue_of(window).push(event);
}

void on_button(GLFWwindow* window, int button, int action, int modifiers) {
    InputEvent event = event_of(InputEvent::Kind::button);
    event.code = button;
    event.down = action == GLFW_PRESS;
    event.modifiers = modifiers;
    queue_of(window).push(event);
}

void on_wheel(GLFWwindow* window, double x, double y) {
    InputEvent event = event_of(InputEvent::Kind::wheel);
    event.x = x;
    event.y = y;
    queue_of(window).push(event);
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    InputEvent event = event_of(InputEvent::Kind::key);
    event.code = key;
    event.scancode = scancode;
    event.modifiers = modifiers;
    event.down = action != GLFW_RELEASE;
    event.repeated = action == GLFW_REPEAT;
    queue_of(window).push(event);
}

void on_character(GLFWwindow* window, unsigned code_point) {
    InputEvent event = event_of(InputEvent::Kind::character);
    event.code = static_cast<int>(code_point);
    queue_of(window).push(event);
}

void on_focus(GLFWwindow* window, int focused) {
    InputEvent event = event_of(InputEvent::Kind::focus);
    event.down = focused != 0;
    queue_of(window).push(event);
}

void on_enter(GLFWwindow* window, int entered) {
    if (!entered) {
        queue_of(window).push(event_of(InputEvent::Kind::leave));
        return;
    }
    // Where it left: GLFW tells of no motion then.
    double x = 0.0, y = 0.0;
    glfwGetCursorPos(window, &x, &y);
    on_pointer(window, x, y);
}

}  // namespace

struct ImGuiWindow::State {
    explicit State(Window& where) : window(where) {}

    Window& window;
    InputQueue queue;
    float scale = 0.0f;
    ImVec2 pointer{-FLT_MAX, -FLT_MAX};
    std::array<bool, 5> buttons{};
    HandedOut handed_out;

    EventUse feed(const InputEvent& event, const KeyFilter& filter) {
        ImGuiIO& io = ImGui::GetIO();
        using Kind = InputEvent::Kind;
        switch (event.kind) {
            case Kind::pointer:
                pointer = {static_cast<float>(event.x), static_cast<float>(event.y)};
                break;
            case Kind::leave:
                pointer = {-FLT_MAX, -FLT_MAX};
                break;
            case Kind::button:
                if (event.code >= 0 && event.code < static_cast<int>(buttons.size())) {
                    buttons[static_cast<std::size_t>(event.code)] = event.down;
                }
                if (!event.down) ++handed_out.clicks;
                break;
            case Kind::wheel:
                io.MouseWheelH += static_cast<float>(event.x);
                io.MouseWheel += static_cast<float>(event.y);
                ++handed_out.notches;
                break;
            case Kind::key:
                if (!event.down && !is_modifier_key(event.code)) ++handed_out.keys;
                if (const EventUse use = filter(event); use != EventUse::passed_on) return use;
                hand_in_key(
                    window.native(), event.code, event.scancode, event.down, event.modifiers);
                break;
            case Kind::character:
                io.AddInputCharacter(static_cast<unsigned>(event.code));
                break;
            case Kind::focus:
                filter(event);
                hand_in_focus(event.down);
                break;
        }
        return EventUse::passed_on;
    }
};

ImGuiWindow::ImGuiWindow(Window& window, const HandedOut& before) : state_(new State{window}) {
    state_->handed_out = before;
    GLFWwindow* native = window.native();
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    ImGui_ImplGlfw_InitForOpenGL(native, false);
    ImGui_ImplOpenGL3_Init("#version 450 core");
    begin_input();  // Space is held to compare
    glfwSetWindowUserPointer(native, &state_->queue);
    glfwSetCursorPosCallback(native, on_pointer);
    glfwSetMouseButtonCallback(native, on_button);
    glfwSetScrollCallback(native, on_wheel);
    glfwSetKeyCallback(native, on_key);
    glfwSetCharCallback(native, on_character);
    glfwSetWindowFocusCallback(native, on_focus);
    glfwSetCursorEnterCallback(native, on_enter);
}

ImGuiWindow::~ImGuiWindow() {
    GLFWwindow* native = state_->window.native();
    glfwSetCursorPosCallback(native, nullptr);
    glfwSetMouseButtonCallback(native, nullptr);
    glfwSetScrollCallback(native, nullptr);
    glfwSetKeyCallback(native, nullptr);
    glfwSetCharCallback(native, nullptr);
    glfwSetWindowFocusCallback(native, nullptr);
    glfwSetCursorEnterCallback(native, nullptr);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ImGuiWindow::use_scale(float scale) {
    if (scale == state_->scale) return;
    state_->scale = scale;
    const bool had_fonts = ImGui::GetIO().Fonts->TexID != ImTextureID{};
    apply_theme(scale);
    if (!had_fonts) return;  // the backend makes the first ones by itself, and no others
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

std::chrono::steady_clock::time_point ImGuiWindow::begin_frame(const KeyFilter& filter) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    double newest_s = 0.0;
    state_->queue.hand_out([&](const InputEvent& event) {
        newest_s = event.time_s;
        return state_->feed(event, filter);
    });
    // The backend asks what the pointer does now; we go by what was told, in its order.
    hand_in_pointer(state_->pointer);
    std::copy(state_->buttons.begin(), state_->buttons.end(), ImGui::GetIO().MouseDown);
    ImGui::NewFrame();
    return newest_s > 0.0 ? time_of(newest_s) : std::chrono::steady_clock::now();
}

void ImGuiWindow::end_frame() { ImGui::Render(); }

void ImGuiWindow::draw() {
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    state_->window.swap();
}

bool ImGuiWindow::has_input() const { return !state_->queue.empty(); }

const ImGuiWindow::HandedOut& ImGuiWindow::handed_out() const { return state_->handed_out; }

}  // namespace livery
