// A closed round as its ballots' file has it: what the statistics need, what proves it, and what is
// handed on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballots.h"
#include "evaluation/duel.h"
#include "evaluation/report/round_details.h"

namespace livery {

struct ClosedRound {
    Round round;
    std::string file;                        ///< of the ballots: its name, without folders
    int seats = 0;                           ///< of the session, when it was read
    std::vector<Ballot> ballots = {};        ///< without who cast them, in an order of chance
    bool all_name_least = false;             ///< only then can the statistics take it into account
    std::vector<ScaleAnswers> answers = {};  ///< on scales, of the same evaluator as the ballot
    /// Of a round that was presented, by its log: what each sitting was really shown, repeats and
    /// what was gone back to included.
    std::vector<LookShowing> showings = {};
    std::optional<DuelRecord> duel = {};  ///< where the round is one of its repeats
};

/// One round of a ballots file, the last closed one where no id is given; `seed` is the order's.
/// Throws as BallotStore does, FileError where there is no file, and Refused where no round is
/// closed.
ClosedRound read_closed_round(const std::filesystem::path& file,
                              std::optional<int> id,
                              std::uint64_t seed);

/// "best,second", with "least" where a ballot names one, then the steps on each scale of each look
/// ("red: cheap - precious", empty where there is none), and a line a ballot, as RFC 4180 quotes,
/// after lines that begin with # and say which round it is and which seed gave the order. UTF-8.
std::string ballots_csv(const ClosedRound& round, std::uint64_t seed);

}  // namespace livery
