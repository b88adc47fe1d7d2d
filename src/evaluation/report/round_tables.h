// The tables of a round's report: every figure of `livery evaluate tally`.
#pragma once

#include "evaluation/report/round_report.h"

namespace livery {

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

}  // namespace livery
