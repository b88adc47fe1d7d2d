#include "studio/kit/input_queue.h"

#include <set>

namespace livery {

namespace {

constexpr int kFirstKeyWithoutCharacter = 256;  // GLFW: Esc, Enter, Tab, arrows, ...
constexpr int kFirstModifierKey = 340;          // GLFW: Shift, Ctrl, Alt, Super

bool makes_no_character(int key) {
    return key >= kFirstKeyWithoutCharacter && !is_modifier_key(key);
}

/// What a frame has taken already, and whether one more event would be lost in it.
struct Portion {
    std::set<int> buttons, keys;
    bool moved = false, wheel = false, characters = false, editing_key = false;

    bool has_room_for(const InputEvent& event) const {
        using Kind = InputEvent::Kind;
        switch (event.kind) {
            case Kind::pointer:
            case Kind::leave:
                return buttons.empty() && keys.empty() && !wheel;
            case Kind::button:
                // Things that may overlap (tabs) take a press only when the pointer was over them
                // in the frame before, and what is dragged follows only while it is held: it would
                // stay short of where it is let go.
                return !buttons.contains(event.code) && keys.empty() && !wheel && !moved;
            case Kind::wheel:
                return buttons.empty();
            case Kind::key:
                // Enter, Esc or Tab may end a text field: whose the next key is shows after it.
                return !keys.contains(event.code) && buttons.empty() &&
                       !(characters && makes_no_character(event.code)) &&
                       !(editing_key && event.down);
            case Kind::character:
                return !editing_key;
            case Kind::focus:
                return true;
        }
        return true;
    }

    void add(const InputEvent& event) {
        using Kind = InputEvent::Kind;
        if (event.kind == Kind::pointer) moved = true;
        if (event.kind == Kind::button) buttons.insert(event.code);
        if (event.kind == Kind::wheel) wheel = true;
        if (event.kind == Kind::character) characters = true;
        if (event.kind == Kind::key) {
            keys.insert(event.code);
            editing_key = editing_key || (event.down && makes_no_character(event.code));
        }
    }
};

}  // namespace

bool is_modifier_key(int key) { return key >= kFirstModifierKey; }

InputEvent InputQueue::next() {
    const InputEvent event = events_.front();
    events_.pop_front();
    return event;
}

void InputQueue::drop_characters() {
    while (!events_.empty() && events_.front().kind == InputEvent::Kind::character) {
        events_.pop_front();
    }
}

void InputQueue::hand_out(const std::function<EventUse(const InputEvent&)>& feed) {
    if (frames_to_wait_ > 0) {
        --frames_to_wait_;
        return;
    }
    Portion portion;
    std::set<int> stepped;  // keys whose presses were steps
    while (!events_.empty() && portion.has_room_for(events_.front())) {
        const InputEvent event = next();
        const EventUse use = feed(event);
        const bool is_key = event.kind == InputEvent::Kind::key;
        if (use == EventUse::step) {
            stepped.insert(event.code);
            drop_characters();
        } else if (use == EventUse::command) {
            drop_characters();
            // What it opens is drawn in this frame and has the keyboard from the next one on.
            frames_to_wait_ = 1;
            return;
        } else if (!(is_key && !event.down && stepped.contains(event.code))) {
            portion.add(event);
        }
    }
}

}  // namespace livery
