#include "studio/kit/imgui_versions.h"

#include <algorithm>
#include <iterator>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

namespace livery {

#if IMGUI_VERSION_NUM >= 18700

namespace {

struct Modifier {
    ImGuiKey key;
    int flag, left, right;  ///< of GLFW
};

constexpr Modifier kModifiers[] = {
    {ImGuiMod_Ctrl, GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
    {ImGuiMod_Shift, GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
    {ImGuiMod_Alt, GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
    {ImGuiMod_Super, GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER}};

}  // namespace

ImGuiID current_focus_scope() { return ImGui::GetCurrentFocusScope(); }

void begin_overlapped_item() { ImGui::SetNextItemAllowOverlap(); }
void end_overlapped_item() {}

void begin_input() { ImGui::GetIO().ConfigInputTrickleEventQueue = false; }

void hand_in_key(GLFWwindow* window, int key, int scancode, bool down, int modifiers) {
    if (key == GLFW_KEY_SPACE) return;
    ImGui_ImplGlfw_KeyCallback(window, key, scancode, down ? GLFW_PRESS : GLFW_RELEASE, modifiers);
    // The backend hands in the modifiers of now, but the event may have waited for a frame. GLFW
    // counts a modifier's own key from the next event on.
    for (const Modifier& modifier : kModifiers) {
        const bool own = key == modifier.left || key == modifier.right;
        ImGui::GetIO().AddKeyEvent(modifier.key, own ? down : (modifiers & modifier.flag) != 0);
    }
}

void hand_in_focus(bool focused) { ImGui::GetIO().AddFocusEvent(focused); }

void hand_in_pointer(const ImVec2& at) { ImGui::GetIO().AddMousePosEvent(at.x, at.y); }

void begin_keys() {}
void hold_key(ImGuiKey key, bool down) { ImGui::GetIO().AddKeyEvent(key, down); }
void hold_ctrl(bool down) { ImGui::GetIO().AddKeyEvent(ImGuiMod_Ctrl, down); }

#else

ImGuiID current_focus_scope() { return ImGui::GetFocusScope(); }

void begin_overlapped_item() {}
void end_overlapped_item() { ImGui::SetItemAllowOverlap(); }

void begin_input() { ImGui::GetIO().KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER; }

void hand_in_key(GLFWwindow* window, int key, int scancode, bool down, int modifiers) {
    ImGui_ImplGlfw_KeyCallback(window, key, scancode, down ? GLFW_PRESS : GLFW_RELEASE, modifiers);
}

void hand_in_focus(bool focused) {
    ImGuiIO& io = ImGui::GetIO();
    io.AddFocusEvent(focused);
    if (!focused) std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
}

void hand_in_pointer(const ImVec2& at) { ImGui::GetIO().MousePos = at; }

void begin_keys() {
    ImGuiIO& io = ImGui::GetIO();
    for (int key = 0; key < ImGuiKey_COUNT; ++key) io.KeyMap[key] = key;
    io.KeyMap[ImGuiKey_Space] = ImGuiKey_Enter;  // as begin_input()
}
void hold_key(ImGuiKey key, bool down) { ImGui::GetIO().KeysDown[key] = down; }
void hold_ctrl(bool down) { ImGui::GetIO().KeyCtrl = down; }

#endif

}  // namespace livery
