// Rounds for the tests of reports.
#pragma once

#include <string>
#include <vector>

#include "evaluation/report/round_report.h"
#include "evaluation/statistics/table3.h"

namespace livery {

/// Codes of three designs.
inline const std::vector<int> kCodes = {481, 376, 912};

inline RoundReportSource source_of(const VoteCounts& counts,
                                   const std::vector<std::string>& names,
                                   std::size_t power_rounds = 40) {
    RoundReportSource source;
    source.names = names;
    source.statistics = vote_statistics(counts, names, 1, nullptr, power_rounds);
    source.program = "livery 0.1.0";
    source.made_at = "2026-11-25T10:00:00Z";
    return source;
}

/// As many ballots as evaluators, best and second best going round the designs.
inline VoteCounts round_robin(int designs, int evaluators, bool least) {
    VoteCounts counts;
    counts.best.assign(static_cast<std::size_t>(designs), 0);
    counts.second = counts.best;
    if (least) counts.least = counts.best;
    for (int k = 0; k < evaluators; ++k) {
        const int best = k % 3 == 0 ? 0 : k % designs;
        ++counts.best[static_cast<std::size_t>(best)];
        ++counts.second[static_cast<std::size_t>((best + 1) % designs)];
        if (least) ++counts.least[static_cast<std::size_t>((best + 2) % designs)];
    }
    return counts;
}

}  // namespace livery
