#include "evaluation/statistics/drawn_sums.h"

#include <algorithm>

#include "evaluation/statistics/ballot_law.h"

namespace livery {

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
