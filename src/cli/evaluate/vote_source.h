// Where a command takes a round of votes from: counts that are typed in, a file of ballots, or the
// sample that comes with the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/command.h"
#include "evaluation/report/round_report.h"

namespace livery {

struct VoteSourceArguments {
    std::string best, second, least, names, ballots;
    int round = 0;
    bool sample = false;
};

/// --best, --second, --least, --names, --ballots, --round and --sample.
std::vector<Option> vote_source_options(VoteSourceArguments& arguments);

struct VoteSource {
    RoundReportSource round;  ///< without details and calibration
    /// Where what is known beside the ballots may stand; empty for typed counts.
    std::filesystem::path details;
};

/// Throws std::invalid_argument for options that do not go together or counts that cannot be, and
/// as read_closed_round().
VoteSource read_vote_source(const VoteSourceArguments& arguments, std::uint64_t seed);

}  // namespace livery
