// SQLite behind a few values; nothing else names it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace livery {

using DatabaseValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// One open database file, WAL with synchronous=FULL: what a transaction committed survives a kill
/// and a power cut. For one thread at a time. Every failure throws FileError (missing folder,
/// read-only, full disk, not a database, corrupt, newer `application version`), and leaves what was
/// committed before.
class Database {
  public:
    /// `read_only` changes nothing that the file holds; an unfinished log of a killed program may
    /// be taken up into it.
    enum class Mode { create, existing, read_only };
    /// `application_id` tells our kinds of file apart (PRAGMA application_id); a file of another
    /// kind or with a user_version above `newest_version` is refused by name. What a file's own
    /// schema may run is nothing: views, virtual tables and triggers are refused, but for what
    /// `schema` lists, the statements that make such a file. Where it lists any, no other table
    /// is taken either, but for those listed by their bare names, with all that belongs to them:
    /// tables of older files, which the caller drops.
    Database(const std::filesystem::path& file,
             Mode mode,
             std::int32_t application_id,
             int newest_version,
             const std::vector<std::string>& schema = {});
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    /// Runs one statement; rows come back as values. Parameters are bound to ?1, ?2, ... One that
    /// takes more steps than any of ours throws FileError.
    std::vector<std::vector<DatabaseValue>> run(std::string_view sql,
                                                const std::vector<DatabaseValue>& values = {});
    /// The same, one row at a time, for results that are not to be held in memory as a whole.
    using Row = std::vector<DatabaseValue>;
    void run_each(std::string_view sql,
                  const std::vector<DatabaseValue>& values,
                  const std::function<void(const Row&)>& take);
    int version() const;  ///< user_version; 0: new
    void set_version(int version);
    const std::filesystem::path& file() const;

  private:
    struct State;
    void check_schema(const std::vector<std::string>& schema);
    std::unique_ptr<State> state_;
};

/// Removes what SQLite keeps beside a database: a log that a killed program left there would be
/// taken up into the next file of that name. Nobody may have the database open.
void remove_logs_of(const std::filesystem::path& database);

/// BEGIN IMMEDIATE ... COMMIT; rolled back when destroyed without commit().
class Transaction {
  public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

  private:
    Database& database_;
    bool done_ = false;
};

}  // namespace livery
