// A value while one of its controls is held: the panel shows and edits it, the session gets it
// when the control is let go.
#pragma once

#include <optional>

namespace livery {

bool last_item_is_held();  ///< the control just drawn has the mouse or the text cursor

template <typename Value>
class Held {
  public:
    /// At the start of the panel: what the controls show.
    Value& start(const Value& current) {
        if (!held_) value_ = current;
        held_now_ = false;
        return value_;
    }
    /// After each control.
    void after_item() { held_now_ = held_now_ || last_item_is_held(); }
    /// At the end of the panel.
    void finish() { held_ = held_now_; }
    bool is_held() const { return held_; }
    const Value& value() const { return value_; }  ///< while it is held

  private:
    Value value_{};
    bool held_ = false, held_now_ = false;
};

}  // namespace livery
