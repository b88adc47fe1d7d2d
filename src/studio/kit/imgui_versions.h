// Where Dear ImGui 1.86 (Debian 12) and 1.90 (Debian 13) differ: two names, and how it takes input,
// as arrays that are written or, since 1.87, as events.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

struct GLFWwindow;

namespace livery {

#if IMGUI_VERSION_NUM >= 18700
inline constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeypadEnter;
inline constexpr int kMovedByTabbing = ImGuiNavMoveFlags_IsTabbing;
#else
inline constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeyPadEnter;
inline constexpr int kMovedByTabbing = ImGuiNavMoveFlags_Tabbing;
#endif

/// Of the items that are being drawn.
ImGuiID current_focus_scope();

/// Around an item on which later ones may lie and take its clicks.
void begin_overlapped_item();
void end_overlapped_item();

/// Once, after the backend's start. Enter presses items, Space does not; each frame takes all input
/// that was handed in before it.
void begin_input();
/// What GLFW reported of a key, in the order of the events.
void hand_in_key(GLFWwindow* window, int key, int scancode, bool down, int modifiers);
void hand_in_focus(bool focused);
/// After the backend's frame, which hands in where the pointer is by now.
void hand_in_pointer(const ImVec2& at);

/// Without a window: once, after the context is made; then a key is pressed or released.
void begin_keys();
void hold_key(ImGuiKey key, bool down);
void hold_ctrl(bool down);

}  // namespace livery
