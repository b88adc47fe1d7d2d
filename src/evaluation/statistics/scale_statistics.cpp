#include "evaluation/statistics/scale_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "evaluation/statistics/figures.h"

namespace livery {

namespace {

constexpr int kFewestForInterval = 8;
// Streams of their own: one more scale moves no other's draws.
constexpr std::uint64_t kBootstrapStream = 1000, kPermutationStream = 2000;

/// Ranks from 1, of equal values their mean.
std::vector<double> ranks_of(const std::vector<int>& values) {
    std::vector<double> ranks;
    for (const int value : values) {
        const auto below =
            std::count_if(values.begin(), values.end(), [&](int other) { return other < value; });
        const auto same = std::count(values.begin(), values.end(), value);
        ranks.push_back(static_cast<double>(below) + 0.5 * static_cast<double>(same + 1));
    }
    return ranks;
}

/// The sum of squares of rank sums about their mean; Q is this over a constant of the ties.
double spread_of(const std::vector<double>& sums) {
    const double mean =
        std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(sums.size());
    double spread = 0.0;
    for (const double sum : sums) spread += (sum - mean) * (sum - mean);
    return spread;
}

void add_test(ScaleFigures& figures,
              std::vector<std::vector<double>> ranks,
              std::size_t designs,
              Random random,
              std::size_t draws) {
    figures.complete = static_cast<int>(ranks.size());
    if (ranks.empty()) return;
    const double middle = 0.5 * static_cast<double>(designs + 1);
    double variance = 0.0;
    std::vector<double> sums(designs, 0.0);
    for (const auto& own : ranks) {
        for (std::size_t k = 0; k < designs; ++k) {
            sums[k] += own[k];
            variance += (own[k] - middle) * (own[k] - middle);
        }
    }
    // Everybody places all looks alike: nothing can differ.
    if (!(variance > 0.0)) return;
    const double spread = spread_of(sums);
    figures.friedman_q = spread * static_cast<double>(designs - 1) / variance;
    std::size_t as_far = 1;
    for (std::size_t draw = 0; draw < draws; ++draw) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (auto& own : ranks) {
            shuffle(own, random);
            for (std::size_t k = 0; k < designs; ++k) sums[k] += own[k];
        }
        // Rank sums are halves: equal ones differ by rounding alone.
        as_far += spread_of(sums) >= spread - 1e-6 ? 1u : 0u;
    }
    figures.friedman_p = static_cast<double>(as_far) / static_cast<double>(draws + 1);
}

/// Expanded percentiles of the mean over `steps` drawn again with replacement.
Interval bootstrap_interval(const std::vector<int>& steps, Random random, std::size_t draws) {
    if (static_cast<int>(steps.size()) < kFewestForInterval) {
        return {1.0, static_cast<double>(kScaleSteps)};
    }
    std::vector<double> means;
    means.reserve(draws);
    for (std::size_t draw = 0; draw < draws; ++draw) {
        int sum = 0;
        for (std::size_t k = 0; k < steps.size(); ++k) {
            sum += steps[random.below(static_cast<std::uint32_t>(steps.size()))];
        }
        means.push_back(static_cast<double>(sum) / static_cast<double>(steps.size()));
    }
    std::sort(means.begin(), means.end());
    // Drawn means scatter less than they should, by n - 1 over n, and as a normal, not a t.
    const auto n = static_cast<double>(steps.size());
    const double z = std::sqrt(n / (n - 1.0)) * student_975(static_cast<int>(steps.size()) - 1);
    const double tail = 0.5 * std::erfc(z / std::sqrt(2.0));
    const auto last = static_cast<double>(means.size() - 1);
    const auto low = static_cast<std::size_t>(std::floor(tail * last));
    return {means[low], means[means.size() - 1 - low]};
}

std::string words_of(const ScaleFigures& figures, const std::vector<std::string>& names) {
    const std::string scale = in_words(figures.scale);
    if (figures.complete == 0) {
        return scale + ": nobody placed every look on it, so nothing is tested";
    }
    const std::string evaluators =
        fmt::format("{} evaluator{}", figures.complete, figures.complete == 1 ? "" : "s");
    if (figures.holm_p > kSignificanceLevel) {
        return fmt::format(
            "{}: the looks are not shown to differ ({} placed all of them, {} after "
            "Holm); it does not say that they are alike",
            scale,
            evaluators,
            p_words(figures.holm_p));
    }
    std::vector<std::size_t> order(names.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return figures.looks[a].mean < figures.looks[b].mean;
    });
    const std::size_t lowest = order.front(), highest = order.back();
    return fmt::format(
        "{}: the looks differ ({}, {} after Holm); {} has the lowest mean, {:.1f}, and "
        "{} the highest, {:.1f}. Which of them differ is not tested",
        scale,
        evaluators,
        p_words(figures.holm_p),
        names[lowest],
        figures.looks[lowest].mean,
        names[highest],
        figures.looks[highest].mean);
}

