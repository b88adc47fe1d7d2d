// What pointer and keyboard did since the last frame of the window, handed out in portions that a
// frame can tell apart: a click is not moved to where the pointer went afterwards, and a key that
// was pressed and let go between two frames is still pressed in one of them.
#pragma once

#include <deque>
#include <functional>

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

/// What became of an event before the window's frame sees it.
enum class EventUse {
    passed_on,  ///< the frame takes it
    command,    ///< it was a command's, which may open something that the next events are for
    step        ///< a command's that only changes the document or the view: undo, the next look
};

/// Whether a key of GLFW only changes what others mean: Shift, Ctrl, Alt, Super.
bool is_modifier_key(int key);

class InputQueue {
  public:
    void push(const InputEvent& event) { events_.push_back(event); }
    bool empty() const { return events_.empty(); }
    /// Hands the next events that one frame can take to `feed`, in their order. After a command the
    /// rest waits until what it opens is there, a frame later, but for its key's own character,
    /// which is nobody's. Any number of steps are taken in one frame, however slow frames are.
    void hand_out(const std::function<EventUse(const InputEvent&)>& feed);

  private:
    InputEvent next();
    void drop_characters();

    std::deque<InputEvent> events_;
    int frames_to_wait_ = 0;
};

}  // namespace livery
