#include "evaluation/statistics/best_votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluation/statistics/drawn_sums.h"
#include "evaluation/statistics/tails.h"

namespace livery {

namespace {

std::int64_t squares_of(const std::vector<int>& counts) {
    std::int64_t squares = 0;
    for (const std::int64_t count : counts) squares += count * count;
    return squares;
}

/// In how many ways at most `parts` counts add up to `sum`, order aside; no more than `most` + 1.
std::int64_t partitions(int sum, int parts, std::int64_t most) {
    // Of a sum into parts of at most `parts`, which are as many.
    std::vector<std::int64_t> ways(static_cast<std::size_t>(sum) + 1, 0);
    ways[0] = 1;
    for (int part = 1; part <= parts; ++part) {
        for (int s = part; s <= sum; ++s) {
            auto& way = ways[static_cast<std::size_t>(s)];
            way = std::min(most + 1, way + ways[static_cast<std::size_t>(s - part)]);
        }
    }
    return ways.back();
}

/// Goes through the counts in falling order and adds up the probability of those with as large a
/// sum of squares.
class Outcomes {
  public:
    Outcomes(int evaluators, std::size_t designs, std::int64_t squares)
        : counts_(designs),
          squares_(squares),
          log_factorial_(static_cast<std::size_t>(evaluators) + 1) {
        for (std::size_t n = 1; n < log_factorial_.size(); ++n) {
            log_factorial_[n] = log_factorial_[n - 1] + std::log(static_cast<double>(n));
        }
        log_all_ = log_factorial_.back() - evaluators * std::log(static_cast<double>(designs));
        choose(0, evaluators, evaluators);
    }
    double probability() const { return std::min(sum_, 1.0); }

  private:
    void choose(std::size_t at, int left, int most) {
        if (at + 1 == counts_.size()) {
            counts_[at] = left;
            add();
            return;
        }
        const auto places = static_cast<int>(counts_.size() - at);
        for (int count = std::min(left, most); count * places >= left; --count) {
            counts_[at] = count;
            // The last one takes what is left, which may not be more than the one before.
            if (at + 2 == counts_.size() && left - count > count) break;
            choose(at + 1, left - count, count);
        }
    }
    void add() {
        if (squares_of(counts_) < squares_) return;
        double log_probability = log_all_;
        std::size_t alike = 0;
        log_probability += std::lgamma(static_cast<double>(counts_.size()) + 1.0);
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            log_probability -= log_factorial_[static_cast<std::size_t>(counts_[i])];
            alike = i > 0 && counts_[i] == counts_[i - 1] ? alike + 1 : 1;
            log_probability -= std::log(static_cast<double>(alike));
        }
        sum_ += std::exp(log_probability);
    }

    std::vector<int> counts_;
    std::int64_t squares_;
    std::vector<double> log_factorial_;
    double log_all_ = 0.0, sum_ = 0.0;
};

double drawn_p(const std::vector<int>& best,
               int evaluators,
               std::uint64_t seed,
               std::size_t draws) {
    const std::int64_t squares = squares_of(best);
    std::vector<std::vector<int>> choices(best.size(), std::vector<int>(best.size(), 0));
    for (std::size_t i = 0; i < best.size(); ++i) choices[i][i] = 1;
    std::vector<char> as_large(draws);
    draw_sums(choices,
              evaluators,
              draws,
              seed,
              2,
              [&](std::size_t index, const std::vector<int>& counts) {
                  as_large[index] = squares_of(counts) >= squares ? 1 : 0;
              });
    const int hits = std::accumulate(as_large.begin(), as_large.end(), 0);
    return (hits + 1.0) / (static_cast<double>(draws) + 1.0);
}

}  // namespace

BestVotesTest best_votes_test(const std::vector<int>& best,
                              std::uint64_t seed,
                              std::int64_t most_states) {
    const int evaluators = std::accumulate(best.begin(), best.end(), 0);
    const auto designs = static_cast<int>(best.size());
    BestVotesTest test;
    if (evaluators > 0) {
        const double expected = static_cast<double>(evaluators) / designs;
        test.chi_square = static_cast<double>(squares_of(best)) / expected - evaluators;
    }
    test.asymptotic_p = chi_square_tail(test.chi_square, designs - 1);
    test.cases = partitions(evaluators, designs, most_states);
    if (test.cases <= most_states) {
        test.p = Outcomes(evaluators, best.size(), squares_of(best)).probability();
        return test;
    }
    constexpr std::size_t draws = 1'000'000;
    test.method = Method::drawn;
    test.cases = static_cast<std::int64_t>(draws);
    test.p = drawn_p(best, evaluators, seed, draws);
    return test;
}

}  // namespace livery
