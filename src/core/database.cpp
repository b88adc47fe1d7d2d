#include "core/database.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "core/error.h"
#include "core/utf8.h"

namespace livery {

namespace {

constexpr int kBusyTimeout_ms = 5000;
constexpr int kLongestValue = 64 << 20;  ///< bytes; more is no value of ours
/// Steps of SQLite's machine in one statement: seconds. Ours take some ten for each row.
constexpr std::int64_t kMostSteps = 100'000'000;
constexpr int kStepsBetweenLooks = 10'000;

/// What was found and what was expected, in words for people.
struct Finding {
    std::string found, expected;
};

bool may_write(const std::filesystem::path& path) {
    return ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
}

/// Nothing can be written beside a file on a full disk, and SQLite says so in several ways.
bool is_full(const std::filesystem::path& file) {
    struct statfs space {};
    return ::statfs(file.parent_path().empty() ? "." : file.parent_path().c_str(), &space) == 0 &&
           space.f_bavail == 0;
}

Finding cannot_open(const std::filesystem::path& file) {
    std::error_code error;
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    const auto status = std::filesystem::status(folder, error);
    if (!std::filesystem::exists(status)) {
        return {"no folder " + folder.string(), "a folder that is there"};
    }
    if (!std::filesystem::is_directory(status)) {
        return {folder.string() + ", which is a file", "a folder"};
    }
    if (std::filesystem::is_directory(file, error)) return {"a folder", "a file"};
    if (is_full(file)) return {"a full disk", "free space"};
    if (!may_write(folder)) {
        return {"a folder that cannot be written (" + std::string(std::strerror(errno)) + ")",
                "a folder of your own"};
    }
    return {"a file that cannot be opened", "a file that you may read and write"};
}

/// Why reading or writing failed, as the system says it.
Finding disk_failure(int system_error, const std::filesystem::path& file) {
    const bool no_room = system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG;
    if (no_room || is_full(file)) return {"a full disk", "free space"};
    const char* reason = system_error ? std::strerror(system_error) : "no reason given";
    return {std::string("a disk that fails to read or write (") + reason + ")", "a working one"};
}

Finding finding_of(int code,
                   const std::string& message,
                   int system_error,
                   const std::filesystem::path& file) {
    switch (code & 0xff) {
        case SQLITE_CANTOPEN:
            return cannot_open(file);
        case SQLITE_NOTADB:
            return {"a file that is not a database", "an SQLite database"};
        case SQLITE_CORRUPT:
            return {"a damaged database (" + message + ")", "a whole one; restore a copy"};
        case SQLITE_FULL:
            return {"a full disk", "free space"};
        case SQLITE_READONLY:
        case SQLITE_PERM:
            return {"a file or folder that cannot be written", "one that you may write"};
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return {"a database that another program is writing", "that program to finish"};
        case SQLITE_IOERR:
            return disk_failure(system_error, file);
        case SQLITE_CONSTRAINT:
            return {"values that its rules refuse (" + message + ")", "values that they allow"};
        case SQLITE_INTERRUPT:
            return {"a query that does not come to an end", "a database that Livery has written"};
        case SQLITE_TOOBIG:
            return {"a value of more than " + std::to_string(kLongestValue) + " bytes",
                    "a smaller one"};
        default:
            return {"a database of another shape (" + message + ")", "one that Livery has written"};
    }
}

using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

DatabaseValue value_of(sqlite3_stmt* row, int column) {
    switch (sqlite3_column_type(row, column)) {
        case SQLITE_INTEGER:
            return static_cast<std::int64_t>(sqlite3_column_int64(row, column));
        case SQLITE_FLOAT:
            return sqlite3_column_double(row, column);
        case SQLITE_TEXT:
        case SQLITE_BLOB: {
            const void* bytes = sqlite3_column_blob(row, column);
            const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
            return bytes ? std::string(static_cast<const char*>(bytes), size) : std::string();
        }
        default:
            return std::monostate();
    }
}

int bind(sqlite3_stmt* statement, int index, const DatabaseValue& value) {
    if (const auto* whole = std::get_if<std::int64_t>(&value)) {
        return sqlite3_bind_int64(statement, index, *whole);
    }
    if (const auto* number = std::get_if<double>(&value)) {
        return sqlite3_bind_double(statement, index, *number);
    }
    if (const auto* text = std::get_if<std::string>(&value)) {
        return sqlite3_bind_text64(
            statement, index, text->data(), text->size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
    return sqlite3_bind_null(statement, index);
}

/// The file as SQLite's URI, every byte that could mean something else escaped.
std::string uri_of(const std::filesystem::path& file, bool immutable) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(file).string()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                           (byte >= 'a' && byte <= 'z') || byte == '/' || byte == '.' ||
                           byte == '-' || byte == '_';
        if (plain) {
            uri += c;
        } else {
            uri += '%';
            uri += kDigits[byte >> 4u];
            uri += kDigits[byte & 15u];
        }
    }
    return immutable ? uri + "?immutable=1" : uri;
}

std::string hexadecimal(std::int64_t value) {
    char text[24];
    std::snprintf(text, sizeof text, "0x%08llx", static_cast<unsigned long long>(value));
    return text;
}

bool can_write(const std::filesystem::path& file) {
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    return may_write(folder) && may_write(file);
}

bool has_log(const std::filesystem::path& file) {
    std::error_code error;
    auto log = file;
    log += "-wal";
    return std::filesystem::exists(log, error);
}

}  // namespace

struct Database::State {
    std::filesystem::path file;
    std::int64_t steps = 0;  ///< of the statement that runs
    std::unique_ptr<sqlite3, int (*)(sqlite3*)> handle{nullptr, &sqlite3_close_v2};

