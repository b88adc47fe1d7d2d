// Votes on looks in the window: what the ballot panel remembers between frames, and what its pages
// share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "evaluation/ballots.h"

struct ImVec2;

namespace livery {

struct Studio;

struct BallotPanelState {
    enum class Page { start, vote, thanks, result };
    Page page = Page::start;
    bool open = false;
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

void show_ballots(Studio& studio, bool shown);
/// Instead of the tabs.
void draw_ballot_panel(Studio& studio);
/// How many letters, from A, are designs' now; 0 when nobody votes in the panel.
std::size_t ballot_letters(const Studio& studio);

void read_rounds(Studio& studio);
/// What was typed or asked on another page is gone.
void go_to(BallotPanelState& state, BallotPanelState::Page page);
std::string count_of(int ballots);  ///< "1 ballot", "3 ballots"
/// Of a look; a share of it where several stand in a list.
ImVec2 ballot_thumbnail_size(float share = 1.0f);

// Drawing; only with a window.
void draw_vote(Studio& studio, const Round& round);
void draw_thanks(Studio& studio, const Round& round);

constexpr std::size_t kLetters = 26;  ///< designs beyond are numbered

/// "A", "B", ..., "Z", "27": what a design is called, and the key that chooses it.
std::string design_letter(std::size_t design);

/// Votes by design, then which look each letter and code is.
void draw_tally(const Round& round, const VoteCounts& tally);
/// As CSV; the window tells how it went.
void ask_where_to_export(Studio& studio, const Round& round, const VoteCounts& tally);

}  // namespace livery
