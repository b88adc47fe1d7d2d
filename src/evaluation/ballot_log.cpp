#include "evaluation/ballot_log.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "core/error.h"
#include "core/hash.h"

namespace livery {

namespace {

constexpr std::array<std::string_view, 13> kNames = {"session",
                                                     "seat",
                                                     "open",
                                                     "design",
                                                     "voting",
                                                     "vote",
                                                     "close",
                                                     "migrated",
                                                     "plan",
                                                     "shown",
                                                     "series",
                                                     "scale",
                                                     "rated"};

std::size_t names_of_format(int format) { return format < 3 ? 8 : format < 4 ? 10 : kNames.size(); }

std::string_view name_of(LogEntry::What what) { return kNames[static_cast<std::size_t>(what)]; }

std::string sealed(const std::string& previous, const LogEntry& entry) {
    Hasher hasher;
    hasher.add(previous);
    for (const int number : {entry.id,
                             entry.session,
                             entry.round,
                             entry.seat,
                             entry.best,
                             entry.second,
                             entry.least}) {
        hasher.add(std::to_string(number) + ' ');
    }
    // Their lengths too: no two entries are one run of bytes.
    for (const std::string_view text :
         {name_of(entry.what), std::string_view(entry.at), std::string_view(entry.text)}) {
        hasher.add(std::to_string(text.size()) + ' ');
        hasher.add(text);
    }
    return hasher.hex();
}

}  // namespace

void fail_ballots(const Database& database, std::string field, std::string found) {
    throw FileError(database.file(),
                    std::move(field),
                    std::move(found),
                    "ballots as Livery wrote them; go on with a copy, or with a new file");
}

int as_int(const Database& database, const DatabaseValue& value) {
    const auto* number = std::get_if<std::int64_t>(&value);
    if (!number || *number < std::numeric_limits<int>::min() ||
        *number > std::numeric_limits<int>::max()) {
        fail_ballots(database, "", "a column that should hold a number and does not");
    }
    return static_cast<int>(*number);
}

std::string as_text(const Database& database, const DatabaseValue& value) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text) fail_ballots(database, "", "a column that should hold text and does not");
    return *text;
}

std::vector<std::string> log_schema(int format) {
    std::string names;
    for (std::size_t k = 0; k < names_of_format(format); ++k) {
        names += (names.empty() ? "'" : ", '") + std::string(kNames[k]) + "'";
    }
    std::vector<std::string> statements = {
        "CREATE TABLE log ("
        " id INTEGER PRIMARY KEY,"
        " at TEXT NOT NULL,"
        " what TEXT NOT NULL CHECK (what IN (" +
        names +
        ")),"
        " session INTEGER NOT NULL,"
        " round INTEGER NOT NULL,"
        " seat INTEGER NOT NULL,"
        " text TEXT NOT NULL,"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " least INTEGER NOT NULL,"
        " hash TEXT NOT NULL UNIQUE) STRICT"};
    for (const char* event : {"UPDATE", "DELETE"}) {
        statements.push_back(
            std::string("CREATE TRIGGER log_without_") + event + " BEFORE " + event +
            " ON log BEGIN SELECT RAISE(ABORT, 'the log is only appended to'); END");
    }
    return statements;
}

void append_to_log(Database& database, LogEntry& entry) {
    const auto last = database.run("SELECT id, hash FROM log ORDER BY id DESC LIMIT 1");
    entry.id = last.empty() ? 1 : as_int(database, last[0][0]) + 1;
    entry.hash = sealed(last.empty() ? "" : as_text(database, last[0][1]), entry);
    database.run("INSERT INTO log VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)",
                 {std::int64_t{entry.id},
                  entry.at,
                  std::string(name_of(entry.what)),
                  std::int64_t{entry.session},
                  std::int64_t{entry.round},
                  std::int64_t{entry.seat},
                  entry.text,
                  std::int64_t{entry.best},
                  std::int64_t{entry.second},
                  std::int64_t{entry.least},
                  entry.hash});
}

void read_log(Database& database, const std::function<void(const LogEntry&)>& take) {
    LogEntry entry;
    std::string previous;
    const auto read = [&](const Database::Row& row) {
        ++entry.id;
        const auto fail = [&](const std::string& found) {
            fail_ballots(database, "log entry " + std::to_string(entry.id), found);
        };
        if (const int id = as_int(database, row[0]); id != entry.id) {
            fail("none: the next is " + std::to_string(id));
        }
        const std::string what = as_text(database, row[2]);
        const auto* const name = std::find(kNames.begin(), kNames.end(), what);
        if (name == kNames.end()) fail("an entry of another kind");
        entry.what = static_cast<LogEntry::What>(name - kNames.begin());
        entry.at = as_text(database, row[1]);
        entry.session = as_int(database, row[3]);
        entry.round = as_int(database, row[4]);
        entry.seat = as_int(database, row[5]);
        entry.text = as_text(database, row[6]);
        entry.best = as_int(database, row[7]);
        entry.second = as_int(database, row[8]);
        entry.least = as_int(database, row[9]);
        entry.hash = as_text(database, row[10]);
        if (entry.hash != sealed(previous, entry)) fail("a change since it was written");
        previous = entry.hash;
        take(entry);
    };
    database.run_each(
        "SELECT id, at, what, session, round, seat, text, best, second, least, hash "
        "FROM log ORDER BY id",
        {},
        read);
}

std::vector<LogEntry> read_log(Database& database) {
    std::vector<LogEntry> entries;
    read_log(database, [&](const LogEntry& entry) { entries.push_back(entry); });
    return entries;
}

}  // namespace livery
