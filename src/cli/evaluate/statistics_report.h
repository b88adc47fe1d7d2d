// The statistics of a round, for scripts and for people.
#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "evaluation/duel.h"
#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

/// A list, of each scale what its looks and its test say.
Json figures_of(const ScaleStatistics& statistics);
std::string text_of(const ScaleStatistics& statistics, const std::vector<std::string>& names);

/// Of a series: rounds[], designs[], votes[][], majorities[], and the tests.
Json figures_of(const DuelRecord& duel);
std::string text_of(const DuelRecord& duel);

Json figures_of(const VoteStatistics& statistics, const std::vector<std::string>& names);
std::string text_of(const VoteStatistics& statistics, const std::vector<std::string>& names);

}  // namespace livery
