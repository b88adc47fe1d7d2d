#include "evaluation/statistics/ballot_law.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

namespace livery {

namespace {

constexpr std::size_t kGuides = 256;

}  // namespace

BallotLaw ballot_law(const std::vector<double>& worths, bool has_least) {
    BallotLaw law;
    const auto designs = static_cast<int>(worths.size());
    law.designs = designs;
    law.has_least = has_least;
    const auto worth = [&](int i) { return worths[static_cast<std::size_t>(i)]; };
    // What is left is added up, not subtracted: a worth near the sum would leave rounding alone.
    const auto sum_without = [&](int a, int b, auto&& value) {
        double sum = 0.0;
        for (int m = 0; m < designs; ++m) {
            if (m != a && m != b) sum += value(m);
        }
        return sum;
    };
    const auto inverse = [&](int i) { return 1.0 / worth(i); };
    const double all = sum_without(-1, -1, worth);
    for (int i = 0; i < designs; ++i) {
        const double others = sum_without(i, -1, worth);
        for (int j = 0; j < designs; ++j) {
            if (j == i) continue;
            const double pair = worth(i) / all * worth(j) / others;
            if (!has_least) {
                law.ballots.push_back({i, j, -1});
                law.probabilities.push_back(pair);
                continue;
            }
            const double left = sum_without(i, j, inverse);
            for (int m = 0; m < designs; ++m) {
                if (m == i || m == j) continue;
                law.ballots.push_back({i, j, m});
                law.probabilities.push_back(pair * inverse(m) / left);
            }
        }
    }
    law.cumulative.resize(law.probabilities.size());
    std::partial_sum(law.probabilities.begin(), law.probabilities.end(), law.cumulative.begin());
    for (std::size_t part = 0; part < kGuides; ++part) {
        const double at = law.cumulative.back() * static_cast<double>(part) / kGuides;
        const auto found = std::upper_bound(law.cumulative.begin(), law.cumulative.end() - 1, at);
        law.guide.push_back(static_cast<std::size_t>(found - law.cumulative.begin()));
    }
    return law;
}

std::size_t draw_ballot(const BallotLaw& law, Random& random) {
    const double share = random.uniform();
    const double at = share * law.cumulative.back();
    std::size_t ballot = law.guide[static_cast<std::size_t>(share * kGuides)];
    while (ballot + 1 < law.cumulative.size() && law.cumulative[ballot] <= at) ++ballot;
    return ballot;
}

std::vector<Ballot> draw_round(const BallotLaw& law, int evaluators, Random& random) {
    std::vector<Ballot> round;
    for (int n = 0; n < evaluators; ++n) round.push_back(law.ballots[draw_ballot(law, random)]);
    return round;
}

ExpectedVotes expected_votes(const BallotLaw& law, double evaluators) {
    const auto designs = static_cast<std::size_t>(law.designs);
    ExpectedVotes votes;
    votes.best.resize(designs);
    votes.second.resize(designs);
    if (law.has_least) votes.least.resize(designs);
    votes.pairs.resize(designs * designs);
    for (std::size_t b = 0; b < law.ballots.size(); ++b) {
        const double share = evaluators * law.probabilities[b];
        const auto best = static_cast<std::size_t>(law.ballots[b].best);
        const auto second = static_cast<std::size_t>(law.ballots[b].second);
        votes.best[best] += share;
        votes.second[second] += share;
        votes.pairs[best * designs + second] += share;
        if (law.has_least) votes.least[static_cast<std::size_t>(law.ballots[b].least)] += share;
    }
    return votes;
}

void for_draws(std::size_t count,
               std::uint64_t seed,
               std::uint32_t purpose,
               const std::function<void(Random& random, std::size_t index)>& draw) {
    constexpr std::size_t grain = 16;
    const auto first = static_cast<std::uint32_t>(seed);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t index = begin; index < end; ++index) {
            // Generators that differ in their stream alone begin alike; mixed starts do not.
            const auto own = static_cast<std::uint32_t>(index);
            const std::uint64_t start =
                (std::uint64_t{hash_3d(first, purpose, own)} << 32u) | hash_3d(own, first, purpose);
            Random random(start, purpose);
            draw(random, index);
        }
    });
}

namespace {

/// Side by side, so that one instruction adds eight of them. 1000 evaluators' 60 fit.
template <std::size_t Lanes>
struct Sums {
    std::array<std::uint16_t, Lanes> lanes{};
    Sums& operator+=(const Sums& other) {
        for (std::size_t i = 0; i < Lanes; ++i) {
            lanes[i] = static_cast<std::uint16_t>(lanes[i] + other.lanes[i]);
        }
        return *this;
    }
};

/// What each run of `length` choices adds up to.
template <std::size_t Lanes>
std::vector<Sums<Lanes>> runs(const std::vector<Sums<Lanes>>& choices, int length) {
    std::vector<Sums<Lanes>> all(1);
    for (int n = 0; n < length; ++n) {
        std::vector<Sums<Lanes>> longer;
        for (const auto& run : all) {
            for (const auto& choice : choices) {
                longer.push_back(run);
                longer.back() += choice;
            }
        }
        all = std::move(longer);
    }
    return all;
}

template <std::size_t Lanes>
void draw(const std::vector<std::vector<int>>& choices,
          int evaluators,
          std::size_t draws,
          std::uint64_t seed,
          std::uint32_t purpose,
          const std::function<void(std::size_t, const std::vector<int>&)>& told) {
    // One random number for as many evaluators as a table in the fastest memory has room for.
    constexpr std::size_t most_runs = 4096;
    std::vector<Sums<Lanes>> single(choices.size());
    for (std::size_t c = 0; c < choices.size(); ++c) {
        for (std::size_t i = 0; i < choices[c].size(); ++i) {
            single[c].lanes[i] = static_cast<std::uint16_t>(choices[c][i]);
        }
    }
    int length = 1;
    for (std::size_t count = choices.size(); count * choices.size() <= most_runs && length < 16;
         count *= choices.size()) {
        ++length;
    }
    const auto table = runs(single, length), rest = runs(single, evaluators % length);
    constexpr std::size_t batch = 1000;
    for_draws((draws + batch - 1) / batch, seed, purpose, [&](Random& random, std::size_t at) {
        std::vector<int> sums(choices.front().size());
        for (std::size_t k = at * batch; k < std::min(draws, (at + 1) * batch); ++k) {
            Sums<Lanes> round = rest[random.below(static_cast<std::uint32_t>(rest.size()))];
            for (int n = 0; n < evaluators / length; ++n) {
                round += table[random.below(static_cast<std::uint32_t>(table.size()))];
            }
            std::copy_n(round.lanes.begin(), sums.size(), sums.begin());
            told(k, sums);
        }
    });
}

}  // namespace

void draw_sums(const std::vector<std::vector<int>>& choices,
               int evaluators,
               std::size_t draws,
               std::uint64_t seed,
               std::uint32_t purpose,
               const std::function<void(std::size_t, const std::vector<int>&)>& told) {
    if (choices.front().size() <= 8) {
        draw<8>(choices, evaluators, draws, seed, purpose, told);
    } else {
        draw<32>(choices, evaluators, draws, seed, purpose, told);
    }
}

}  // namespace livery
