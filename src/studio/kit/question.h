// A question before something is taken away that took time to make.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace livery {

struct Question {
    std::string what, cause;     ///< what is the matter, and what would come of going on
    std::string action;          ///< on the button that goes on
    std::function<void()> then;  ///< when it is pressed; "Cancel" and Esc do nothing
    bool to_open = true;
};

/// Draws it, if there is one, once a frame; it is gone when it is answered. No other dialog may be
/// drawn in that frame.
void draw_question(std::optional<Question>& question);

}  // namespace livery
