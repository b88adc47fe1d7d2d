// The report of a round: everything that is said of it, as a document.
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
#include "evaluation/report/vote_charts.h"
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

/// What its ballots say; of those that name a least one only where all do.
VoteStatistics round_statistics(const ClosedRound& closed, std::uint64_t seed);

/// Of a round that is closed, with what stands beside its ballots; who it is for adds the rest.
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

}  // namespace livery
