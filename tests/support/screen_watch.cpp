#include "support/screen_watch.h"

#include <atomic>
#include <thread>
#include <utility>

#include "support/x_server.h"

namespace livery {

struct ScreenWatch::State {
    std::atomic<bool> ended{false};
    Seen seen;
    std::thread thread;
};

ScreenWatch::ScreenWatch(const Desktop& desktop,
                         const Rectangle& area,
                         std::function<bool(const Image8&)> is_wrong)
    : state_(std::make_unique<State>()) {
    state_->thread = std::thread(
        [state = state_.get(), display = desktop.display(), area, wrong = std::move(is_wrong)] {
            const XClient client(display);
            while (!state->ended) {
                // While monitors are rearranged the area may not be there for a moment.
                if (auto picture = client.read(area.x, area.y, area.width, area.height)) {
                    ++state->seen.looks;
                    if (wrong(*picture) && state->seen.wrong++ == 0) {
                        state->seen.first_wrong = std::move(*picture);
                    }
                }
                sleep_ms(2);
            }
        });
}

ScreenWatch::~ScreenWatch() { stop(); }

ScreenWatch::Seen ScreenWatch::stop() {
    state_->ended = true;
    if (state_->thread.joinable()) state_->thread.join();
    return state_->seen;
}

}  // namespace livery
