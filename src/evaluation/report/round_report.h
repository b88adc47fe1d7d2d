// The report of a round: everything that is said of it, as a document of words, charts and tables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/closed_round.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_details.h"
#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

struct RoundReportSource {
    std::vector<std::string> names;  ///< of the designs
    VoteStatistics statistics;
    ScaleStatistics scales = {};             ///< empty where the round asks for none
    std::optional<ClosedRound> record = {};  ///< nothing: counts that were typed in
    RoundDetails details = {};
    /// Figures of the calibration that the round was shown under, as read from its folder.
    std::vector<std::pair<std::string, std::string>> calibration = {};
    std::string program;  ///< "livery 0.1.0"
    std::string made_at;  ///< ISO 8601, UTC
};

/// Of a round that is closed, what its ballots say; of those that name a least one only where all
/// do.
VoteStatistics round_statistics(const ClosedRound& closed, std::uint64_t seed);

/// The same, and what its answers on scales say; who it is for adds the rest.
RoundReportSource report_source(ClosedRound closed, std::uint64_t seed);

/// Of a round of that file, with what stands beside its ballots.
/// Throws as read_closed_round() and read_round_details().
RoundReportSource round_report_source(const std::filesystem::path& ballots,
                                      std::optional<int> round,
                                      std::uint64_t seed);

/// Reads the pictures that `details` names. Throws FileError of those.
ReportDocument round_report(const RoundReportSource& source);

/// Rows in the order of rank sums, designs lettered A, B, ... as the window does; one that is
/// called by a letter alone, "(a)", keeps it.
ChartRows chart_rows(const VoteStatistics& statistics, const std::vector<std::string>& names);

inline constexpr std::size_t kCurveRounds = 1000;

/// Rising numbers of evaluators up to where 80% are told, this round's, twice and four times as
/// many among them; none with less than two evaluators. Between those `rounds` are drawn for each.
std::vector<VoteStatistics::Power> power_curve(const VoteStatistics& statistics,
                                               std::size_t rounds = kCurveRounds);

// --- charts ---

/// How often each design was named best, second best and least.
ReportChart votes_chart(const VoteStatistics& statistics, const ChartRows& rows);
/// Rank sums, and how far apart two must be to be told apart at 5% over all pairs.
ReportChart rank_sum_chart(const VoteStatistics& statistics, const ChartRows& rows);
/// Worths as multiples of the leader's, with 95% profile-likelihood intervals.
ReportChart worths_chart(const VoteStatistics& statistics, const ChartRows& rows);
/// Odds of each design over each other one.
ReportChart pairs_chart(const VoteStatistics& statistics, const ChartRows& rows);
/// How likely each design is to be first in such a round.
ReportChart first_chart(const VoteStatistics& statistics, const ChartRows& rows);
/// How often a fresh round of so many evaluators would tell the leader from its rival, `curve` in
/// rising order of evaluators; this round's number is marked.
ReportChart power_chart(const VoteStatistics& statistics,
                        const std::vector<VoteStatistics::Power>& curve,
                        const ChartRows& rows);

// --- tables: every figure of `livery evaluate tally` ---

ReportTable votes_table(const VoteStatistics& statistics, const ChartRows& rows);
ReportTable worths_table(const VoteStatistics& statistics, const ChartRows& rows);
ReportTable tests_table(const VoteStatistics& statistics, const ChartRows& rows);
ReportTable pairs_table(const VoteStatistics& statistics, const ChartRows& rows);
ReportTable power_table(const VoteStatistics& statistics,
                        const std::vector<VoteStatistics::Power>& curve);
/// Code, name and how much of each could be shown.
ReportTable designs_table(const RoundReportSource& source, const ChartRows& rows);
/// Who saw which order when; no rows where it was not recorded.
ReportTable showings_table(const RoundReportSource& source);
/// What each seat missed of each look; rows with what is not known, too.
ReportTable seats_table(const RoundReportSource& source, const ChartRows& rows);
/// Means of each look on each scale; whether the looks differ on a scale.
ReportTable scale_means_table(const ScaleStatistics& statistics, const ChartRows& rows);
ReportTable scale_tests_table(const ScaleStatistics& statistics);
/// Each repeat's counts and, of the series, the tests.
ReportTable duel_repeats_table(const DuelRecord& duel);
ReportTable duel_tests_table(const DuelRecord& duel);
/// Which round it is, of which file, with its seeds and the hash of its log.
ReportTable record_table(const RoundReportSource& source);

/// What stands where a figure was never recorded.
inline constexpr const char* kNotRecorded = "not recorded";

/// A picture at most `widest` pixels wide, in RGB. Throws FileError: no picture, or one of
/// floating-point numbers, which says nothing of how it looks.
Image8 read_report_picture(const std::filesystem::path& file, int widest = 600);

}  // namespace livery
