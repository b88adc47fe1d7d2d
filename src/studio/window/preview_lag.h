// Whether the preview's newest picture is of the view that is open, and how long it has been behind
// what was changed.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "studio/studio.h"

namespace livery {

struct PreviewLag {
    struct Asked {
        std::uint64_t number = 0;
        double at_s = 0.0;
    };
    std::deque<Asked> asked;           ///< not seen to be answered
    std::optional<StageView> view;     ///< of the last that was asked for
    std::uint64_t first_of_view = 0;   ///< earlier pictures are of another view
    std::optional<double> held_since;  ///< seconds: a change has not even been asked for
};

/// Longer than this behind, a picture is marked as such, seconds.
inline constexpr double kTellsLag_s = 0.5;

void note_asked(PreviewLag& lag, std::uint64_t number, StageView view, double now_s);
/// Whether a picture of that number is of the view that is open.
bool is_of_view(const PreviewLag& lag, std::uint64_t shown, StageView open);
/// Since when there is a change that the picture of that number does not show; none: it is the
/// newest.
std::optional<double> behind_since_s(PreviewLag& lag, std::uint64_t shown);

}  // namespace livery
