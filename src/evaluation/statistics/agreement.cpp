#include "evaluation/statistics/agreement.h"

#include <cstddef>

namespace livery {

namespace {

/// sum over all ordered pairs of (difference)^2
double squared_differences(const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double value : values) {
        sum += value;
        squares += value * value;
    }
    return 2.0 * (static_cast<double>(values.size()) * squares - sum * sum);
}

}  // namespace

std::optional<double> krippendorff_alpha(const std::vector<std::vector<double>>& values) {
    std::vector<double> pairable;
    double observed = 0.0;
    for (const auto& unit : values) {
        if (unit.size() < 2) continue;
        observed += squared_differences(unit) / (static_cast<double>(unit.size()) - 1.0);
        pairable.insert(pairable.end(), unit.begin(), unit.end());
    }
    if (pairable.empty()) return std::nullopt;
    const double expected =
        squared_differences(pairable) / (static_cast<double>(pairable.size()) - 1.0);
    if (!(expected > 0.0)) return std::nullopt;
    return 1.0 - observed / expected;
}

std::vector<std::vector<double>> ranks_given(const std::vector<Ballot>& ballots, int designs) {
    std::vector<std::vector<double>> ranks(static_cast<std::size_t>(designs));
    for (const Ballot& ballot : ballots) {
        if (ballot.best < 0) continue;
        const double above = ballot.second < 0 ? 1.0 : 2.0;
        const double below = ballot.least < 0 ? designs : designs - 1.0;
        for (int i = 0; i < designs; ++i) {
            double rank = 0.5 * (above + 1.0 + below);
            if (i == ballot.best) rank = 1.0;
            if (i == ballot.second) rank = 2.0;
            if (i == ballot.least) rank = designs;
            ranks[static_cast<std::size_t>(i)].push_back(rank);
        }
    }
    return ranks;
}

std::vector<std::vector<double>> ranks_given(const VoteCounts& counts) {
    std::vector<std::vector<double>> ranks;
    const double k = counts.designs();
    const auto evaluators = static_cast<std::size_t>(counts.evaluators());
    for (std::size_t i = 0; i < counts.best.size(); ++i) {
        std::vector<double> given;
        given.insert(given.end(), static_cast<std::size_t>(counts.best[i]), 1.0);
        given.insert(given.end(), static_cast<std::size_t>(counts.second[i]), 2.0);
        if (counts.has_least())
            given.insert(given.end(), static_cast<std::size_t>(counts.least[i]), k);
        given.resize(evaluators, counts.has_least() ? 0.5 * (k + 2.0) : 0.5 * (k + 3.0));
        ranks.push_back(std::move(given));
    }
    return ranks;
}

}  // namespace livery
