// Looks at a piece of the screen again and again while a test does something else.
#pragma once

#include <functional>
#include <memory>

#include "support/desktop.h"

namespace livery {

class ScreenWatch {
  public:
    /// `is_wrong` is called on the watch's thread.
    ScreenWatch(const Desktop& desktop,
                const Rectangle& area,
                std::function<bool(const Image8&)> is_wrong);
    ~ScreenWatch();
    ScreenWatch(const ScreenWatch&) = delete;
    ScreenWatch& operator=(const ScreenWatch&) = delete;

    struct Seen {
        int looks = 0;
        int wrong = 0;
        Image8 first_wrong;
    };
    /// Ends it.
    Seen stop();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
