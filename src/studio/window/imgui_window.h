// Dear ImGui in a window: its input, its drawing, its scale.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "gl/window.h"
#include "studio/kit/input_queue.h"

namespace livery {

/// One a program, main thread.
class ImGuiWindow {
  public:
    /// What was handed out since the start: a driver of the program (--ui-map) goes by it.
    struct HandedOut {
        int clicks = 0;   ///< buttons let go
        int notches = 0;  ///< of the wheel
        int keys = 0;     ///< let go, Shift and its like apart
    };
    /// The window's context is current and stays so. `before`: by the window that this one follows.
    ImGuiWindow(Window& window, const HandedOut& before);
    ~ImGuiWindow();
    ImGuiWindow(const ImGuiWindow&) = delete;
    ImGuiWindow& operator=(const ImGuiWindow&) = delete;

    void use_scale(float scale);  ///< between frames; cheap when it is the same

    /// Hears of keys and of focus first; Dear ImGui gets what it passes on.
    using KeyFilter = std::function<EventUse(const InputEvent& key)>;
    /// Hands the next portion of input to Dear ImGui and starts a frame. The newest input's time.
    std::chrono::steady_clock::time_point begin_frame(const KeyFilter& filter);
    void end_frame();  ///< ends the frame; nothing is drawn yet
    void draw();       ///< and swaps

    bool has_input() const;

    const HandedOut& handed_out() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