    [[noreturn]] void fail(int code) const {
        // A step that fails leaves its reason in errno only.
        const int reason = errno;
        const int noted = handle ? sqlite3_system_errno(handle.get()) : 0;
        const int system_error = noted != 0 ? noted : reason;
        const std::string message =
            handle ? sqlite3_errmsg(handle.get()) : std::string(sqlite3_errstr(code));
        const Finding finding = finding_of(code, message, system_error, file);
        throw FileError(file, "", finding.found, finding.expected);
    }

    void open(int flags, bool immutable) {
        sqlite3* opened = nullptr;
        const int code =
            sqlite3_open_v2(uri_of(file, immutable).c_str(),
                            &opened,
                            flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
                            nullptr);
        handle.reset(opened);
        if (code != SQLITE_OK) fail(code);
        sqlite3_busy_timeout(opened, kBusyTimeout_ms);
        sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kLongestValue);
        // A file from elsewhere may bring a schema of its own; nothing in it is to run.
        sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
        sqlite3_limit(opened, SQLITE_LIMIT_ATTACHED, 0);
        sqlite3_progress_handler(
            opened,
            kStepsBetweenLooks,
            [](void* state) {
                auto& taken = static_cast<State*>(state)->steps;
                return (taken += kStepsBetweenLooks) > kMostSteps ? 1 : 0;
            },
            this);
    }
};

namespace {

/// A killed program leaves a journal beside the file, from which SQLite restores it. One that names
/// a further journal has SQLite delete whatever stands at that name; we never write such.
void refuse_linked_journal(const std::filesystem::path& file) {
    auto journal = file;
    journal += "-journal";
    std::ifstream stream(journal, std::ios::binary);
    constexpr std::string_view mark = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
    char end[8] = {};
    if (!stream || !stream.seekg(-8, std::ios::end) || !stream.read(end, sizeof end)) return;
    if (std::string_view(end, sizeof end) != mark) return;
    throw FileError(journal,
                    "",
                    "a journal that names another file",
                    "none, or one that Livery has left; remove it");
}

}  // namespace

void remove_logs_of(const std::filesystem::path& database) {
    std::error_code error;
    for (const char* suffix : {"-wal", "-shm", "-journal"}) {
        auto log = database;
        log += suffix;
        std::filesystem::remove(log, error);
    }
}

void Database::check_schema(const std::vector<std::string>& schema) {
    const auto text = [](const DatabaseValue& value) {
        const auto* found = std::get_if<std::string>(&value);
        return found ? *found : std::string();
    };
    for (const auto& row :
         run("SELECT type, name, coalesce(sql, ''), rootpage, tbl_name FROM sqlite_schema")) {
        const std::string type = text(row[0]), name = text(row[1]), sql = text(row[2]);
        const auto listed = [&](const std::string& what) {
            return std::find(schema.begin(), schema.end(), what) != schema.end();
        };
        if (listed(sql) || (listed(text(row[4])) && type != "view")) continue;
        const auto* page = std::get_if<std::int64_t>(&row[3]);
        const bool stored = (type == "table" || type == "index") && page && *page > 0;
        const bool of_sqlite = type == "index" && sql.empty();
        if (of_sqlite || (stored && schema.empty())) continue;
        const std::string kind = stored || type != "table" ? type : "virtual table";
        throw FileError(state_->file,
                        "schema",
                        "the " + printable(kind, 20) + " " + printable(name, 60),
                        "only what Livery makes in such a file");
    }
}

