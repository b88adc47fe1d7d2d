// What the pages of the ballot panel share.
#pragma once

#include <exception>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "studio/ballot_panel.h"
#include "studio/studio.h"

struct ImVec2;

namespace livery {

/// Runs what the store may refuse and keeps the reason for the operator.
template <typename Work>
bool attempted(BallotPanelState& state, Work&& work) {
    state.problem.clear();
    try {
        work();
        return true;
    } catch (const Refused& refused) {
        state.problem = fmt::format("{}. {}.", refused.why(), refused.fix());
    } catch (const std::exception& error) {
        state.problem = error.what();
    }
    return false;
}

void read_rounds(Studio& studio);
/// What was typed or asked on another page is gone.
void go_to(BallotPanelState& state, BallotPanelState::Page page);
std::string count_of(int ballots);  ///< "1 ballot", "3 ballots"
/// Of a look; a share of it where several stand in a list.
ImVec2 ballot_thumbnail_size(float share = 1.0f);

// Drawing; only with a window.
void draw_vote(Studio& studio, const Round& round);
void draw_thanks(Studio& studio, const Round& round);

}  // namespace livery
