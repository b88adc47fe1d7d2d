// What a round of votes came to, and where it goes.
#pragma once

#include <cstddef>
#include <string>

#include "evaluation/ballots.h"
#include "studio/studio.h"

namespace livery {

constexpr std::size_t kLetters = 26;  ///< designs beyond are numbered

/// "A", "B", ..., "Z", "27": what a design is called, and the key that chooses it.
std::string design_letter(std::size_t design);

/// Votes by design, then which look each letter and code is.
void draw_tally(const Round& round, const VoteCounts& tally);
/// As CSV; the window tells how it went.
void ask_where_to_export(Studio& studio, const Round& round, const VoteCounts& tally);

}  // namespace livery
