#include "evaluation/statistics/duel_statistics.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "evaluation/statistics/figures.h"

namespace livery {

namespace {

/// P(X >= larger) of a fair coin, on both sides.
double sign_test_p(int one, int other) {
    const int of = one + other;
    return of == 0 ? 1.0 : std::min(1.0, 2.0 * binomial_tail(std::max(one, other), of, 0.5));
}

std::string percent(double share) { return fmt::format("{:.0f}%", 100.0 * share); }

std::string evaluators_in_words(int count) {
    return fmt::format("{} evaluator{}", count, count == 1 ? "" : "s");
}

std::string share_words(const DuelStatistics& statistics) {
    const int of = statistics.majorities[0] + statistics.majorities[1];
    return fmt::format(
        "{} of {}", statistics.majorities[static_cast<std::size_t>(statistics.ahead)], of);
}

std::string consistency_words(const DuelStatistics& statistics) {
    if (statistics.complete == 0) return "";
    const bool more = statistics.consistency_p <= kSignificanceLevel;
    return fmt::format(
        " Of {} who answered every repeat {} gave the same answer each time; guessing gives {} "
        "({}): "
        "{}.",
        statistics.complete,
        statistics.consistent,
        percent(statistics.consistent_by_guessing),
        p_words(statistics.consistency_p),
        more ? "that is more than guessing explains"
             : "that is not shown to be more than guessing");
}

std::string missing_words(const DuelStatistics& statistics) {
    if (statistics.incomplete == 0) return "";
    const int left_out = statistics.incomplete - statistics.incomplete_counted;
    return fmt::format(
        " {} did not answer every repeat: {} had a majority all the same, {} left out.",
        evaluators_in_words(statistics.incomplete),
        statistics.incomplete_counted,
        left_out == 1 ? "1 is" : fmt::format("{} are", left_out));
}

}  // namespace

const char* to_string(DuelVerdictKind kind) {
    static constexpr std::array<const char*, 4> names = {
        "nobody", "too few", "no preference", "preferred"};
    return names.at(static_cast<std::size_t>(kind));
}

DuelStatistics duel_statistics(const std::vector<DuelAnswers>& answers, int repeats) {
    check_argument(repeats >= 2,
                   "repeats: found " + std::to_string(repeats) + ", expected 2 or more");
    DuelStatistics statistics;
    statistics.repeats = repeats;
    statistics.consistent_by_guessing = std::exp2(1 - repeats);
    for (const DuelAnswers& own : answers) {
        check_argument(static_cast<int>(own.size()) == repeats,
                       "answers: found " + std::to_string(own.size()) +
                           " of an evaluator, expected " + std::to_string(repeats));
        std::array<int, 2> chosen{};
        for (const int answer : own) {
            check_argument(answer >= -1 && answer <= 1,
                           "answers: found " + std::to_string(answer) + ", expected -1, 0 or 1");
            if (answer >= 0) ++chosen[static_cast<std::size_t>(answer)];
        }
        const int given = chosen[0] + chosen[1];
        if (given == 0) continue;
        ++statistics.evaluators;
        const bool has_majority = 2 * std::max(chosen[0], chosen[1]) > repeats;
        if (has_majority) ++statistics.majorities[chosen[1] > chosen[0] ? 1 : 0];
        if (given < repeats) {
            ++statistics.incomplete;
            statistics.incomplete_counted += has_majority ? 1 : 0;
            continue;
        }
        ++statistics.complete;
        statistics.consistent += std::max(chosen[0], chosen[1]) == repeats ? 1 : 0;
    }
    const auto [one, other] = statistics.majorities;
    const int counted = one + other;
    statistics.ahead = other > one ? 1 : 0;
    statistics.sign_p = sign_test_p(one, other);
    statistics.share = wilson_interval(std::max(one, other), counted);
    statistics.consistency_p = binomial_tail(
        statistics.consistent, statistics.complete, statistics.consistent_by_guessing);
    statistics.consistent_share = wilson_interval(statistics.consistent, statistics.complete);
    statistics.kind = statistics.evaluators == 0                     ? DuelVerdictKind::nobody
                      : sign_test_p(counted, 0) > kSignificanceLevel ? DuelVerdictKind::too_few
                      : statistics.sign_p > kSignificanceLevel ? DuelVerdictKind::no_preference
                                                               : DuelVerdictKind::preferred;
    return statistics;
}

std::string words_of(const DuelStatistics& statistics,
                     const std::array<std::string, 2>& names,
                     int shown) {
    const std::string& ahead = names[static_cast<std::size_t>(statistics.ahead)];
    const std::string& behind = names[static_cast<std::size_t>(1 - statistics.ahead)];
    const int counted = statistics.majorities[0] + statistics.majorities[1];
    const bool even = statistics.majorities[0] == statistics.majorities[1];
    std::string text;
    switch (statistics.kind) {
        case DuelVerdictKind::nobody:
            return fmt::format("nobody has answered in the duel of {} and {}", names[0], names[1]);
        case DuelVerdictKind::too_few:
            text = fmt::format(
                "{} with a majority {} too few to show a preference between {} and {} in a duel",
                evaluators_in_words(counted),
                counted == 1 ? "is" : "are",
                names[0],
                names[1]);
            break;
        case DuelVerdictKind::no_preference:
            text = fmt::format(
                "the duel shows no preference between {} and {}: {} ({}). It does not say that "
                "they "
                "are liked alike: {} to {} may prefer {}",
                names[0],
                names[1],
                even ? fmt::format("{} evaluators chose each most often", statistics.majorities[0])
                     : fmt::format(
                           "{} evaluators chose {} most often", share_words(statistics), ahead),
                p_words(statistics.sign_p),
                percent(statistics.share.low),
                percent(statistics.share.high),
                ahead);
            break;
        case DuelVerdictKind::preferred:
            text = fmt::format(
                "{} is preferred to {} in the duel: {} evaluators chose it most often (sign test, "
                "{}; 95% interval of their share {} to {})",
                ahead,
                behind,
                share_words(statistics),
                p_words(statistics.sign_p),
                percent(statistics.share.low),
                percent(statistics.share.high));
            break;
    }
    text += '.' + consistency_words(statistics) + missing_words(statistics);
    if (shown < statistics.repeats) {
        text += fmt::format(
            " The series was broken off after {} of {} repeats.", shown, statistics.repeats);
    }
    // As any verdict it may stand in a line of its own, without a full stop.
    text.pop_back();
    return text;
}

}  // namespace livery
