#include "evaluation/ballot_tables.h"

#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "evaluation/evaluator_name.h"
#include "evaluation/presenting/presentation.h"

namespace livery {

namespace {

using What = LogEntry::What;

/// Everything that is recorded, from the log or from the tables, to be compared.
struct Books {
    using Ballot = std::tuple<int, int, int, std::string, int>;  // choices, time, log entry
    using Rating = std::tuple<int, std::string, int>;            // step, time, log entry
    struct Round {
        int session = 0, asks_least = 0, seed = 0;
        std::string created, calibration_id, voting, closed;
        std::map<int, std::pair<std::string, int>> designs;         // name and code by index
        std::map<int, Ballot> ballots;                              // by seat
        std::map<int, std::string> waves;                           // since when each votes
        std::map<int, int> sitters;                                 // their waves, by seat
        std::tuple<int, int, int> series;                           // as the log's entry has it
        std::map<int, std::pair<std::string, std::string>> scales;  // words by index
        std::map<std::tuple<int, int, int>, Rating> ratings;        // by seat, design and scale
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

/// The two words of a scale.
std::pair<std::string, std::string> words_in(const LogEntry& scale) {
    const std::size_t tab = scale.text.find('\t');
    if (tab == std::string::npos) return {scale.text, ""};
    return {scale.text.substr(0, tab), scale.text.substr(tab + 1)};
}

std::string name_in(const LogEntry& seat) { return seat.best != 0 ? std::string() : seat.text; }

/// `file` is named where an entry's text cannot be read.
void apply(Books& books, const LogEntry& entry, const std::string& file) {
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
        case What::plan: {
            Books::Round& round = books.rounds[entry.round];
            const auto seats = parse_plan(entry.text, file).seats;
            for (std::size_t wave = 0; wave < seats.size(); ++wave) {
                round.waves[static_cast<int>(wave)] = "";
                for (const int seat : seats[wave]) round.sitters[seat] = static_cast<int>(wave);
            }
            return;
        }
        case What::shown: {
            auto& waves = books.rounds[entry.round].waves;
            const auto wave = waves.find(entry.seat);
            if (entry.least == 1 && wave != waves.end() && wave->second.empty()) {
                wave->second = entry.at;
            }
            return;
        }
        case What::series:
            books.rounds[entry.round].series = {entry.seat, entry.best, entry.second};
            return;
        case What::scale:
            books.rounds[entry.round].scales[entry.best] = words_in(entry);
            return;
        case What::rated:
            books.rounds[entry.round].ratings[{entry.seat, entry.best, entry.second}] = {
                entry.least, entry.at, entry.id};
            return;
        case What::migrated:
            return;
    }
}

/// What formats before the fourth did not have.
void add_newer_books(Database& database, Books& books) {
    const auto number = [&](const DatabaseValue& value) { return as_int(database, value); };
    const auto text = [&](const DatabaseValue& value) { return as_text(database, value); };
    for (const auto& row : database.run("SELECT round, wave, coalesce(voting, '') FROM waves")) {
        books.rounds[number(row[0])].waves[number(row[1])] = text(row[2]);
    }
    for (const auto& row : database.run("SELECT round, seat, wave FROM sitters")) {
        books.rounds[number(row[0])].sitters[number(row[1])] = number(row[2]);
    }
    for (const auto& row :
         database.run("SELECT round, series, repeats, coalesce(follows, 0) FROM series")) {
        books.rounds[number(row[0])].series = {number(row[1]), number(row[2]), number(row[3])};
    }
    for (const auto& row : database.run("SELECT round, position, low, high FROM scales")) {
        books.rounds[number(row[0])].scales[number(row[1])] = {text(row[2]), text(row[3])};
    }
    for (const auto& row : database.run("SELECT round, seat, design, scale, coalesce(step, -1), "
                                        "at, entry FROM ratings")) {
        books.rounds[number(row[0])].ratings[{number(row[1]), number(row[2]), number(row[3])}] = {
            number(row[4]), text(row[5]), number(row[6])};
    }
}

Books books_of_tables(Database& database, int format) {
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
    if (format >= 4) add_newer_books(database, books);
    return books;
}

void record_waves(Database& database, const LogEntry& plan) {
    const auto seats = parse_plan(plan.text, database.file().string()).seats;
    const std::int64_t round = plan.round, session = plan.session;
    for (std::size_t k = 0; k < seats.size(); ++k) {
        const auto wave = static_cast<std::int64_t>(k);
        database.run("INSERT INTO waves VALUES (?1, ?2, NULL)", {round, wave});
        for (const int seat : seats[k]) {
            database.run("INSERT INTO sitters VALUES (?1, ?2, ?3, ?4)",
                         {session, round, std::int64_t{seat}, wave});
        }
    }
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
        // Groups of people who sit before the mock-up one after the other; who is in none votes at
        // any time.
        "CREATE TABLE waves ("
        " round INTEGER NOT NULL REFERENCES rounds (id),"
        " wave INTEGER NOT NULL CHECK (wave >= 0),"
        " voting TEXT,"
        " PRIMARY KEY (round, wave)) STRICT, WITHOUT ROWID",
        "CREATE TABLE sitters ("
        " session INTEGER NOT NULL,"
        " round INTEGER NOT NULL,"
        " seat INTEGER NOT NULL,"
        " wave INTEGER NOT NULL,"
        " PRIMARY KEY (round, seat),"
        " FOREIGN KEY (session, round) REFERENCES rounds (session, id),"
        " FOREIGN KEY (session, seat) REFERENCES seats (session, seat),"
        " FOREIGN KEY (round, wave) REFERENCES waves (round, wave)) STRICT, WITHOUT ROWID",
        // Blind repeats; the first one gives the series its number.
        "CREATE TABLE series ("
        " round INTEGER PRIMARY KEY REFERENCES rounds (id),"
        " series INTEGER NOT NULL REFERENCES rounds (id) CHECK (series <= round),"
        " repeats INTEGER NOT NULL CHECK (repeats > 1),"
        " follows INTEGER REFERENCES rounds (id) CHECK (follows < series)) STRICT",
        "CREATE TABLE scales ("
        " round INTEGER NOT NULL REFERENCES rounds (id),"
        " position INTEGER NOT NULL CHECK (position BETWEEN 0 AND 4),"
        " low TEXT NOT NULL CHECK (low <> ''),"
        " high TEXT NOT NULL CHECK (high <> '' AND high <> low),"
        " PRIMARY KEY (round, position), UNIQUE (round, low, high)) STRICT, WITHOUT ROWID",
        // Who has not voted has no say on scales either.
        "CREATE TABLE ratings ("
        " session INTEGER NOT NULL,"
        " round INTEGER NOT NULL,"
        " seat INTEGER NOT NULL,"
        " design INTEGER NOT NULL,"
        " scale INTEGER NOT NULL,"
        " step INTEGER CHECK (step BETWEEN 1 AND 7),"
        " at TEXT NOT NULL,"
        " entry INTEGER NOT NULL REFERENCES log (id),"
        " PRIMARY KEY (session, round, seat, design, scale),"
        " FOREIGN KEY (session, round, seat) REFERENCES ballots (session, round, seat),"
        " FOREIGN KEY (round, design) REFERENCES designs (round, position),"
        " FOREIGN KEY (round, scale) REFERENCES scales (round, position)"
        ") STRICT, WITHOUT ROWID",
        "CREATE TRIGGER ballot_in_turn BEFORE INSERT ON ballots"
        " WHEN EXISTS (SELECT 1 FROM sitters JOIN waves USING (round, wave)"
        " WHERE round = new.round AND seat = new.seat AND voting IS NULL)"
        " BEGIN SELECT RAISE(ABORT, 'the turn of this seat is still to come'); END",
        "CREATE TRIGGER rating_in_time BEFORE INSERT ON ratings"
        " WHEN (SELECT closed FROM rounds WHERE id = new.round) IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TRIGGER rating_changed_in_time BEFORE UPDATE ON ratings"
        " WHEN (SELECT closed FROM rounds WHERE id = old.round) IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TRIGGER rating_kept BEFORE DELETE ON ratings"
        " BEGIN SELECT RAISE(ABORT, 'ratings are not deleted'); END",
        "CREATE TRIGGER sitter_kept BEFORE DELETE ON sitters"
        " BEGIN SELECT RAISE(ABORT, 'who sits in which wave stays'); END",
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
    // Of a ballot, or of a look's place on a scale
    const std::vector<DatabaseValue> choice{
        session,
        round,
        seat,
        best,
        second,
        entry.least < 0 ? DatabaseValue() : DatabaseValue(std::int64_t{entry.least}),
        entry.at,
        std::int64_t{entry.id}};
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
                choice);
            return;
        case What::close:
            database.run("UPDATE rounds SET closed = ?2 WHERE id = ?1", {round, entry.at});
            return;
        case What::plan:
            record_waves(database, entry);
            return;
        case What::shown:
            if (entry.least != 1) return;
            database.run(
                "UPDATE waves SET voting = ?3 WHERE round = ?1 AND wave = ?2 AND voting IS NULL",
                {round, seat, entry.at});
            return;
        case What::series:
            database.run(
                "INSERT INTO series VALUES (?1, ?2, ?3, ?4)",
                {round, seat, best, second == 0 ? DatabaseValue() : DatabaseValue(second)});
            return;
        case What::scale: {
            const auto [low, high] = words_in(entry);
            database.run("INSERT INTO scales VALUES (?1, ?2, ?3, ?4)", {round, best, low, high});
            return;
        }
        case What::rated:
            database.run(
                "INSERT INTO ratings VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8) "
                "ON CONFLICT (session, round, seat, design, scale) DO UPDATE SET "
                "step = excluded.step, at = excluded.at, entry = excluded.entry",
                choice);
            return;
        case What::migrated:
            return;
    }
}

void check_against_log(Database& database, int format) {
    Books logged;
    const std::string file = database.file().string();
    read_log(database, [&](const LogEntry& entry) { apply(logged, entry, file); });
    const Books kept = books_of_tables(database, format);
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
