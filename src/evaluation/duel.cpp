#include "evaluation/duel.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "evaluation/statistics/plackett_luce.h"
#include "evaluation/statistics/verdict.h"
#include "evaluation/statistics/vote_statistics.h"

namespace livery {

namespace {

// Fitted worths of designs with the same votes differ by rounding alone.
constexpr double kSameWorth = 1e-6;

std::array<std::string, 2> leaders_of(const BallotStore& store, const Round& round) {
    std::vector<Ballot> ballots;
    bool least = round.asks_least && round.designs.size() > 2;
    for (const CastBallot& cast : store.ballots(round.id)) {
        ballots.push_back(cast.ballot);
        least = least && cast.ballot.least >= 0;
    }
    const auto counts =
        counts_of(ballots, static_cast<int>(round.designs.size()), least && !ballots.empty());
    const auto two = leading_two(counts, round.designs, &ballots);
    return {round.designs[static_cast<std::size_t>(two[0])],
            round.designs[static_cast<std::size_t>(two[1])]};
}

}  // namespace

std::array<int, 2> leading_two(const VoteCounts& counts,
                               const std::vector<std::string>& names,
                               const std::vector<Ballot>* ballots) {
    if (counts.evaluators() == 0) {
        throw Refused("nobody has voted, so no two looks lead", "vote, and lock the round first");
    }
    const LuceFit fit = fit_luce(luce_data(counts, ballots));
    const std::vector<int> order = by_worth(fit);
    const auto worths = worths_of(fit);
    const auto worth = [&](std::size_t place) {
        return worths[static_cast<std::size_t>(order[place])];
    };
    if (order.size() > 2 && worth(1) - worth(2) <= kSameWorth * worth(1)) {
        std::vector<std::string> tied;
        for (std::size_t place = 0; place < order.size(); ++place) {
            if (std::abs(worth(place) - worth(1)) <= kSameWorth * worth(1)) {
                tied.push_back(names[static_cast<std::size_t>(order[place])]);
            }
        }
        throw Refused("the second place is shared: " + listed(tied) + " have the same worth",
                      "present the looks that are to be compared as a round of their own");
    }
    return {order[0], order[1]};
}

RoundSetup next_repeat(const BallotStore& store, int id, int seed) {
    const Round round = store.round(id);
    RoundSetup setup;
    setup.presenting = true;
    setup.calibration_id = round.calibration_id;
    if (const auto series = store.series_of(id)) {
        if (series->over) {
            throw Refused("the duel of " + listed(series->designs) + " is over",
                          "begin another one from the round that it follows");
        }
        setup.designs = series->designs;
        setup.series = SeriesPlace{series->id, series->repeats, series->follows};
        setup.seed = seed + static_cast<int>(series->rounds.size());
        return setup;
    }
    const auto two = leaders_of(store, round);
    setup.designs = {two[0], two[1]};
    setup.series = SeriesPlace{0, kDuelRepeats, id};
    setup.seed = seed;
    return setup;
}

std::optional<DuelRecord> duel_of(const BallotStore& store, int round) {
    const auto series = store.series_of(round);
    if (!series) return std::nullopt;
    DuelRecord record;
    record.series = *series;
    const auto repeats = static_cast<std::size_t>(series->repeats);
    std::map<int, DuelAnswers> answers;
    for (std::size_t repeat = 0; repeat < std::min(repeats, series->rounds.size()); ++repeat) {
        auto& votes = record.votes.emplace_back();
        for (const CastBallot& cast : store.ballots(series->rounds[repeat])) {
            DuelAnswers& own = answers.try_emplace(cast.seat, repeats, -1).first->second;
            own[repeat] = cast.ballot.best;
            ++votes.at(static_cast<std::size_t>(cast.ballot.best));
        }
    }
    for (auto& [seat, own] : answers) record.answers.push_back(std::move(own));
    std::sort(record.answers.begin(), record.answers.end());
    record.statistics = duel_statistics(record.answers, series->repeats);
    record.words = words_of(record.statistics,
                            {series->designs.at(0), series->designs.at(1)},
                            static_cast<int>(series->rounds.size()));
    return record;
}

}  // namespace livery
