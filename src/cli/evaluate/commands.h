// `livery evaluate`: its commands, and what they share: lists as they take them, where a round of
// votes comes from, its statistics for scripts and for people, and lines that are typed meanwhile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "core/json.h"
#include "evaluation/report/round_report.h"

namespace livery {

Command evaluate_export_command();
Command evaluate_order_command();
Command evaluate_report_command();
Command evaluate_tally_command();
Command evaluate_vote_command();

/// "1,6,1,2". Throws std::invalid_argument that names the option, what was found and expected.
std::vector<int> parse_counts(const std::string& option, const std::string& text);

/// "red,silver": none empty, none twice. Throws std::invalid_argument.
std::vector<std::string> parse_names(const std::string& option, const std::string& text);

/// The names that --names gave, or "(a)", "(b)", ... where it was not given. Throws
/// std::invalid_argument for another number of them.
std::vector<std::string> names_or_letters(const std::string& text, int designs);

/// What --round says; nothing where it was not given. Throws std::invalid_argument below 0.
std::optional<int> round_option(int round);

/// check_counts() of what --best, --second and --least gave, by those names.
void check_typed_counts(const VoteCounts& counts);

/// Lines of the standard input.
class TypedLines {
  public:
    /// The next line, without its end; nothing when none came within half a second. After the end
    /// of the input what was left without a line break is a line too, then there are none.
    std::optional<std::string> next();
    /// Nothing is left, and nothing will come.
    bool at_end() const { return at_end_ && waiting_.empty(); }

  private:
    std::string waiting_;
    bool at_end_ = false;
};

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

/// A list, of each scale what its looks and its test say.
Json figures_of(const ScaleStatistics& statistics);

/// Of a series: rounds[], designs[], votes[][], majorities[], and the tests.
Json figures_of(const DuelRecord& duel);
std::string text_of(const DuelRecord& duel);

Json figures_of(const VoteStatistics& statistics, const std::vector<std::string>& names);

/// The report's tables, the scales and the duel among them, and the verdict.
std::string text_of(const RoundReportSource& source);

}  // namespace livery
