// The charts of a round of votes. Each design has a row of its own, in an order and under labels
// that are the same in all of them.
#pragma once

#include <string>
#include <vector>

#include "evaluation/report/report_document.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

struct ChartRows {
    std::vector<int> order;           ///< designs, first row first
    std::vector<std::string> labels;  ///< of each design
    std::vector<std::string> keys;    ///< of each design, a few letters
};

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

}  // namespace livery