Database::Database(const std::filesystem::path& file,
                   Mode mode,
                   std::int32_t application_id,
                   int newest_version,
                   const std::vector<std::string>& schema)
    : state_(std::make_unique<State>()) {
    state_->file = file;
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status)) throw FileError(file, "", "a folder", "a file");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw FileError(file, "", "a pipe or a device", "a file");
    }
    const bool exists = std::filesystem::exists(status);
    const bool empty = !exists || std::filesystem::file_size(file, error) == 0;
    if (mode != Mode::create) {
        if (!exists) throw FileError(file, "", "no such file", "a file");
        if (empty) throw FileError(file, "", "an empty file", "an SQLite database");
    }
    // A reader makes the log's index beside the file and only one that may write clears it away
    // again. Where nobody can write, nothing changes either: SQLite then needs no index.
    refuse_linked_journal(file);
    const bool only_reading = mode == Mode::read_only && !can_write(file);
    int flags = only_reading ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    if (mode == Mode::create) flags |= SQLITE_OPEN_CREATE;
    state_->open(flags, only_reading && !has_log(file));
    if (mode != Mode::read_only && sqlite3_db_readonly(state_->handle.get(), "main") == 1) {
        state_->fail(SQLITE_READONLY);
    }

    const auto number = [&](const char* pragma) {
        const auto rows = run(pragma);
        const auto* value =
            rows.empty() || rows[0].empty() ? nullptr : std::get_if<std::int64_t>(&rows[0][0]);
        return value ? *value : 0;
    };
    const std::int64_t pages = number("PRAGMA page_count");
    const std::int64_t found_id = number("PRAGMA application_id");
    if (pages != 0 && found_id != application_id) {
        throw FileError(file,
                        "application_id",
                        hexadecimal(found_id) + ", another program's or another kind of file",
                        hexadecimal(application_id));
    }
    if (const int found = version(); found > newest_version || found < 0) {
        throw FileError(file,
                        "user_version",
                        std::to_string(found) + " (written by a newer Livery)",
                        "at most " + std::to_string(newest_version));
    }
    run("PRAGMA cell_size_check = ON");
    // Checking an index reads the table all over; SQLite's own 2 MB would read it again and again.
    run("PRAGMA cache_size = -16000");
    check_schema(schema);
    if (mode == Mode::read_only) {
        run("PRAGMA query_only = 1");
        return;
    }
    if (pages == 0) run("PRAGMA application_id = " + std::to_string(application_id));
    const auto journal = run("PRAGMA journal_mode = WAL");
    if (journal.empty() || journal[0].empty() || journal[0][0] != DatabaseValue("wal")) {
        throw FileError(file, "", "a folder without shared memory between programs", "a local one");
    }
    run("PRAGMA synchronous = FULL");
}

Database::~Database() = default;

std::vector<std::vector<DatabaseValue>> Database::run(std::string_view sql,
                                                      const std::vector<DatabaseValue>& values) {
    std::vector<Row> rows;
    run_each(sql, values, [&](const Row& row) { rows.push_back(row); });
    return rows;
}

void Database::run_each(std::string_view sql,
                        const std::vector<DatabaseValue>& values,
                        const std::function<void(const Row&)>& take) {
    sqlite3_stmt* prepared = nullptr;
    int code = sqlite3_prepare_v2(
        state_->handle.get(), sql.data(), static_cast<int>(sql.size()), &prepared, nullptr);
    const Statement statement(prepared, &sqlite3_finalize);
    if (code != SQLITE_OK) state_->fail(code);
    check_argument(
        sqlite3_bind_parameter_count(prepared) == static_cast<int>(values.size()),
        "Database::run: " + std::to_string(values.size()) + " values for " + std::string(sql));
    for (std::size_t k = 0; k < values.size(); ++k) {
        code = bind(prepared, static_cast<int>(k) + 1, values[k]);
        if (code != SQLITE_OK) state_->fail(code);
    }
    state_->steps = 0;
    errno = 0;
    // Where waiting could deadlock, as when two programs make one file, SQLite does not wait but
    // says that it is busy. Outside a transaction nothing of ours is held: try again.
    const auto give_up =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(kBusyTimeout_ms);
    while (((code = sqlite3_step(prepared)) & 0xff) == SQLITE_BUSY &&
           sqlite3_get_autocommit(state_->handle.get()) != 0 &&
           std::chrono::steady_clock::now() < give_up) {
        sqlite3_reset(prepared);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    Row row;
    for (; code == SQLITE_ROW; code = sqlite3_step(prepared)) {
        row.clear();
        for (int column = 0; column < sqlite3_column_count(prepared); ++column) {
            row.push_back(value_of(prepared, column));
        }
        take(row);
    }
    if (code != SQLITE_DONE) state_->fail(code);
}

int Database::version() const {
    const auto rows = const_cast<Database*>(this)->run("PRAGMA user_version");
    return static_cast<int>(std::get<std::int64_t>(rows.at(0).at(0)));
}

void Database::set_version(int version) { run("PRAGMA user_version = " + std::to_string(version)); }

const std::filesystem::path& Database::file() const { return state_->file; }

Transaction::Transaction(Database& database) : database_(database) {
    database_.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
    if (done_) return;
    try {
        database_.run("ROLLBACK");
    } catch (const FileError&) {
        // A full disk or an unreadable page has rolled it back already.
    }
}

void Transaction::commit() {
    database_.run("COMMIT");
    done_ = true;
}

}  // namespace livery
