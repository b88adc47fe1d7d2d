// The statistics of a round, for scripts and for people.
#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

Json figures_of(const VoteStatistics& statistics, const std::vector<std::string>& names);
std::string text_of(const VoteStatistics& statistics, const std::vector<std::string>& names);

}  // namespace livery
