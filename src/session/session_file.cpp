#include "session/session_file.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "core/error.h"
#include "core/replace_folder.h"

namespace livery {

namespace {

constexpr std::int32_t kApplicationId = 0x4c765331;  // "LvS1"
constexpr int kVersion = 1;

constexpr const char* kSchema[] = {
    "CREATE TABLE step (number INTEGER PRIMARY KEY, command TEXT NOT NULL, label TEXT NOT NULL, "
    "document TEXT NOT NULL)",
    "CREATE TABLE place (only INTEGER PRIMARY KEY CHECK (only = 1), position INTEGER NOT NULL)",
    "CREATE TABLE workspace (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"};
constexpr const char* kFirstPlace = "INSERT INTO place VALUES (1, 0)";

std::vector<std::string> schema() { return {std::begin(kSchema), std::end(kSchema)}; }

Database::Mode mode_of(SessionFile::Access access) {
    return access == SessionFile::Access::read ? Database::Mode::read_only
                                               : Database::Mode::existing;
}

template <typename Value>
const char* kind_name() {
    return std::is_same_v<Value, std::string> ? "a text" : "a whole number";
}

/// One value of a row, of the type that it must have.
template <typename Value>
Value value_in(const std::filesystem::path& file,
               const std::vector<DatabaseValue>& row,
               std::size_t column,
               const std::string& field) {
    const Value* value = column < row.size() ? std::get_if<Value>(&row[column]) : nullptr;
    if (!value) throw FileError(file, field, "a value of another type", kind_name<Value>());
    return *value;
}

/// Steps from a number on, the place in the history, values of the workspace.
void write(Database& database,
           std::int64_t number,
           const std::vector<SessionStep>& steps,
           std::int64_t position,
           const std::map<std::string, std::string>& workspace) {
    for (const SessionStep& step : steps) {
        database.run("INSERT INTO step VALUES (?1, ?2, ?3, ?4)",
                     {number++, step.command, step.label, step.document});
    }
    database.run("UPDATE place SET position = ?1", {position});
    for (const auto& [name, value] : workspace) {
        database.run("INSERT OR REPLACE INTO workspace VALUES (?1, ?2)", {name, value});
    }
}

}  // namespace

bool is_session_file(const std::filesystem::path& file) {
    // Offset 68 of an SQLite file holds its application_id, most significant byte first.
    std::array<char, 72> head{};
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(head.data(), static_cast<std::streamsize>(head.size()))) return false;
    std::uint32_t id = 0;
    for (std::size_t k = 68; k < 72; ++k) id = id << 8u | static_cast<unsigned char>(head[k]);
    return std::string(head.data(), 15) == "SQLite format 3" &&
           id == static_cast<std::uint32_t>(kApplicationId);
}

SessionFile::SessionFile(const std::filesystem::path& file, Access access)
    : database_(file, mode_of(access), kApplicationId, kVersion, schema()) {
    if (database_.version() == 0) {
        throw FileError(file, "user_version", "0, nothing written yet", std::to_string(kVersion));
    }
}

void SessionFile::create(const std::filesystem::path& file,
                         const std::vector<SessionStep>& steps,
                         std::int64_t position,
                         const std::map<std::string, std::string>& workspace) {
    auto unfinished = file;
    unfinished += ".new";
    std::error_code error;
    const auto remove_unfinished = [&] {
        std::filesystem::remove(unfinished, error);
        remove_logs_of(unfinished);
    };
    remove_unfinished();
    try {
        Database database(unfinished, Database::Mode::create, kApplicationId, kVersion);
        {
            Transaction transaction(database);
            for (const char* statement : kSchema) database.run(statement);
            database.run(kFirstPlace);
            write(database, 0, steps, position, workspace);
            database.set_version(kVersion);
            transaction.commit();
        }
        // All of it into the file itself, which alone is renamed.
        const auto taken_up = database.run("PRAGMA wal_checkpoint(TRUNCATE)");
        if (taken_up.at(0).at(0) != DatabaseValue(std::int64_t{0})) {
            throw FileError(file, "", "a database that another program reads", "a new one");
        }
    } catch (const FileError& failure) {
        remove_unfinished();
        throw FileError(file, failure.field(), failure.found(), failure.expected());
    }
    remove_logs_of(file);
    std::filesystem::rename(unfinished, file, error);
    if (error) throw FileError(file, "", "cannot rename: " + error.message(), "a writable folder");
    sync_folder(file.parent_path());
}

std::int64_t SessionFile::last_step() {
    const auto rows = database_.run("SELECT max(number) FROM step");
    return value_in<std::int64_t>(database_.file(), rows.at(0), 0, "step.number");
}

std::int64_t SessionFile::position() {
    const auto rows = database_.run("SELECT position FROM place");
    if (rows.size() != 1) {
        throw FileError(database_.file(), "place", std::to_string(rows.size()) + " rows", "one");
    }
    const auto position = value_in<std::int64_t>(database_.file(), rows[0], 0, "place.position");
    if (const auto last = last_step(); position < 0 || position > last) {
        throw FileError(database_.file(),
                        "place.position",
                        std::to_string(position),
                        "a step from 0 to " + std::to_string(last));
    }
    return position;
}

SessionStep SessionFile::step(std::int64_t number) {
    const std::string field = "step " + std::to_string(number);
    const auto rows =
        database_.run("SELECT command, label, document FROM step WHERE number = ?1", {number});
    if (rows.size() != 1) throw FileError(database_.file(), field, "nothing", "this step");
    const auto text = [&](std::size_t column, const char* name) {
        return value_in<std::string>(database_.file(), rows[0], column, field + ", " + name);
    };
    return {text(0, "command"), text(1, "label"), text(2, "document")};
}

Document SessionFile::document(std::int64_t number) {
    try {
        return parse_document(step(number).document, database_.file());
    } catch (const FileError& failure) {
        const std::string place = "step " + std::to_string(number);
        if (failure.field().starts_with(place)) throw;
        const std::string inside = failure.field().empty() ? "" : ", " + failure.field();
        throw FileError(
            failure.file(), place + ", document" + inside, failure.found(), failure.expected());
    }
}

std::map<std::string, std::string> SessionFile::workspace() {
    std::map<std::string, std::string> values;
    for (const auto& row : database_.run("SELECT name, value FROM workspace")) {
        const auto name = value_in<std::string>(database_.file(), row, 0, "workspace.name");
        values[name] = value_in<std::string>(database_.file(), row, 1, "workspace." + name);
    }
    return values;
}

void SessionFile::save(std::int64_t kept,
                       const std::vector<SessionStep>& added,
                       std::int64_t position,
                       const std::map<std::string, std::string>& workspace) {
    Transaction transaction(database_);
    database_.run("DELETE FROM step WHERE number > ?1", {kept});
    write(database_, kept + 1, added, position, workspace);
    transaction.commit();
}

void SessionFile::check_pages() {
    const auto rows = database_.run("PRAGMA quick_check(1)");
    const auto* answer = rows.empty() ? nullptr : std::get_if<std::string>(&rows[0].at(0));
    std::string found = answer ? *answer : "no answer";
    if (found != "ok") {
        std::replace(found.begin(), found.end(), '\n', ' ');
        throw FileError(database_.file(),
                        "",
                        "a damaged database (" + found + ")",
                        "a whole one; `livery session export` may still read its looks");
    }
}

void SessionFile::check_all() {
    check_pages();
    position();
    workspace();
    const std::int64_t last = last_step();
    for (std::int64_t number = 0; number <= last; ++number) document(number);
}

}  // namespace livery
