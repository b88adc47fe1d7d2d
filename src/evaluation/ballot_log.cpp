#include "evaluation/ballot_log.h"

#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "evaluation/evaluator_name.h"

namespace livery {

namespace {

constexpr const char* kNames[] = {"open", "design", "vote", "close"};

const char* name_of(LogEntry::What what) { return kNames[static_cast<int>(what)]; }

std::string sealed(const std::string& previous, int id, const LogEntry& entry) {
    Hasher hasher;
    hasher.add(previous);
    for (const int number : {id, entry.round, entry.best, entry.second}) {
        hasher.add(std::to_string(number));
    }
    for (const std::string& text : {std::string(name_of(entry.what)), entry.at, entry.text}) {
        hasher.add(text);
    }
    return hasher.hex();
}

/// Rounds and ballots, from the log or from the tables, to be compared.
struct Books {
    using Ballot = std::tuple<std::string, int, int, std::string>;  // name, best, second, time
    struct Round {
        std::string created, calibration_id, closed;
        std::map<int, std::string> designs;
        std::map<std::string, Ballot> ballots;
        bool operator==(const Round&) const = default;
    };
    std::map<int, Round> rounds;
};

void apply(Books& books, const LogEntry& entry) {
    Books::Round& round = books.rounds[entry.round];
    switch (entry.what) {
        case LogEntry::What::open:
            round.created = entry.at;
            round.calibration_id = entry.text;
            return;
        case LogEntry::What::design:
            round.designs[entry.best] = entry.text;
            return;
        case LogEntry::What::vote:
            round.ballots[name_key(entry.text)] = {entry.text, entry.best, entry.second, entry.at};
            return;
        case LogEntry::What::close:
            round.closed = entry.at;
            return;
    }
}

[[noreturn]] void fail(const Database& database, std::string field, std::string found) {
    throw FileError(database.file(),
                    std::move(field),
                    std::move(found),
                    "ballots as Livery wrote them; go on with a copy, or with a new file");
}

/// Replays the log, whose chain of hashes must hold.
Books books_of_log(Database& database) {
    Books books;
    std::string previous;
    int expected_id = 1;
    for (const auto& row : database.run("SELECT id, at, round, what, text, best, second, hash "
                                        "FROM log ORDER BY id")) {
        const int id = as_int(database, row[0]);
        const std::string field = "log entry " + std::to_string(expected_id);
        if (id != expected_id) fail(database, field, "none: the next is " + std::to_string(id));
        const std::string what = as_text(database, row[3]);
        LogEntry entry;
        for (int k = 0; k < 4; ++k) {
            if (what == kNames[k]) entry.what = static_cast<LogEntry::What>(k);
        }
        entry.at = as_text(database, row[1]);
        entry.round = as_int(database, row[2]);
        entry.text = as_text(database, row[4]);
        entry.best = as_int(database, row[5]);
        entry.second = as_int(database, row[6]);
        const std::string hash = as_text(database, row[7]);
        if (hash != sealed(previous, id, entry)) {
            fail(database, field, "a change since it was written");
        }
        apply(books, entry);
        previous = hash;
        ++expected_id;
    }
    return books;
}

Books books_of_tables(Database& database) {
    Books books;
    const auto known_round = [&](const DatabaseValue& id) -> Books::Round& {
        return books.rounds[as_int(database, id)];
    };
    for (const auto& row :
         database.run("SELECT id, created, calibration_id, coalesce(closed, '') FROM rounds")) {
        Books::Round& round = known_round(row[0]);
        round.created = as_text(database, row[1]);
        round.calibration_id = as_text(database, row[2]);
        round.closed = as_text(database, row[3]);
    }
    for (const auto& row : database.run("SELECT round, position, name FROM designs")) {
        known_round(row[0]).designs[as_int(database, row[1])] = as_text(database, row[2]);
    }
    for (const auto& row :
         database.run("SELECT round, name_key, evaluator, best, second, at FROM ballots")) {
        known_round(row[0]).ballots[as_text(database, row[1])] = {as_text(database, row[2]),
                                                                  as_int(database, row[3]),
                                                                  as_int(database, row[4]),
                                                                  as_text(database, row[5])};
    }
    return books;
}

}  // namespace

int as_int(const Database& database, const DatabaseValue& value) {
    const auto* number = std::get_if<std::int64_t>(&value);
    if (!number || *number < std::numeric_limits<int>::min() ||
        *number > std::numeric_limits<int>::max()) {
        fail(database, "", "a column that should hold a number and does not");
    }
    return static_cast<int>(*number);
}

std::string as_text(const Database& database, const DatabaseValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text) fail(database, "", "a column that should hold text and does not");
    return *text;
}

std::vector<std::string> log_schema() {
    std::vector<std::string> statements = {
        "CREATE TABLE log ("
        " id INTEGER PRIMARY KEY,"
        " at TEXT NOT NULL,"
        " round INTEGER NOT NULL,"
        " what TEXT NOT NULL CHECK (what IN ('open', 'design', 'vote', 'close')),"
        " text TEXT NOT NULL,"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " hash TEXT NOT NULL UNIQUE) STRICT"};
    for (const char* event : {"UPDATE", "DELETE"}) {
        statements.push_back(
            std::string("CREATE TRIGGER log_without_") + event + " BEFORE " + event +
            " ON log BEGIN SELECT RAISE(ABORT, 'the log is only appended to'); END");
    }
    return statements;
}

void append_to_log(Database& database, const LogEntry& entry) {
    const auto last = database.run("SELECT id, hash FROM log ORDER BY id DESC LIMIT 1");
    const int id = last.empty() ? 1 : as_int(database, last[0][0]) + 1;
    const std::string previous = last.empty() ? "" : as_text(database, last[0][1]);
    database.run("INSERT INTO log VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)",
                 {std::int64_t{id},
                  entry.at,
                  std::int64_t{entry.round},
                  std::string(name_of(entry.what)),
                  entry.text,
                  std::int64_t{entry.best},
                  std::int64_t{entry.second},
                  sealed(previous, id, entry)});
}

void check_log(Database& database) {
    const Books logged = books_of_log(database), kept = books_of_tables(database);
    for (const auto& [id, round] : logged.rounds) {
        const std::string field = "round " + std::to_string(id);
        const auto found = kept.rounds.find(id);
        if (found == kept.rounds.end()) fail(database, field, "none, but the log opens it");
        if (found->second.ballots != round.ballots) {
            fail(database, field, "ballots that are not those of the log");
        }
        if (found->second != round) fail(database, field, "a round that is not that of the log");
    }
    for (const auto& [id, round] : kept.rounds) {
        if (!logged.rounds.contains(id)) {
            fail(database, "round " + std::to_string(id), "a round that the log does not have");
        }
    }
}

}  // namespace livery
