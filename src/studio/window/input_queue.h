// What pointer and keyboard did since the last frame of the window, handed out in portions that a
// frame can tell apart: a click is not moved to where the pointer went afterwards, and a key that
// was pressed and let go between two frames is still pressed in one of them.
#pragma once

#include <deque>
#include <vector>

namespace livery {

struct InputEvent {
    enum class Kind { pointer, button, wheel, key, character, focus, leave };
    Kind kind = Kind::pointer;
    double time_s = 0.0;              ///< steady clock
    double x = 0.0, y = 0.0;          ///< pointer: pixels; wheel: notches
    int code = 0;                     ///< button, key or code point
    int scancode = 0, modifiers = 0;  ///< of a key or button
    bool down = false;                ///< button, key; focus: gained
    bool repeated = false;            ///< a held key
};

/// Whether a key of GLFW only changes what others mean: Shift, Ctrl, Alt, Super.
bool is_modifier_key(int key);

class InputQueue {
  public:
    void push(const InputEvent& event) { events_.push_back(event); }
    bool empty() const { return events_.empty(); }
    /// The next events that one frame can take.
    std::vector<InputEvent> take();

  private:
    std::deque<InputEvent> events_;
};

}  // namespace livery
