#include "evaluation/ballot_rows.h"

#include <utility>

#include "core/time.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_tables.h"

namespace livery {

namespace {

using What = LogEntry::What;

Round round_from(Database& database, const std::vector<DatabaseValue>& row) {
    Round round;
    round.id = as_int(database, row[0]);
    round.created = as_text(database, row[1]);
    round.calibration_id = as_text(database, row[2]);
    round.closed = as_int(database, row[3]) != 0;
    round.ballots = as_int(database, row[4]);
    round.session = as_int(database, row[5]);
    round.seed = as_int(database, row[6]);
    round.asks_least = as_int(database, row[7]) != 0;
    round.voting = as_int(database, row[8]) != 0;
    // A round's designs never change, so a second look is as good as the first.
    for (const auto& design :
         database.run("SELECT name, code FROM designs WHERE round = ?1 ORDER BY position",
                      {std::int64_t{round.id}})) {
        round.designs.push_back(as_text(database, design[0]));
        round.codes.push_back(as_int(database, design[1]));
    }
    for (const auto& scale :
         database.run("SELECT low, high FROM scales WHERE round = ?1 ORDER BY position",
                      {std::int64_t{round.id}})) {
        round.scales.push_back({as_text(database, scale[0]), as_text(database, scale[1])});
    }
    return round;
}

}  // namespace

std::string round_name(int round) { return "round " + std::to_string(round); }

std::vector<Round> rounds_where(Database& database,
                                const std::string& condition,
                                const std::vector<DatabaseValue>& values) {
    std::vector<Round> rounds;
    for (const auto& row :
         database.run("SELECT id, created, calibration_id, closed IS NOT NULL, "
                      "(SELECT count(*) FROM ballots WHERE session = rounds.session AND "
                      "round = rounds.id), session, seed, asks_least, voting IS NOT NULL "
                      "FROM rounds " +
                          condition,
                      values)) {
        rounds.push_back(round_from(database, row));
    }
    return rounds;
}

Round round_of(Database& database, int id) {
    auto found = rounds_where(database, "WHERE id = ?1", {std::int64_t{id}});
    if (found.empty()) {
        const auto counted = database.run("SELECT count(*) FROM rounds");
        throw std::invalid_argument("found " + round_name(id) + ", expected one of the " +
                                    std::to_string(as_int(database, counted[0][0])) +
                                    " rounds in " + database.file().string());
    }
    return std::move(found.front());
}

std::optional<int> newest_session(Database& database) {
    const auto rows = database.run("SELECT id FROM sessions ORDER BY id DESC LIMIT 1");
    if (rows.empty()) return std::nullopt;
    return as_int(database, rows[0][0]);
}

int make_session(Database& database) {
    const int session = newest_session(database).value_or(0) + 1;
    record(database, {.what = What::session, .session = session, .at = utc_now()});
    return session;
}

std::optional<int> seat_with_key(Database& database, int session, const std::string& key) {
    const auto rows = database.run("SELECT seat FROM seats WHERE session = ?1 AND key = ?2",
                                   {std::int64_t{session}, key});
    if (rows.empty()) return std::nullopt;
    return as_int(database, rows[0][0]);
}

int make_seat(Database& database, int session, const std::string& text, bool phone) {
    const int seat = as_int(database,
                            database.run("SELECT coalesce(max(seat), 0) FROM seats "
                                         "WHERE session = ?1",
                                         {std::int64_t{session}})[0][0]) +
                     1;
    record(database,
           {.what = What::seat,
            .session = session,
            .seat = seat,
            .at = utc_now(),
            .text = text,
            .best = phone ? 1 : 0});
    return seat;
}

std::vector<int> phone_seats(Database& database, int session) {
    std::vector<int> seats;
    for (const auto& row : database.run(
             "SELECT seat FROM seats WHERE session = ?1 AND key LIKE 'phone:%' ORDER BY seat",
             {std::int64_t{session}})) {
        seats.push_back(as_int(database, row[0]));
    }
    return seats;
}

}  // namespace livery
