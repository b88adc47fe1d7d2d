// What the ballots keep of series: blind repeats of one question by the same audience.
#include "core/error.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_rows.h"
#include "evaluation/ballots.h"

namespace livery {

namespace {

const char* const kSeriesColumns = "SELECT series, repeats, coalesce(follows, 0) FROM series ";

/// Rounds of the series that were voted on and are locked.
std::vector<int> rounds_held(Database& database, int series) {
    std::vector<int> held;
    for (const auto& row : database.run(
             "SELECT rounds.id FROM rounds JOIN series ON series.round = rounds.id WHERE "
             "series.series = ?1 AND voting IS NOT NULL AND closed IS NOT NULL ORDER BY rounds.id",
             {std::int64_t{series}})) {
        held.push_back(as_int(database, row[0]));
    }
    return held;
}

/// Another round, or another audience, has come since: nobody goes on with it.
bool was_left(Database& database, int series, int session) {
    const auto later = database.run(
        "SELECT count(*) FROM rounds WHERE id > ?1 AND id NOT IN "
        "(SELECT round FROM series WHERE series = ?1)",
        {std::int64_t{series}});
    return as_int(database, later[0][0]) > 0 || newest_session(database) != session;
}

}  // namespace

std::optional<Series> BallotStore::series_of(int round) const {
    const auto rows =
        database_.run(std::string(kSeriesColumns) + "WHERE round = ?1", {std::int64_t{round}});
    if (rows.empty()) return std::nullopt;
    Series series;
    series.id = as_int(database_, rows[0][0]);
    series.repeats = as_int(database_, rows[0][1]);
    series.follows = as_int(database_, rows[0][2]);
    const Round first = round_of(database_, series.id);
    series.session = first.session;
    series.designs = first.designs;
    series.rounds = rounds_held(database_, series.id);
    series.over = static_cast<int>(series.rounds.size()) >= series.repeats ||
                  was_left(database_, series.id, series.session);
    return series;
}

std::optional<Series> BallotStore::series_under_way() const {
    const auto rows = database_.run("SELECT max(round) FROM series");
    if (rows.empty() || std::holds_alternative<std::monostate>(rows[0][0])) return std::nullopt;
    auto series = series_of(as_int(database_, rows[0][0]));
    if (!series || series->over) return std::nullopt;
    return series;
}

void BallotStore::check_series(const RoundSetup& setup, int session) const {
    const SeriesPlace& place = *setup.series;
    check_argument(place.repeats >= 2 && place.repeats <= 99,
                   "open_round: found a series of " + std::to_string(place.repeats) +
                       " repeats, expected 2 to 99");
    if (place.follows != 0) {
        const Round before = round_of(database_, place.follows);
        if (!before.closed) {
            throw Refused(round_name(before.id) + " is still open", "lock it before its duel");
        }
    }
    if (place.series == 0) return;
    const auto series = series_of(place.series);
    check_argument(
        series && series->id == place.series,
        "open_round: found " + round_name(place.series) + ", expected the first round of a series");
    check_argument(series->designs == setup.designs && series->repeats == place.repeats &&
                       series->follows == place.follows,
                   "open_round: found another question than that of the series, expected the same "
                   "looks in the same order");
    if (series->over || series->session != session) {
        throw Refused("the series that " + round_name(series->id) + " began is over",
                      "begin a new one");
    }
}

void BallotStore::check_told(const Round& round) const {
    const auto series = series_of(round.id);
    if (!series || series->over) return;
    throw Refused(round_name(round.id) + " is one of a series of " +
                      std::to_string(series->repeats) + " of which " +
                      std::to_string(series->rounds.size()) +
                      " are locked: what is told now would sway the repeats to come",
                  "lock the last repeat, or give the series up by opening another round");
}

}  // namespace livery
