#include "evaluation/ballots_v1.h"

#include <cstddef>
#include <map>
#include <set>
#include <tuple>

#include "core/hash.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/design_codes.h"
#include "evaluation/evaluator_name.h"

namespace livery {

namespace {

constexpr int kSeed = 1;  ///< of the codes that old rounds are given

struct EntryV1 {
    int id = 0, round = 0, best = 0, second = 0;
    std::string at, what, text, hash;
};

std::vector<EntryV1> read_log_v1(Database& database) {
    std::vector<EntryV1> entries;
    std::string previous;
    for (const auto& row : database.run("SELECT id, at, round, what, text, best, second, hash "
                                        "FROM log ORDER BY id")) {
        EntryV1 entry;
        entry.id = static_cast<int>(entries.size()) + 1;
        const std::string field = "log entry " + std::to_string(entry.id);
        if (const int id = as_int(database, row[0]); id != entry.id) {
            fail_ballots(database, field, "none: the next is " + std::to_string(id));
        }
        entry.at = as_text(database, row[1]);
        entry.round = as_int(database, row[2]);
        entry.what = as_text(database, row[3]);
        entry.text = as_text(database, row[4]);
        entry.best = as_int(database, row[5]);
        entry.second = as_int(database, row[6]);
        entry.hash = as_text(database, row[7]);
        Hasher hasher;
        hasher.add(previous);
        for (const int number : {entry.id, entry.round, entry.best, entry.second}) {
            hasher.add(std::to_string(number));
        }
        for (const std::string& text : {entry.what, entry.at, entry.text}) hasher.add(text);
        if (entry.hash != hasher.hex()) {
            fail_ballots(database, field, "a change since it was written");
        }
        previous = entry.hash;
        entries.push_back(std::move(entry));
    }
    return entries;
}

/// Rounds, designs and ballots as rows, from the log or from the tables.
using RowsV1 = std::set<std::tuple<std::string, int, std::string, std::string, int, int>>;

RowsV1 rows_of(const std::vector<EntryV1>& entries) {
    RowsV1 rows;
    std::map<int, std::pair<std::string, std::string>> opened;
    std::map<int, std::string> closed;
    std::map<std::pair<int, std::string>, EntryV1> ballots;
    for (const EntryV1& entry : entries) {
        if (entry.what == "open") opened[entry.round] = {entry.at, entry.text};
        if (entry.what == "design")
            rows.insert({"design", entry.round, entry.text, "", entry.best, 0});
        if (entry.what == "vote") ballots[{entry.round, name_key(entry.text)}] = entry;
        if (entry.what == "close") closed[entry.round] = entry.at;
    }
    for (const auto& [round, opening] : opened) {
        rows.insert({"open", round, opening.first, opening.second, 0, 0});
        rows.insert({"close", round, closed[round], "", 0, 0});
    }
    for (const auto& [key, ballot] : ballots) {
        rows.insert({"vote", key.first, ballot.text, ballot.at, ballot.best, ballot.second});
    }
    return rows;
}

RowsV1 rows_of_tables(Database& database) {
    RowsV1 rows;
    const auto number = [&](const DatabaseValue& value) { return as_int(database, value); };
    const auto text = [&](const DatabaseValue& value) { return as_text(database, value); };
    for (const auto& row :
         database.run("SELECT id, created, calibration_id, coalesce(closed, '') FROM rounds")) {
        rows.insert({"open", number(row[0]), text(row[1]), text(row[2]), 0, 0});
        rows.insert({"close", number(row[0]), text(row[3]), "", 0, 0});
    }
    for (const auto& row : database.run("SELECT round, position, name FROM designs")) {
        rows.insert({"design", number(row[0]), text(row[2]), "", number(row[1]), 0});
    }
    for (const auto& row : database.run("SELECT round, evaluator, at, best, second FROM ballots")) {
        rows.insert(
            {"vote", number(row[0]), text(row[1]), text(row[2]), number(row[3]), number(row[4])});
    }
    return rows;
}

}  // namespace

std::vector<std::string> ballots_v1_schema() {
    return {
        "CREATE TABLE rounds ("
        " id INTEGER PRIMARY KEY,"
        " created TEXT NOT NULL,"
        " calibration_id TEXT NOT NULL,"
        " closed TEXT) STRICT",
        "CREATE UNIQUE INDEX one_open_round ON rounds (closed IS NULL) WHERE closed IS NULL",
        "CREATE TABLE designs ("
        " round INTEGER NOT NULL REFERENCES rounds (id),"
        " position INTEGER NOT NULL CHECK (position >= 0),"
        " name TEXT NOT NULL CHECK (name <> ''),"
        " PRIMARY KEY (round, position), UNIQUE (round, name)) STRICT, WITHOUT ROWID",
        "CREATE TABLE ballots ("
        " round INTEGER NOT NULL,"
        " name_key TEXT NOT NULL CHECK (name_key <> ''),"
        " evaluator TEXT NOT NULL CHECK (evaluator <> ''),"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " at TEXT NOT NULL,"
        " PRIMARY KEY (round, name_key),"
        " CHECK (best <> second),"
        " FOREIGN KEY (round, best) REFERENCES designs (round, position),"
        " FOREIGN KEY (round, second) REFERENCES designs (round, position)"
        ") STRICT, WITHOUT ROWID",
        "CREATE TRIGGER ballot_in_time BEFORE INSERT ON ballots"
        " WHEN (SELECT closed FROM rounds WHERE id = new.round) IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TRIGGER ballot_changed_in_time BEFORE UPDATE ON ballots"
        " WHEN (SELECT closed FROM rounds WHERE id = old.round) IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TRIGGER ballot_kept BEFORE DELETE ON ballots"
        " BEGIN SELECT RAISE(ABORT, 'ballots are not deleted'); END",
        "CREATE TRIGGER round_closed_for_good BEFORE UPDATE ON rounds"
        " WHEN old.closed IS NOT NULL"
        " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        "CREATE TABLE log ("
        " id INTEGER PRIMARY KEY,"
        " at TEXT NOT NULL,"
        " round INTEGER NOT NULL,"
        " what TEXT NOT NULL CHECK (what IN ('open', 'design', 'vote', 'close')),"
        " text TEXT NOT NULL,"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " hash TEXT NOT NULL UNIQUE) STRICT",
        "CREATE TRIGGER log_without_UPDATE BEFORE UPDATE"
        " ON log BEGIN SELECT RAISE(ABORT, 'the log is only appended to'); END",
        "CREATE TRIGGER log_without_DELETE BEFORE DELETE"
        " ON log BEGIN SELECT RAISE(ABORT, 'the log is only appended to'); END",
    };
}

void migrate_ballots_v1(Database& database) {
    const std::vector<EntryV1> entries = read_log_v1(database);
    if (rows_of(entries) != rows_of_tables(database)) {
        fail_ballots(database, "ballots", "rounds and ballots that are not those of the log");
    }
    // --- the old tables go, those that point before those that are pointed at ---
    for (const char* table : {"ballots", "designs", "rounds", "log"}) {
        database.run(std::string("DROP TABLE ") + table);
    }
    for (const std::string& statement : ballot_tables_schema()) database.run(statement);
    if (entries.empty()) return;

    // --- what happened is told anew ---
    using What = LogEntry::What;
    record(database,
           {.what = What::migrated, .at = entries.front().at, .text = entries.back().hash});
    record(database, {.what = What::session, .session = 1, .at = entries.front().at});
    std::map<int, std::size_t> designs;
    for (const EntryV1& entry : entries) {
        if (entry.what == "design") ++designs[entry.round];
    }
    std::map<std::string, int> seats;
    std::map<int, std::vector<int>> codes;
    for (const EntryV1& entry : entries) {
        const LogEntry base{.session = 1, .round = entry.round, .at = entry.at};
        LogEntry told = base;
        if (entry.what == "open") {
            told.what = What::open;
            told.text = entry.text;
            told.second = kSeed;
            codes[entry.round] =
                draw_codes(static_cast<int>(designs[entry.round]), kSeed, entry.round);
        } else if (entry.what == "design") {
            told.what = What::design;
            told.text = entry.text;
            told.best = entry.best;
            const std::vector<int>& drawn = codes[entry.round];
            if (entry.best < 0 || static_cast<std::size_t>(entry.best) >= drawn.size()) {
                fail_ballots(database,
                             "log entry " + std::to_string(entry.id),
                             "a design at " + std::to_string(entry.best));
            }
            told.second = drawn[static_cast<std::size_t>(entry.best)];
        } else if (entry.what == "vote") {
            const auto [seat, fresh] =
                seats.try_emplace(name_key(entry.text), static_cast<int>(seats.size()) + 1);
            if (fresh) {
                record(database,
                       {.what = What::seat,
                        .session = 1,
                        .seat = seat->second,
                        .at = entry.at,
                        .text = entry.text});
            }
            told.what = What::vote;
            told.seat = seat->second;
            told.best = entry.best;
            told.second = entry.second;
        } else {
            told.what = What::close;
        }
        record(database, told);
        // Such rounds were open for votes from the start.
        if (entry.what == "design" && --designs[entry.round] == 0) {
            LogEntry voting = base;
            voting.what = What::voting;
            record(database, voting);
        }
    }
}

}  // namespace livery
