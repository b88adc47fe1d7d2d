// The database: what is committed stays, and every failure says what to do.

#include "core/database.h"

#include <cstdint>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/mount.h>

#include "support/bad_disk.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

constexpr std::int32_t kId = 0x4c765430;
using Mode = Database::Mode;
using Path = std::filesystem::path;

void make(const Path& file, int version = 1) {
    Database database(file, Mode::create, kId, version);
    Transaction transaction(database);
    database.run("CREATE TABLE t (x)");
    database.run("INSERT INTO t VALUES (?1)", {std::int64_t{7}});
    database.set_version(version);
    transaction.commit();
}

std::int64_t count_in(const Path& file, Mode mode = Mode::existing) {
    Database database(file, mode, kId, 1);
    return std::get<std::int64_t>(database.run("SELECT count(*) FROM t").at(0).at(0));
}

std::vector<std::string> files_in(const Path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

TEST(Database, GivesBackEveryKindOfValue) {
    const TemporaryFolder folder;
    Database database(folder / "Häuser & 100%?#.db", Mode::create, kId, 1);
    database.run("CREATE TABLE t (a, b, c, d)");
    const std::vector<DatabaseValue> row = {
        std::monostate(), std::int64_t{-9'007'199'254'740'993}, 0.1, std::string("grün\0rot", 9)};
    database.run("INSERT INTO t VALUES (?1, ?2, ?3, ?4)", row);
    EXPECT_EQ(database.run("SELECT a, b, c, d FROM t").at(0), row);
    EXPECT_EQ(database.run("SELECT * FROM t WHERE b = ?1", {std::int64_t{1}}).size(), 0u);
    EXPECT_TRUE(std::filesystem::exists(folder / "Häuser & 100%?#.db"));
    EXPECT_THROW(database.run("SELECT ?1"), std::invalid_argument);
}

TEST(Database, SyncsEachCommitToTheDisk) {
    const TemporaryFolder folder;
    Database database(folder / "a.db", Mode::create, kId, 1);
    EXPECT_EQ(database.run("PRAGMA journal_mode").at(0).at(0), DatabaseValue("wal"));
    EXPECT_EQ(database.run("PRAGMA synchronous").at(0).at(0), DatabaseValue(std::int64_t{2}));
}

TEST(Database, TransactionIsTakenBackUnlessCommitted) {
    const TemporaryFolder folder;
    const auto file = folder / "a.db";
    make(file);
    {
        Database database(file, Mode::existing, kId, 1);
        {
            Transaction transaction(database);
            database.run("INSERT INTO t VALUES (8)");
        }
        EXPECT_EQ(database.run("SELECT * FROM t").size(), 1u);
        Transaction transaction(database);
        database.run("INSERT INTO t VALUES (8)");
        transaction.commit();
    }
    EXPECT_EQ(count_in(file), 2);
    EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"a.db"}) << "left behind";
}

TEST(Database, ReadersSeeWhatIsCommittedAndCannotWrite) {
    const TemporaryFolder folder;
    const auto file = folder / "a.db";
    make(file);
    {
        Database writer(file, Mode::existing, kId, 1);
        Transaction transaction(writer);
        writer.run("INSERT INTO t VALUES (8)");
        EXPECT_EQ(count_in(file, Mode::read_only), 1);
        transaction.commit();
        EXPECT_EQ(count_in(file, Mode::read_only), 2);
    }
    Database reader(file, Mode::read_only, kId, 1);
    EXPECT_TRUE(fails_with([&] { reader.run("DELETE FROM t"); },
                           {"a.db", "found a file or folder that cannot be written"}));
}

TEST(Database, SecondWriterIsToldWhoHoldsIt) {
    const TemporaryFolder folder;
    const auto file = folder / "a.db";
    make(file);
    Database one(file, Mode::existing, kId, 1), other(file, Mode::existing, kId, 1);
    other.run("PRAGMA busy_timeout = 1");
    const Transaction transaction(one);
    EXPECT_TRUE(fails_with([&] { const Transaction second(other); },
                           {"a.db: found a database that another program is writing",
                            "expected that program to finish"}));
}

TEST(Database, RefusesWhatIsNoFileOfThisKindByName) {
    const TemporaryFolder folder;
    const auto open = [](const Path& file, Mode mode = Mode::existing) {
        return [=] { const Database database(file, mode, kId, 1); };
    };
    EXPECT_TRUE(fails_with(open(folder / "missing.db"), {"missing.db: found no such file"}));
    EXPECT_TRUE(fails_with(open(folder / "no folder/a.db", Mode::create),
                           {"found no folder", "expected a folder that is there"}));
    EXPECT_TRUE(fails_with(open(folder.path(), Mode::create), {"found a folder, expected a file"}));
    const auto text = folder.write("text.db", std::string(5000, 'x'));
    EXPECT_TRUE(fails_with(open(text), {"text.db: found a file that is not a database"}));
    EXPECT_TRUE(fails_with(open(folder.write("in a file", "x") / "a.db", Mode::create),
                           {"found", "in a file, which is a file, expected a folder"}));
    const auto empty = folder.write("empty.db", "");
    EXPECT_TRUE(fails_with(open(empty), {"empty.db: found an empty file"}));
    EXPECT_TRUE(fails_with(open(empty, Mode::read_only), {"empty.db: found an empty file"}));

    const auto newer = folder / "newer.db";
    make(newer, 2);
    EXPECT_TRUE(fails_with(
        open(newer),
        {"newer.db: user_version: found 2 (written by a newer Livery)", "expected at most 1"}));
    const auto other = folder / "other.db";
    { const Database database(other, Mode::create, 0x12345678, 1); }
    EXPECT_TRUE(fails_with(
        open(other),
        {"other.db: application_id: found 0x12345678, another program's", "expected 0x4c765430"}));
    EXPECT_TRUE(fails_with(open(other, Mode::create), {"application_id"}));
}

TEST(Database, NamesADamagedFile) {
    const TemporaryFolder folder;
    const auto file = folder / "a.db";
    make(file);
    {
        Database database(file, Mode::existing, kId, 1);
        for (int k = 0; k < 500; ++k) database.run("INSERT INTO t VALUES (randomblob(400))");
    }
    const auto size = std::filesystem::file_size(file);
    std::filesystem::resize_file(file, size / 2);
    EXPECT_TRUE(fails_with([&] { count_in(file); },
                           {"a.db: found a damaged database", "expected a whole one"}));
}

TEST(Database, FullDiskLosesNothingAndIsNamed) {
    const TemporaryFolder folder;
    const auto file = folder / "a.db";
    make(file);
    Database database(file, Mode::existing, kId, 1);
    const auto fill = [&] {
        for (int k = 0; k < 1000; ++k) {
            Transaction transaction(database);
            database.run("INSERT INTO t VALUES (randomblob(4000))");
            transaction.commit();
        }
    };
    {
        const FullDisk full(200'000);
        EXPECT_TRUE(fails_with(fill, {"a.db: found a full disk, expected free space"}));
    }
    const auto kept = database.run("SELECT * FROM t").size();
    EXPECT_GT(kept, 1u);
    database.run("INSERT INTO t VALUES (1)");
    EXPECT_EQ(count_in(file), static_cast<std::int64_t>(kept) + 1);
    database.run("PRAGMA max_page_count = " + std::to_string(200));
    EXPECT_TRUE(fails_with(fill, {"a.db: found a full disk, expected free space"}));
    EXPECT_EQ(database.run("PRAGMA quick_check").at(0).at(0), DatabaseValue("ok"));
}

TEST(Database, FullFileSystemIsNamed) {
    const TemporaryFolder folder;
    if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=128k") != 0) {
        GTEST_SKIP() << "needs the right to mount";
    }
    {
        const auto file = folder / "a.db";
        make(file);
        Database database(file, Mode::existing, kId, 1);
        const auto fill = [&] {
            while (true) database.run("INSERT INTO t VALUES (randomblob(4000))");
        };
        EXPECT_TRUE(fails_with(fill, {"a.db: found a full disk, expected free space"}));
        EXPECT_EQ(database.run("PRAGMA quick_check").at(0).at(0), DatabaseValue("ok"));
        std::ofstream rest(folder / "rest", std::ios::binary);
        for (int k = 0; k < 100 && rest; ++k) rest << std::string(4096, 'x') << std::flush;
        EXPECT_TRUE(fails_with([&] { const Database other(folder / "b.db", Mode::create, kId, 1); },
                               {"b.db: found a full disk, expected free space"}));
    }
    EXPECT_EQ(::umount(folder.path().c_str()), 0);
}

TEST(Database, ReadOnlyPlacesAreNamedAndReadable) {
    const TemporaryFolder folder;
    const auto inner = folder / "read only";
    std::filesystem::create_directory(inner);
    const auto file = inner / "a.db";
    make(file);
    using std::filesystem::perms;
    std::filesystem::permissions(folder.path(), perms(0755));
    std::filesystem::permissions(file, perms(0444));
    std::filesystem::permissions(inner, perms(0555));
    {
        const OrdinaryUser user;
        EXPECT_TRUE(fails_with([&] { count_in(file); },
                               {"a.db: found a file or folder that cannot be written",
                                "expected one that you may write"}));
        EXPECT_TRUE(fails_with([&] { make(inner / "b.db"); },
                               {"b.db: found a folder that cannot be written (Permission denied)",
                                "expected a folder of your own"}));
        EXPECT_EQ(count_in(file, Mode::read_only), 1);
    }
    std::filesystem::permissions(inner, perms(0755));
    EXPECT_EQ(files_in(inner), std::vector<std::string>{"a.db"});
}

TEST(Database, RefusesAValueOfAbsurdSize) {
    const TemporaryFolder folder;
    Database database(folder / "a.db", Mode::create, kId, 1);
    EXPECT_TRUE(fails_with([&] { database.run("SELECT zeroblob(100000000)"); },
                           {"a.db: found a value of more than 67108864 bytes"}));
}

/// A file of ours with one statement more.
Path with(const TemporaryFolder& folder, const std::string& statement) {
    const Path file = folder / "a.db";
    std::filesystem::remove(file);
    make(file);
    Database(file, Mode::existing, kId, 1).run(statement);
    return file;
}

TEST(Database, RunsNothingThatAFileBringsAlong) {
    const TemporaryFolder folder;
    const auto refuses = [&](const std::string& statement, std::string_view found) {
        const Path file = with(folder, statement);
        for (const Mode mode : {Mode::create, Mode::existing, Mode::read_only}) {
            if (!fails_with([&] { Database(file, mode, kId, 1); }, {"schema", found})) return false;
        }
        return true;
    };
    const std::string endless =
        "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) SELECT n FROM c";
    EXPECT_TRUE(refuses("CREATE VIEW v AS " + endless, "the view v"));
    EXPECT_TRUE(
        refuses("CREATE TRIGGER g AFTER UPDATE ON t BEGIN DELETE FROM t; END", "the trigger g"));
    // A trigger of ours is what we say, and nothing else by its name.
    const std::string ours = "CREATE TRIGGER g BEFORE DELETE ON t BEGIN SELECT 1; END";
    const std::vector<std::string> schema = {"CREATE TABLE t (x)", ours};
    const Path file = with(folder, ours);
    EXPECT_NO_THROW(Database(file, Mode::existing, kId, 1, schema));
    EXPECT_TRUE(fails_with([&] { Database(file, Mode::existing, kId, 1, {schema[0]}); },
                           {"the trigger g"}));
    EXPECT_TRUE(
        fails_with([&] { Database(file, Mode::existing, kId, 1, {ours}); }, {"the table t"}));
    // What does not end is stopped.
    Database database(file, Mode::existing, kId, 1, schema);
    EXPECT_TRUE(fails_with(
        [&] {
            database.run(
                "WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) "
                "SELECT max(n) FROM c");
        },
        {"does not come to an end"}));
    EXPECT_EQ(database.run("SELECT count(*) FROM t").at(0).at(0), DatabaseValue(std::int64_t{1}));
}

TEST(Database, DeletesNothingThatAJournalNames) {
    const TemporaryFolder folder;
    const Path file = folder / "a.db";
    make(file);
    const std::string mark = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
    folder.write("a.db-journal", mark + std::string(600, '\0') + "precious.txt" + mark);
    EXPECT_TRUE(fails_with([&] { Database(file, Mode::existing, kId, 1); },
                           {"a.db-journal", "names another file"}));
}

}  // namespace
}  // namespace livery
