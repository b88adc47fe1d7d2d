#include "studio/window/preview_lag.h"

#include <algorithm>

namespace livery {

void note_asked(PreviewLag& lag, std::uint64_t number, StageView view, double now_s) {
    if (lag.view != view) lag.first_of_view = number;
    lag.view = view;
    // What was held back is a part of it
    lag.asked.push_back({number, std::min(now_s, lag.held_since.value_or(now_s))});
    lag.held_since.reset();
}

bool is_of_view(const PreviewLag& lag, std::uint64_t shown, StageView open) {
    return lag.view == open && shown >= lag.first_of_view;
}

std::optional<double> behind_since_s(PreviewLag& lag, std::uint64_t shown) {
    std::erase_if(lag.asked, [&](const auto& asked) { return asked.number <= shown; });
    return lag.asked.empty() ? lag.held_since : lag.asked.front().at_s;
}

}  // namespace livery
