#include "evaluation/statistics/verdict.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluation/statistics/figures.h"
#include "evaluation/statistics/pairs.h"

namespace livery {

namespace {

// The law that the rival's p goes by is that of fitted worths: with .05 here, of two that are
// equally good one was called the winner in up to 6% of drawn rounds.
constexpr double kRivalLevel = 0.04;
// Of a figure that counts the estimate's error twice: as much as .95 and .75 of one that takes the
// fitted worths for the true ones.
constexpr double kClear = 0.85, kLeading = 2.0 / 3.0;
constexpr double kSameLogWorth = 1e-6;

}  // namespace

std::vector<int> by_worth(const LuceFit& fit) {
    std::vector<int> order(fit.log_worths.size());
    std::iota(order.begin(), order.end(), 0);
    const auto worth = [&](int i) { return fit.log_worths[static_cast<std::size_t>(i)]; };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return worth(a) > worth(b) + kSameLogWorth;
    });
    return order;
}

bool told_from_leader(const Verdict& verdict, int design) {
    if (design == verdict.leader) return false;
    const bool any = verdict.kind == VerdictKind::clear_winner ||
                     verdict.kind == VerdictKind::leading ||
                     verdict.kind == VerdictKind::cannot_tell;
    return any && std::find(verdict.not_apart.begin(), verdict.not_apart.end(), design) ==
                      verdict.not_apart.end();
}

const char* to_string(VerdictKind kind) {
    switch (kind) {
        case VerdictKind::nobody:
            return "nobody";
        case VerdictKind::one_evaluator:
            return "one evaluator";
        case VerdictKind::no_preference:
            return "no preference";
        case VerdictKind::cannot_tell:
            return "cannot tell";
        case VerdictKind::leading:
            return "leading";
        case VerdictKind::clear_winner:
            return "clear winner";
    }
    return "";
}

Verdict judge(const VoteCounts& counts,
              const LuceData& data,
              const LuceFit& fit,
              const RankSumNull& null,
              const std::function<double(int design)>& win_probability,
              std::uint64_t seed) {
    Verdict verdict;
    const int evaluators = counts.evaluators();
    if (evaluators == 0) return verdict;
    const std::vector<int> order = by_worth(fit);
    verdict.leader = order[0];
    verdict.rival = order[1];
    verdict.kind = VerdictKind::one_evaluator;
    if (evaluators == 1) return verdict;

    // Whether there is any preference at all.
    verdict.friedman_p = friedman_p(null, counts);
    verdict.too_few = smallest_p(null) > kSignificanceLevel;
    verdict.kind = VerdictKind::no_preference;
    if (verdict.friedman_p > kSignificanceLevel) return verdict;

    verdict.win_probability = win_probability(verdict.leader);

    // Whom the leader is apart from.
    double least_apart = 0.0;
    for (const int other : order) {
        if (other == verdict.leader) continue;
        const double apart = deviance(data, fit, {verdict.leader, other, 0.0});
        if (apart <= kChiSquare95) verdict.not_apart.push_back(other);
        if (other == order[1] || apart < least_apart - kSameLogWorth) {
            least_apart = apart;
            verdict.rival = other;
        }
    }
    if (verdict.not_apart.empty() && verdict.win_probability >= kClear) {
        verdict.rival_p = calibrated_pair_p(
            data, fit, counts.has_least(), evaluators, verdict.leader, verdict.rival, seed);
        if (verdict.rival_p <= kRivalLevel) {
            verdict.kind = VerdictKind::clear_winner;
            return verdict;
        }
        verdict.not_apart.push_back(verdict.rival);
    }
    if (verdict.not_apart.empty()) verdict.not_apart.push_back(verdict.rival);
    verdict.kind =
        verdict.win_probability >= kLeading ? VerdictKind::leading : VerdictKind::cannot_tell;
    return verdict;
}

}  // namespace livery
