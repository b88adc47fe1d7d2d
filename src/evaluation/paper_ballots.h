// Ballots on paper, taken from a file or typed in by the codes under which the looks were shown.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"

namespace livery {

struct PaperBallot {
    int paper = 0;  ///< its number; 0: the next that is free
    Ballot ballot = {};
};

inline constexpr int kMostPaper = 9999;

/// The seat of a paper: "paper 7". A second ballot of the same number replaces the first.
std::string paper_seat(int paper);
/// One above the highest number of the seats that are papers; 1 where none is.
int next_paper(const std::vector<Seat>& seats);

/// Which look of the round the code stands for.
std::optional<int> look_with_code(const Round& round, int code);
/// "481, 376 or 912"
std::string codes_in_words(const Round& round);

/// A line a ballot: the code of the best look, of the second best and, where the round asks for it
/// and the ballot names one, of the least; commas, semicolons or blanks between. A first line of
/// names (best, second, least, paper) puts the columns in another order. Empty lines and those that
/// begin with # are left out. Throws FileError with the line's number: another number of cells, no
/// such code, one look twice, a paper twice, over 1000 ballots, none.
std::vector<PaperBallot> parse_paper_ballots(const std::string& text,
                                             const std::filesystem::path& name,
                                             const Round& round);

/// Gives numbers to those that have none, from `next` on, past those that others have. Throws
/// std::invalid_argument beyond kMostPaper.
std::vector<PaperBallot> numbered(std::vector<PaperBallot> papers, int next);

/// Typing them one after the other, on a numeric keypad: what each line does, without knowing of a
/// terminal. Lines: a code; an empty one (no least); `-` takes back the last code or the last
/// ballot; `.7` goes to paper 7; `+` sums up; `*` ends. A complete ballot is kept when the next one
/// begins, or at the end: until then it can be taken back.
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
