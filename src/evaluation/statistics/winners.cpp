#include "evaluation/statistics/winners.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include <Eigen/Core>

namespace livery {

namespace {

/// The scores of place_scores() in their smallest whole numbers.
PlaceScores reduced_scores(int designs, bool has_least) {
    PlaceScores scores = place_scores(designs, has_least);
    const int unit =
        std::gcd(std::gcd(scores.best, scores.second), std::gcd(scores.least, scores.other));
    return {scores.best / unit, scores.second / unit, scores.least / unit, scores.other / unit};
}

struct Places {
    int first = 0;    ///< how many share the first place
    int largest = 0;  ///< their score
    int second = 0;   ///< the second place's score: the same where several are first
    int reach = 0;    ///< how many have that or more
};

Places places_of(const std::vector<int>& scores) {
    Places places;
    places.largest = *std::max_element(scores.begin(), scores.end());
    places.first = static_cast<int>(std::count(scores.begin(), scores.end(), places.largest));
    places.second = places.largest;
    if (places.first == 1) {
        places.second = -1;
        for (const int score : scores) {
            if (score < places.largest) places.second = std::max(places.second, score);
        }
    }
    places.reach = static_cast<int>(std::count_if(
        scores.begin(), scores.end(), [&](int score) { return score >= places.second; }));
    return places;
}

void add(WinProbabilities& wins,
         const std::vector<int>& scores,
         double probability,
         std::size_t top_a,
         std::size_t top_b) {
    const Places places = places_of(scores);
    for (std::size_t i = 0; i < scores.size(); ++i) {
        if (scores[i] == places.largest) wins.first[i] += probability / places.first;
    }
    if (scores[top_a] >= places.second && scores[top_b] >= places.second) {
        wins.top_two += probability * 2.0 / (places.reach * (places.reach - 1));
    }
}

std::vector<int> scores_of(const Ballot& ballot, int designs, const PlaceScores& places) {
    std::vector<int> scores(static_cast<std::size_t>(designs), places.other);
    scores[static_cast<std::size_t>(ballot.best)] = places.best;
    scores[static_cast<std::size_t>(ballot.second)] = places.second;
    if (ballot.least >= 0) scores[static_cast<std::size_t>(ballot.least)] = places.least;
    return scores;
}

/// Every table of sums laid out in a row, the last design's left out since all add up to a known
/// number: a ballot is then one step along the row.
void convolve(WinProbabilities& wins,
              const BallotLaw& law,
              int evaluators,
              std::size_t top_a,
              std::size_t top_b) {
    const auto designs = static_cast<std::size_t>(law.designs);
    const PlaceScores places = reduced_scores(law.designs, law.has_least);
    const std::size_t width = static_cast<std::size_t>(places.best * evaluators) + 1;
    std::vector<std::size_t> strides(designs, 0);
    std::size_t cells = 1;
    for (std::size_t i = 0; i + 1 < designs; ++i, cells *= width) strides[i] = cells;
    std::vector<std::size_t> steps;
    int total = 0;
    for (const Ballot& ballot : law.ballots) {
        const std::vector<int> scores = scores_of(ballot, law.designs, places);
        total = std::accumulate(scores.begin(), scores.end(), 0) * evaluators;
        std::size_t step = 0;
        for (std::size_t i = 0; i < designs; ++i) {
            step += static_cast<std::size_t>(scores[i]) * strides[i];
        }
        steps.push_back(step);
    }
    const std::size_t largest_step = *std::max_element(steps.begin(), steps.end());
    std::vector<double> table(cells, 0.0), next(cells, 0.0);
    table[0] = 1.0;
    std::size_t used = 1;
    for (int n = 0; n < evaluators; ++n) {
        std::fill(next.begin(), next.end(), 0.0);
        for (std::size_t b = 0; b < steps.size(); ++b) {
            // By Eigen, which adds several at a time.
            const auto length = static_cast<Eigen::Index>(used);
            Eigen::Map<Eigen::ArrayXd>(next.data() + steps[b], length) +=
                law.probabilities[b] * Eigen::Map<const Eigen::ArrayXd>(table.data(), length);
        }
        table.swap(next);
        used += largest_step;
    }
    std::vector<int> sums(designs);
    for (std::size_t at = 0; at < cells; ++at) {
        if (table[at] == 0.0) continue;
        std::size_t rest = at;
        int left = total;
        for (std::size_t i = 0; i + 1 < designs; ++i, rest /= width) {
            sums[i] = static_cast<int>(rest % width);
            left -= sums[i];
        }
        sums.back() = left;
        add(wins, sums, table[at], top_a, top_b);
    }
}

void draw(WinProbabilities& wins,
          std::size_t draws,
          int evaluators,
          int designs,
          const PlaceScores& places,
          std::size_t top_a,
          std::size_t top_b,
          std::uint64_t seed,
          std::uint32_t purpose,
          const std::function<const Ballot&(Random&)>& ballot) {
    // In batches that are added up in order: the same sums on any number of threads.
    constexpr std::size_t batch = 100;
    std::vector<WinProbabilities> parts(draws / batch, wins);
    const double share = 1.0 / static_cast<double>(draws);
    for_draws(parts.size(), seed, purpose, [&](Random& random, std::size_t index) {
        std::vector<int> sums(static_cast<std::size_t>(designs));
        for (std::size_t k = 0; k < batch; ++k) {
            std::fill(sums.begin(), sums.end(), places.other * evaluators);
            for (int n = 0; n < evaluators; ++n) {
                const Ballot& one = ballot(random);
                sums[static_cast<std::size_t>(one.best)] += places.best - places.other;
                sums[static_cast<std::size_t>(one.second)] += places.second - places.other;
                if (one.least < 0) continue;
                sums[static_cast<std::size_t>(one.least)] += places.least - places.other;
            }
            add(parts[index], sums, share, top_a, top_b);
        }
    });
    for (const WinProbabilities& part : parts) {
        for (std::size_t i = 0; i < wins.first.size(); ++i) wins.first[i] += part.first[i];
        wins.top_two += part.top_two;
    }
    wins.method = Method::drawn;
    wins.cases = static_cast<std::int64_t>(draws);
}

/// The states that the sums of a round may have, and whether they can be gone through.
bool few_enough(const BallotLaw& law,
                int evaluators,
                std::int64_t most_states,
                std::int64_t& states) {
    constexpr double most_additions = 3e9;
    const double width = reduced_scores(law.designs, law.has_least).best * evaluators + 1.0;
    double cells = 1.0;
    for (int i = 0; i + 1 < law.designs; ++i) cells *= width;
    if (cells > static_cast<double>(most_states)) return false;
    states = static_cast<std::int64_t>(cells);
    // The row in use grows as the ballots come: half of it in the mean.
    return 0.5 * cells * evaluators * static_cast<double>(law.ballots.size()) <= most_additions;
}

}  // namespace

WinProbabilities win_probabilities(const BallotLaw& law,
                                   int evaluators,
                                   int top_a,
                                   int top_b,
                                   std::uint64_t seed,
                                   std::int64_t most_states) {
    WinProbabilities wins;
    wins.first.assign(static_cast<std::size_t>(law.designs), 0.0);
    const auto a = static_cast<std::size_t>(top_a), b = static_cast<std::size_t>(top_b);
    if (few_enough(law, evaluators, most_states, wins.cases)) {
        convolve(wins, law, evaluators, a, b);
        return wins;
    }
    draw(wins,
         100'000,
         evaluators,
         law.designs,
         reduced_scores(law.designs, law.has_least),
         a,
         b,
         seed,
         3,
         [&](Random& random) -> const Ballot& { return law.ballots[draw_ballot(law, random)]; });
    return wins;
}

WinProbabilities predicted_wins(const LuceData& data, int evaluators, std::uint64_t seed) {
    constexpr std::size_t kFits = 2000, kRounds = 20;
    const auto designs = static_cast<int>(data.best.size());
    const bool has_least = !data.least.empty();
    WinProbabilities wins;
    wins.method = Method::drawn;
    wins.cases = static_cast<std::int64_t>(kFits * kRounds);
    if (evaluators == 0) {
        wins.first.assign(data.best.size(), 1.0 / designs);
        return wins;
    }
    wins.first.assign(data.best.size(), 0.0);
    // Whoever leads was the luckiest: a whole win and loss keep the worths from standing out so
    // far.
    constexpr double kWholeGhost = 1.0;
    LuceData with_ghost = data;
    with_ghost.ghost = kWholeGhost;
    const BallotLaw law = ballot_law(worths_of(fit_luce(with_ghost)), has_least);
    const PlaceScores places = reduced_scores(designs, has_least);
    std::vector<WinProbabilities> parts(kFits, wins);
    constexpr double share = 1.0 / static_cast<double>(kFits * kRounds);
    for_draws(kFits, seed, 7, [&](Random& random, std::size_t index) {
        const std::vector<Ballot> again = draw_round(law, evaluators, random);
        LuceData found = luce_data(count_ballots(again, designs, has_least), &again);
        found.ghost = kWholeGhost;
        const BallotLaw likely = ballot_law(worths_of(fit_luce(found)), has_least);
        for (std::size_t k = 0; k < kRounds; ++k) {
            std::vector<int> sums(data.best.size(), 0);
            for (const Ballot& ballot : draw_round(likely, evaluators, random)) {
                const std::vector<int> scores = scores_of(ballot, designs, places);
                for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += scores[i];
            }
            add(parts[index], sums, share, 0, 1);
        }
    });
    for (const WinProbabilities& part : parts) {
        for (std::size_t i = 0; i < wins.first.size(); ++i) wins.first[i] += part.first[i];
    }
    return wins;
}

WinProbabilities bootstrap_wins(const std::vector<Ballot>& ballots,
                                int designs,
                                bool has_least,
                                int top_a,
                                int top_b,
                                std::uint64_t seed) {
    WinProbabilities wins;
    wins.first.assign(static_cast<std::size_t>(designs), 0.0);
    const auto count = static_cast<std::uint32_t>(ballots.size());
    draw(wins,
         10'000,
         static_cast<int>(ballots.size()),
         designs,
         reduced_scores(designs, has_least),
         static_cast<std::size_t>(top_a),
         static_cast<std::size_t>(top_b),
         seed,
         4,
         [&](Random& random) -> const Ballot& { return ballots[random.below(count)]; });
    return wins;
}

}  // namespace livery
