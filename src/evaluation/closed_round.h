// A round whose ballots are told: for the statistics, and to be handed on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/vote_counts.h"

namespace livery {

struct ClosedRound {
    int id = 0;
    std::string created;         ///< ISO 8601, UTC
    std::string calibration_id;  ///< empty: uncorrected
    std::vector<std::string> designs;
    std::vector<RankedBallot> ballots;  ///< without who cast them, in an order of chance
    bool all_name_least = false;        ///< only then can the statistics take it into account
    std::vector<SemanticScale> scales = {};
    std::vector<ScaleAnswers> answers = {};  ///< on scales, of the same evaluator as the ballot
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
