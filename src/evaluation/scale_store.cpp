// What the ballots keep of scales: where each seat places each look.
#include <string>

#include "core/error.h"
#include "core/time.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_rows.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/ballots.h"

namespace livery {

namespace {

/// All answers of a round, or those of one seat (0: of all); what was taken back is none.
std::vector<CastRatings> ratings_in(Database& database, const Round& round, int seat) {
    std::vector<CastRatings> ratings;
    for (const auto& row : database.run(
             "SELECT seat, design, scale, step FROM ratings WHERE session = ?1 AND round = ?2 AND "
             "(seat = ?3 OR ?3 = 0) AND step IS NOT NULL ORDER BY seat, design, scale",
             {std::int64_t{round.session}, std::int64_t{round.id}, std::int64_t{seat}})) {
        const int by = as_int(database, row[0]);
        if (ratings.empty() || ratings.back().seat != by) ratings.push_back({by, {}});
        ScaleSteps& steps =
            ratings.back()
                .steps.try_emplace(as_int(database, row[1]), round.scales.size(), std::nullopt)
                .first->second;
        steps.at(static_cast<std::size_t>(as_int(database, row[2]))) = as_int(database, row[3]);
    }
    return ratings;
}

void check_steps(const Round& round, int design, const ScaleSteps& steps) {
    const int designs = static_cast<int>(round.designs.size());
    check_argument(design >= 0 && design < designs,
                   "rate: found design " + std::to_string(design) + ", expected 0 to " +
                       std::to_string(designs - 1));
    check_argument(steps.size() == round.scales.size(),
                   "rate: found " + std::to_string(steps.size()) + " steps, expected " +
                       std::to_string(round.scales.size()) + ", one a scale of " +
                       round_name(round.id));
    for (const auto& step : steps) {
        check_argument(!step || (*step >= 1 && *step <= kScaleSteps),
                       "rate: found step " + std::to_string(step.value_or(0)) + ", expected 1 to " +
                           std::to_string(kScaleSteps));
    }
}

}  // namespace

void BallotStore::rate(int id, int seat, int design, const ScaleSteps& steps) {
    Transaction transaction(database_);
    const Round round = round_of(database_, id);
    check_argument(!round.scales.empty(),
                   "rate: found answers on scales, expected none: " + round_name(id) +
                       " does not ask for them");
    check_steps(round, design, steps);
    if (round.closed) {
        throw Refused(round_name(id) + " is closed, so the answers are too late",
                      "open a new round and answer there");
    }
    if (!ballot_of(id, seat)) {
        throw Refused("seat " + std::to_string(seat) + " has not voted in " + round_name(id),
                      "name the best looks first");
    }
    const CastRatings before = ratings_of(id, seat);
    const auto placed = before.steps.find(design);
    for (std::size_t scale = 0; scale < steps.size(); ++scale) {
        const auto present = placed == before.steps.end() ? std::nullopt : placed->second[scale];
        if (present == steps[scale]) continue;
        record(database_,
               {.what = LogEntry::What::rated,
                .session = round.session,
                .round = id,
                .seat = seat,
                .at = utc_now(),
                .best = design,
                .second = static_cast<int>(scale),
                .least = steps[scale].value_or(-1)});
    }
    transaction.commit();
}

CastRatings BallotStore::ratings_of(int id, int seat) const {
    const auto found = ratings_in(database_, round_of(database_, id), seat);
    return found.empty() ? CastRatings{seat, {}} : found.front();
}

std::vector<CastRatings> BallotStore::ratings(int id) const {
    const Round round = round_of(database_, id);
    if (!round.closed) {
        throw Refused(round_name(id) + " is open: answers told now would sway those to come",
                      "close the round, then ask for them");
    }
    return ratings_in(database_, round, 0);
}

}  // namespace livery
