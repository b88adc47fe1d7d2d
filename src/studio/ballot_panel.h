// What the ballot panel remembers between frames.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"

namespace livery {

struct BallotPanelState {
    enum class Page { start, vote, thanks, result };
    Page page = Page::start;
    bool was_open = false;             ///< in the frame before
    std::vector<Round> rounds;         ///< read when the panel opens and after each change
    std::int64_t others_changes = 0;   ///< of the file, when they were read: phones vote too
    std::map<int, bool> chosen_looks;  ///< by the look's number
    std::string evaluator, thanked;
    bool focus_name = false;
    Ballot ballot;  ///< as far as it is chosen
    std::string problem;
    std::optional<int> shown_round;
    bool asking_to_close = false;
    bool to_top = false;      ///< a page that was gone to begins at its top
    int presented_phase = 0;  ///< in the frame before; 0: nothing was presented
};

/// The one that is open; null: none is.
const Round* open_round(const BallotPanelState& state);

}  // namespace livery
