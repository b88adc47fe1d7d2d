#include "evaluation/ballot_log.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/hash.h"

namespace livery {

namespace {

/// An entry as a row of the table, whose columns are named after those of a vote. What they hold of
/// the others stands in columns_of() and what_in() alone.
struct Columns {
    std::string name;
    int seat = 0;
    std::string text = {};
    int best = 0, second = 0, least = -1;
};

template <typename... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

Columns columns_of(const LogEntry::What& what) {
    using E = LogEntry;
    return std::visit(
        Overloaded{
            [](const E::Session&) { return Columns{"session"}; },
            [](const E::Seat& seat) {
                return Columns{"seat", seat.number, seat.who, seat.phone ? 1 : 0};
            },
            [](const E::Open& open) {
                return Columns{"open", 0, open.calibration_id, open.asks_least ? 1 : 0, open.seed};
            },
            [](const E::Design& design) {
                return Columns{"design", 0, design.name, design.index, design.code};
            },
            [](const E::Scale& scale) {
                return Columns{"scale", 0, scale.scale.low + '\t' + scale.scale.high, scale.index};
            },
            [](const E::Repeat& repeat) {
                const SeriesPlace& place = repeat.place;
                return Columns{"series", place.series, "", place.repeats, place.follows};
            },
            [](const E::Plan& plan) {
                return Columns{"plan", 0, text_of(plan.plan)};
            },
            [](const E::Voting&) { return Columns{"voting"}; },
            [](const E::Shown& shown) {
                return Columns{"shown", shown.state.sitting, text_of(shown.state, shown.event)};
            },
            [](const E::Vote& vote) {
                const Ballot& ballot = vote.ballot;
                return Columns{"vote", vote.seat, "", ballot.best, ballot.second, ballot.least};
            },
            [](const E::Rating& rating) {
                return Columns{"rated",
                               rating.seat,
                               "",
                               rating.design,
                               rating.scale,
                               rating.step == 0 ? -1 : rating.step};
            },
            [](const E::Close&) { return Columns{"close"}; }},
        what);
}

/// Nothing for a name that is none. `file` is named where a text cannot be read.
std::optional<LogEntry::What> what_in(const Columns& row, const std::string& file) {
    using E = LogEntry;
    const std::string& name = row.name;
    if (name == "vote") return E::Vote{row.seat, {row.best, row.second, row.least}};
    if (name == "rated") return E::Rating{row.seat, row.best, row.second, std::max(row.least, 0)};
    if (name == "session") return E::Session{};
    if (name == "seat") return E::Seat{row.seat, row.best != 0, row.text};
    if (name == "open") return E::Open{row.text, row.best != 0, row.second};
    if (name == "design") return E::Design{row.best, row.text, row.second};
    if (name == "scale") {
        const std::size_t tab = std::min(row.text.find('\t'), row.text.size());
        return E::Scale{
            row.best,
            {row.text.substr(0, tab), row.text.substr(std::min(tab + 1, row.text.size()))}};
    }
    if (name == "series") return E::Repeat{{row.seat, row.best, row.second}};
    if (name == "plan") return E::Plan{parse_plan(row.text, file)};
    if (name == "voting") return E::Voting{};
    if (name == "shown") {
        const PresentationStep step = parse_step(row.text, file);
        return E::Shown{step.state, step.event};
    }
    if (name == "close") return E::Close{};
    return std::nullopt;
}

std::string sealed(const std::string& previous, const LogEntry& entry, const Columns& row) {
    Hasher hasher;
    hasher.add(previous);
    for (const int number :
         {entry.id, entry.session, entry.round, row.seat, row.best, row.second, row.least}) {
        hasher.add(std::to_string(number) + ' ');
    }
    // Their lengths too: no two entries are one run of bytes.
    for (const std::string_view text :
         {std::string_view(row.name), std::string_view(entry.at), std::string_view(row.text)}) {
        hasher.add(std::to_string(text.size()) + ' ');
        hasher.add(text);
    }
    return hasher.hex();
}

/// What a column must hold; FileError otherwise.
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

}  // namespace

void fail_ballots(const Database& database, std::string field, std::string found) {
    throw FileError(database.file(),
                    std::move(field),
                    std::move(found),
                    "ballots as Livery wrote them; go on with a copy, or with a new file");
}

std::vector<std::string> log_schema() {
    std::vector<std::string> statements = {
        "CREATE TABLE log ("
        " id INTEGER PRIMARY KEY,"
        " at TEXT NOT NULL,"
        " what TEXT NOT NULL,"
        " session INTEGER NOT NULL,"
        " round INTEGER NOT NULL,"
        " seat INTEGER NOT NULL,"
        " text TEXT NOT NULL,"
        " best INTEGER NOT NULL,"
        " second INTEGER NOT NULL,"
        " least INTEGER NOT NULL,"
        " hash TEXT NOT NULL) STRICT"};
    for (const char* event : {"UPDATE", "DELETE"}) {
        statements.push_back(
            std::string("CREATE TRIGGER log_without_") + event + " BEFORE " + event +
            " ON log BEGIN SELECT RAISE(ABORT, 'the log is only appended to'); END");
    }
    // Its last entry: what is cut off at the end is missed.
    statements.emplace_back(
        "CREATE TABLE seal (id INTEGER PRIMARY KEY CHECK (id = 1),"
        " entry INTEGER NOT NULL, hash TEXT NOT NULL) STRICT");
    return statements;
}

LogSeal seal_of(Database& database) {
    const auto rows = database.run("SELECT entry, hash FROM seal");
    if (rows.empty()) fail_ballots(database, "log", "no seal");
    return {as_int(database, rows[0][0]), as_text(database, rows[0][1])};
}

void seal_log(Database& database, const LogSeal& end) {
    database.run("INSERT OR REPLACE INTO seal VALUES (1, ?1, ?2)",
                 {std::int64_t{end.entry}, end.hash});
}

void append_to_log(Database& database, LogSeal& end, LogEntry& entry) {
    const Columns row = columns_of(entry.what);
    entry.id = end.entry + 1;
    entry.hash = sealed(end.hash, entry, row);
    database.run("INSERT INTO log VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)",
                 {std::int64_t{entry.id},
                  entry.at,
                  row.name,
                  std::int64_t{entry.session},
                  std::int64_t{entry.round},
                  std::int64_t{row.seat},
                  row.text,
                  std::int64_t{row.best},
                  std::int64_t{row.second},
                  std::int64_t{row.least},
                  entry.hash});
    end = {entry.id, entry.hash};
    seal_log(database, end);
}

void read_log(Database& database, LogSeal& from, const std::function<void(const LogEntry&)>& take) {
    const std::string file = database.file().string();
    LogEntry entry;
    Columns columns;
    const auto read = [&](const Database::Row& row) {
        entry.id = from.entry + 1;
        const auto fail = [&](const std::string& found) {
            fail_ballots(database, "log entry " + std::to_string(entry.id), found);
        };
        if (const int id = as_int(database, row[0]); id != entry.id) {
            fail("none: the next is " + std::to_string(id));
        }
        entry.at = as_text(database, row[1]);
        columns.name = as_text(database, row[2]);
        entry.session = as_int(database, row[3]);
        entry.round = as_int(database, row[4]);
        columns.seat = as_int(database, row[5]);
        columns.text = as_text(database, row[6]);
        columns.best = as_int(database, row[7]);
        columns.second = as_int(database, row[8]);
        columns.least = as_int(database, row[9]);
        entry.hash = as_text(database, row[10]);
        if (entry.hash != sealed(from.hash, entry, columns)) fail("a change since it was written");
        auto what = what_in(columns, file);
        if (!what) fail("an entry of another kind");
        entry.what = std::move(*what);
        take(entry);
        from = {entry.id, entry.hash};
    };
    database.run_each(
        "SELECT id, at, what, session, round, seat, text, best, second, least, hash "
        "FROM log WHERE id > ?1 ORDER BY id",
        {std::int64_t{from.entry}},
        read);
}

}  // namespace livery
