// Typing paper ballots one after the other, on a numeric keypad: what each line does, without
// knowing of a terminal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"
#include "evaluation/paper_ballots.h"

namespace livery {

/// Lines: a code; an empty one (no least); `-` takes back the last code or the last ballot; `.7`
/// goes to paper 7; `+` sums up; `*` ends. A complete ballot is kept when the next one begins, or
/// at the end: until then it can be taken back.
class PaperTyping {
  public:
    /// Throws std::invalid_argument for a round that is not there.
    PaperTyping(BallotStore& store, int round);

    /// What is asked for now: "paper 7, best: ".
    std::string prompt() const;
    /// What is said of a line; ends with a line break, or is empty. Throws Refused when the round
    /// takes no votes any more.
    std::string take(const std::string& line);
    /// Keeps the ballot that could still be taken back, and says what was left undone.
    std::string finish();
    bool done() const { return done_; }

    struct Kept {
        int paper = 0;
        std::string receipt;
        bool replaced = false;
    };
    /// A paper that was typed twice stands here twice.
    const std::vector<Kept>& kept() const { return kept_; }
    std::string help() const;

  private:
    std::size_t places() const { return round_.asks_least ? 3 : 2; }
    std::string take_code(const std::string& text);
    std::string take_back();
    std::string go_to(const std::string& text);
    std::string summary() const;
    std::string complete();
    void keep();
    std::string words_of(const std::vector<int>& looks) const;
    bool was_typed(int paper) const;

    BallotStore& store_;
    Round round_;
    int paper_ = 1;
    std::vector<int> looks_;  ///< of the paper that is being typed
    std::optional<PaperBallot> last_;
    std::vector<Kept> kept_;
    bool done_ = false;
};

}  // namespace livery
