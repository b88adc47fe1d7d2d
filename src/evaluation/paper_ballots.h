// Ballots on paper, typed in by the codes under which the looks were shown.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"

namespace livery {

struct PaperBallot {
    int paper = 0;  ///< its number; 0: the next that is free
    Choices choices = {};
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
std::vector<Ballot> numbered_ballots(std::vector<PaperBallot> papers, int next);

}  // namespace livery
