#include "evaluation/ballot_tables.h"

#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "evaluation/evaluator_name.h"

namespace livery {

namespace {

/// Everything that is recorded, from the log or from the tables, to be compared.
struct Books {
    using Ballot = std::tuple<int, int, int, std::string, int>;  // choices, time, log entry
    struct Round {
        int session = 0, asks_least = 0, seed = 0;
        std::string created, calibration_id, voting, closed;
        std::map<int, std::pair<std::string, int>> designs;  // name and code by index
        std::map<int, Ballot> ballots;                       // by seat
        bool operator==(const Round&) const = default;
    };
    using Seat = std::tuple<std::string, std::string, std::string>;  // key, name, time
    std::map<int, std::string> sessions;
    std::map<std::pair<int, int>, Seat> seats;
    std::map<int, Round> rounds;
};

std::string key_of(const LogEntry& seat) {
    return seat.best != 0 ? phone_seat_key(seat.text) : named_seat_key(seat.text);
}

std::string name_in(const LogEntry& seat) { return seat.best != 0 ? std::string() : seat.text; }

void apply(Books& books, const LogEntry& entry) {
    using What = LogEntry::What;
    switch (entry.what) {
        case What::session:
            books.sessions[entry.session] = entry.at;
            return;
        case What::seat:
            books.seats[{entry.session, entry.seat}] = {key_of(entry), name_in(entry), entry.at};
            return;
        case What::open: {
            Books::Round& round = books.rounds[entry.round];
            round.session = entry.session;
            round.created = entry.at;
            round.calibration_id = entry.text;
            round.asks_least = entry.best;
            round.seed = entry.second;
            return;
        }
        case What::design:
            books.rounds[entry.round].designs[entry.best] = {entry.text, entry.second};
            return;
        case What::voting:
            books.rounds[entry.round].voting = entry.at;
            return;
        case What::vote:
            books.rounds[entry.round].ballots[entry.seat] = {
                entry.best, entry.second, entry.least, entry.at, entry.id};
            return;
        case What::close:
            books.rounds[entry.round].closed = entry.at;
            return;
        case What::migrated:
        case What::plan:
        case What::shown:
            return;
    }
}

Books books_of_tables(Database& database) {
    Books books;
    const auto number = [&](const DatabaseValue& value) { return as_int(database, value); };
    const auto text = [&](const DatabaseValue& value) { return as_text(database, value); };
    for (const auto& row : database.run("SELECT id, created FROM sessions")) {
        books.sessions[number(row[0])] = text(row[1]);
    }
    for (const auto& row : database.run("SELECT session, seat, key, name, at FROM seats")) {
        books.seats[{number(row[0]), number(row[1])}] = {text(row[2]), text(row[3]), text(row[4])};
    }
    for (const auto& row : database.run("SELECT id, session, created, calibration_id, asks_least, "
                                        "seed, coalesce(voting, ''), coalesce(closed, '') "
                                        "FROM rounds")) {
        Books::Round& round = books.rounds[number(row[0])];
        round.session = number(row[1]);
        round.created = text(row[2]);
        round.calibration_id = text(row[3]);
        round.asks_least = number(row[4]);
        round.seed = number(row[5]);
        round.voting = text(row[6]);
        round.closed = text(row[7]);
    }
    for (const auto& row : database.run("SELECT round, position, name, code FROM designs")) {
        books.rounds[number(row[0])].designs[number(row[1])] = {text(row[2]), number(row[3])};
    }
    for (const auto& row : database.run("SELECT round, seat, best, second, coalesce(least, -1), "
                                        "at, entry FROM ballots")) {
        books.rounds[number(row[0])].ballots[number(row[1])] = {
            number(row[2]), number(row[3]), number(row[4]), text(row[5]), number(row[6])};
    }
    return books;
}

}  // namespace

std::string named_seat_key(const std::string& name) { return "name:" + name_key(name); }
std::string phone_seat_key(const std::string& secret_hash) { return "phone:" + secret_hash; }

std::vector<std::string> ballot_tables_schema() {
    std::vector<std::string> all = {
        "CREATE TABLE sessions ("
        " id INTEGER PRIMARY KEY,"
        " created TEXT NOT NULL) STRICT",
        "CREATE TABLE seats ("
        " session INTEGER NOT NULL REFERENCES sessions (id),"
        " seat INTEGER NOT NULL CHECK (seat > 0),"
        " key TEXT NOT NULL CHECK (key <> ''),"
        " name TEXT NOT NULL,"
        " at TEXT NOT NULL,"
        " PRIMARY KEY (session, seat), UNIQUE (session, key)) STRICT, WITHOUT ROWID",
        // How phones come in; nothing of it is a vote, and it changes while they do.
        "CREATE TABLE invitations ("
        " session INTEGER PRIMARY KEY REFERENCES sessions (id),"
        " token TEXT NOT NULL,"
        " code TEXT NOT NULL,"
        " code_until INTEGER NOT NULL) STRICT",
        "CREATE TABLE rounds ("
        " id INTEGER PRIMARY KEY,"
        " session INTEGER NOT NULL REFERENCES sessions (id),"
        " created TEXT NOT NULL,"
        " calibration_id TEXT NOT NULL,"
        " asks_least INTEGER NOT NULL CHECK (asks_least IN (0, 1)),"
        " seed INTEGER NOT NULL,"
        " voting TEXT,"
        " closed TEXT,"
        " UNIQUE (session, id)) STRICT",
        "CREATE UNIQUE INDEX one_open_round ON rounds (closed IS NULL) WHERE closed IS NULL",
        "CREATE TABLE designs ("
        " round INTEGER NOT NULL REFERENCES rounds (id),"
        " position INTEGER NOT NULL CHECK (position >= 0),"
        " name TEXT NOT NULL CHECK (name <> ''),"
        " code INTEGER NOT NULL CHECK (code BETWEEN 100 AND 999),"
        " PRIMARY KEY (round, position), UNIQUE (round, name), UNIQUE (round, code)"
        ") STRICT, WITHOUT ROWID",
        "CREATE TABLE ballots ("
        " session INTEGER NOT NULL,"
        " round INTEGER NOT NULL,"
        " seat INTEGER NOT NULL,"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " least INTEGER,"
        " at TEXT NOT NULL,"
        " entry INTEGER NOT NULL REFERENCES log (id),"
        " PRIMARY KEY (session, round, seat),"
        " CHECK (best <> second),"
        " CHECK (least IS NULL OR (least <> best AND least <> second)),"
        " FOREIGN KEY (session, round) REFERENCES rounds (session, id),"
        " FOREIGN KEY (session, seat) REFERENCES seats (session, seat),"
        " FOREIGN KEY (round, best) REFERENCES designs (round, position),"
        " FOREIGN KEY (round, second) REFERENCES designs (round, position),"
        " FOREIGN KEY (round, least) REFERENCES designs (round, position)"
        ") STRICT, WITHOUT ROWID",
        "CREATE TRIGGER ballot_in_time BEFORE INSERT ON ballots"
        " WHEN (SELECT voting IS NULL OR closed IS NOT NULL FROM rounds WHERE id = new.round)"
        " BEGIN SELECT RAISE(ABORT, 'the round is not open for votes'); END",
        "CREATE TRIGGER ballot_changed_in_time BEFORE UPDATE ON ballots"
        " WHEN (SELECT closed FROM rounds WHERE id = old.round) IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TRIGGER ballot_kept BEFORE DELETE ON ballots"
        " BEGIN SELECT RAISE(ABORT, 'ballots are not deleted'); END",
        "CREATE TRIGGER seat_kept BEFORE DELETE ON seats"
        " BEGIN SELECT RAISE(ABORT, 'seats are not deleted'); END",
        "CREATE TRIGGER round_closed_for_good BEFORE UPDATE ON rounds"
        " WHEN old.closed IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
    };
    // Ballots point into the log.
    std::vector<std::string> statements = log_schema();
    for (std::string& statement : all) statements.push_back(std::move(statement));
    return statements;
}

void record(Database& database, LogEntry entry) {
    using What = LogEntry::What;
    append_to_log(database, entry);
    const std::int64_t session = entry.session, round = entry.round, seat = entry.seat;
    const std::int64_t best = entry.best, second = entry.second;
    switch (entry.what) {
        case What::session:
            database.run("INSERT INTO sessions VALUES (?1, ?2)", {session, entry.at});
            return;
        case What::seat:
            database.run("INSERT INTO seats VALUES (?1, ?2, ?3, ?4, ?5)",
                         {session, seat, key_of(entry), name_in(entry), entry.at});
            return;
        case What::open:
            database.run("INSERT INTO rounds VALUES (?1, ?2, ?3, ?4, ?5, ?6, NULL, NULL)",
                         {round, session, entry.at, entry.text, best, second});
            return;
        case What::design:
            database.run("INSERT INTO designs VALUES (?1, ?2, ?3, ?4)",
                         {round, best, entry.text, second});
            return;
        case What::voting:
            database.run("UPDATE rounds SET voting = ?2 WHERE id = ?1", {round, entry.at});
            return;
        case What::vote:
            database.run(
                "INSERT INTO ballots VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) "
                "ON CONFLICT (session, round, seat) DO UPDATE SET best = excluded.best, "
                "second = excluded.second, least = excluded.least, at = excluded.at, "
                "entry = excluded.entry",
                {session,
                 round,
                 seat,
                 best,
                 second,
                 entry.least < 0 ? DatabaseValue() : DatabaseValue(std::int64_t{entry.least}),
                 entry.at,
                 std::int64_t{entry.id}});
            return;
        case What::close:
            database.run("UPDATE rounds SET closed = ?2 WHERE id = ?1", {round, entry.at});
            return;
        case What::migrated:
        case What::plan:
        case What::shown:
            return;
    }
}

void check_against_log(Database& database) {
    Books logged;
    for (const LogEntry& entry : read_log(database)) apply(logged, entry);
    const Books kept = books_of_tables(database);
    for (const auto& [id, round] : logged.rounds) {
        const std::string field = "round " + std::to_string(id);
        const auto found = kept.rounds.find(id);
        if (found == kept.rounds.end()) fail_ballots(database, field, "none, but the log opens it");
        if (found->second.ballots != round.ballots) {
            fail_ballots(database, field, "ballots that are not those of the log");
        }
        if (found->second != round) {
            fail_ballots(database, field, "a round that is not that of the log");
        }
    }
    for (const auto& [id, round] : kept.rounds) {
        if (!logged.rounds.contains(id)) {
            fail_ballots(
                database, "round " + std::to_string(id), "a round that the log does not have");
        }
    }
    if (logged.sessions != kept.sessions || logged.seats != kept.seats) {
        fail_ballots(database, "seats", "seats that are not those of the log");
    }
}

}  // namespace livery
