// A closed round as its ballots' file has it: what the statistics need, and what proves it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/closed_round.h"
#include "evaluation/duel.h"
#include "evaluation/report/round_details.h"

namespace livery {

struct RoundRecord {
    ClosedRound round;
    std::string file;  ///< its name, without folders
    std::vector<int> codes;
    int codes_seed = 1;
    bool asks_least = false;
    int session = 0;
    int seats = 0;                     ///< of the session, when it was read
    std::string voting_at, locked_at;  ///< ISO 8601, UTC
    int log_entry = 0;                 ///< that locked the round
    std::string log_hash;              ///< of that entry: over it and all before it
    /// Of a round that was presented, by its log: what each sitting was really shown, repeats and
    /// what was gone back to included.
    std::vector<LookShowing> showings;
    std::optional<DuelRecord> duel;  ///< where the round is one of its repeats
};

/// As read_closed_round(), and throws as it does.
RoundRecord read_round_record(const std::filesystem::path& file,
                              std::optional<int> id,
                              std::uint64_t seed);

}  // namespace livery
