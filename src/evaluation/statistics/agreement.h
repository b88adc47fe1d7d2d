// How far evaluators agree when not each judged everything.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/ballot.h"

namespace livery {

/// Krippendorff's alpha for values on an interval scale. `values[u]` are those that the coders gave
/// unit u, in any order; who gave none is left out. A unit with fewer than two says nothing.
/// Nothing where no unit has two, or all values are the same. Krippendorff, Content Analysis, 2004.
std::optional<double> krippendorff_alpha(const std::vector<std::vector<double>>& values);

/// The mid-ranks that ballots give each design, [design][...]: with no second best named the others
/// share their places, a ballot without a best gives none. Ranks of complete ballots make alpha the
/// same on an interval as on an ordinal scale.
std::vector<std::vector<double>> ranks_given(const std::vector<Ballot>& ballots, int designs);
/// The same from the counts of complete ballots.
std::vector<std::vector<double>> ranks_given(const VoteCounts& counts);

}  // namespace livery