void check_answers(const std::vector<ScaleAnswers>& answers,
                   std::size_t designs,
                   std::size_t scales) {
    for (const ScaleAnswers& own : answers) {
        check_argument(own.size() == designs,
                       "answers: found " + std::to_string(own.size()) + " designs, expected " +
                           std::to_string(designs));
        for (const auto& steps : own) {
            check_argument(steps.size() == scales,
                           "answers: found " + std::to_string(steps.size()) + " scales, expected " +
                               std::to_string(scales));
            for (const int step : steps) {
                check_argument(step >= 0 && step <= kScaleSteps,
                               "answers: found step " + std::to_string(step) +
                                   ", expected 0 (none) to " + std::to_string(kScaleSteps));
            }
        }
    }
}

}  // namespace

std::vector<double> holm_adjusted(const std::vector<double>& p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(
        order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> adjusted(p.size());
    double largest = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const double own = static_cast<double>(p.size() - k) * p[order[k]];
        largest = std::max(largest, std::min(1.0, own));
        adjusted[order[k]] = largest;
    }
    return adjusted;
}

ScaleStatistics scale_statistics(const std::vector<ScaleAnswers>& answers,
                                 const std::vector<SemanticScale>& scales,
                                 const std::vector<std::string>& names,
                                 std::uint64_t seed,
                                 std::size_t draws) {
    const std::size_t designs = names.size();
    check_answers(answers, designs, scales.size());
    ScaleStatistics statistics;
    statistics.seed = seed;
    statistics.draws = draws;
    for (const ScaleAnswers& own : answers) {
        const bool any = std::any_of(own.begin(), own.end(), [](const auto& steps) {
            return std::any_of(steps.begin(), steps.end(), [](int step) { return step > 0; });
        });
        statistics.evaluators += any ? 1 : 0;
    }
    std::vector<double> p;
    for (std::size_t s = 0; s < scales.size(); ++s) {
        ScaleFigures& figures = statistics.scales.emplace_back();
        figures.scale = scales[s];
        for (std::size_t design = 0; design < designs; ++design) {
            std::vector<int> steps;
            for (const ScaleAnswers& own : answers) {
                if (own[design][s] > 0) steps.push_back(own[design][s]);
            }
            LookOnScale& look = figures.looks.emplace_back();
            look.answers = static_cast<int>(steps.size());
            if (steps.empty()) continue;
            look.mean = static_cast<double>(std::accumulate(steps.begin(), steps.end(), 0)) /
                        static_cast<double>(steps.size());
            look.interval = bootstrap_interval(
                steps, Random(seed, kBootstrapStream + s * designs + design), draws);
        }
        std::vector<std::vector<double>> ranks;
        for (const ScaleAnswers& own : answers) {
            std::vector<int> steps;
            for (const auto& on : own) steps.push_back(on[s]);
            const bool complete =
                std::all_of(steps.begin(), steps.end(), [](int step) { return step > 0; });
            if (complete) ranks.push_back(ranks_of(steps));
        }
        add_test(figures, std::move(ranks), designs, Random(seed, kPermutationStream + s), draws);
        p.push_back(figures.friedman_p);
    }
    const auto adjusted = holm_adjusted(p);
    for (std::size_t s = 0; s < scales.size(); ++s) {
        statistics.scales[s].holm_p = adjusted[s];
        statistics.scales[s].words = words_of(statistics.scales[s], names);
    }
    return statistics;
}

}  // namespace livery
