// Files that are not what they should be, and places that cannot be written.

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "evaluation/ballot_file.h"
#include "evaluation/ballots.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"
#include "support/without_rights.h"

namespace livery {
namespace {

/// A file with a closed round of five votes and an open one.
std::filesystem::path some_ballots(const TemporaryFolder& folder, const char* name = "votes") {
    const auto file = folder / name;
    BallotStore store(file);
    const int round = store.open_round({"a", "b", "c"}, "1234");
    for (int k = 0; k < 5; ++k) {
        store.vote(round, "voter " + std::to_string(k), {k % 3, (k + 1) % 3});
    }
    store.close_round(round);
    store.vote(store.open_round({"x", "y"}, ""), "Ann", {0, 1});
    return file;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

::testing::AssertionResult opening_fails(const std::filesystem::path& file,
                                         std::initializer_list<std::string_view> parts) {
    return fails_with([&] { BallotStore{file}; }, parts);
}

TEST(BadBallots, NotAFileOfOurs) {
    const TemporaryFolder folder;
    EXPECT_TRUE(opening_fails(folder.path(), {folder.path().string()}));
    EXPECT_TRUE(opening_fails(folder / "no/votes", {"no/votes"}));
    folder.write("text", "dear diary, today I voted for the red one; it glitters.\n");
    EXPECT_TRUE(opening_fails(folder / "text", {"text", "not a database"}));
    {
        Database other(folder / "session", Database::Mode::create, 0x12345678, 1);
        other.run("CREATE TABLE looks (id INTEGER PRIMARY KEY) STRICT");
        other.set_version(1);
    }
    EXPECT_TRUE(opening_fails(folder / "session", {"session"}));
    EXPECT_EQ(bytes_of(folder / "text").substr(0, 10), "dear diary") << "it was written to";
}

TEST(BadBallots, OfANewerVersion) {
    const TemporaryFolder folder;
    const auto file = some_ballots(folder);
    raw_ballots(file).set_version(6);
    EXPECT_TRUE(opening_fails(file, {"votes", "6 (written by a newer Livery)", "at most 5"}));
}

TEST(BadBallots, OfAnOlderVersionThanAnyoneHas) {
    const TemporaryFolder folder;
    const auto file = some_ballots(folder);
    raw_ballots(file).set_version(3);
    EXPECT_TRUE(opening_fails(file, {"votes", "user_version", "3", "4 or 5"}));
}

TEST(BadBallots, Truncated) {
    const TemporaryFolder folder;
    const auto file = some_ballots(folder);
    const std::string whole = bytes_of(file);
    ASSERT_GT(whole.size(), 8192u) << "the write-ahead log was not folded in";
    for (const std::size_t size : {std::size_t{50}, std::size_t{4096}, whole.size() / 2}) {
        const auto name = "cut " + std::to_string(size);
        folder.write(name, whole.substr(0, size));
        EXPECT_TRUE(opening_fails(folder / name, {name})) << size;
    }
}

TEST(BadBallots, Overwritten) {
    const TemporaryFolder folder;
    const std::string whole = bytes_of(some_ballots(folder));
    // Every page but the first in turn: the damage is found at opening, or touched nothing stored.
    int found = 0, pages = 0;
    for (std::size_t at = 4096; at + 4096 <= whole.size(); at += 4096) {
        std::string bytes = whole;
        bytes.replace(at, 4096, 4096, '\xa5');
        const auto name = "page " + std::to_string(at / 4096);
        folder.write(name, bytes);
        ++pages;
        try {
            const BallotStore store(folder / name);
            EXPECT_EQ(store.rounds().size(), 2u) << name;
        } catch (const FileError& error) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            ++found;
        }
    }
    EXPECT_GT(found, pages - 3);
}

TEST(BadBallots, Altered) {
    const TemporaryFolder folder;
    const auto after = [&](const char* name, std::initializer_list<const char*> statements) {
        const auto file = some_ballots(folder, name);
        auto raw = raw_ballots(file);
        for (const char* event : {"UPDATE", "DELETE"}) {
            raw.run(std::string("DROP TRIGGER log_without_") + event);
        }
        for (const char* statement : statements) raw.run(statement);
        return file;
    };
    const std::string_view fix = "ballots as Livery wrote them; go on with a copy";
    // Entries 1 to 6 open the first round, then each voter has a seat and a ballot.
    EXPECT_TRUE(opening_fails(after("a", {"UPDATE log SET best = 2, second = 0 WHERE id = 8"}),
                              {"a: log entry 8", "a change since it was written", fix}));
    EXPECT_TRUE(opening_fails(after("b", {"DELETE FROM log WHERE id = 8"}),
                              {"b: log entry 8", "none: the next is 9", fix}));
    EXPECT_TRUE(opening_fails(after("c", {"DELETE FROM log WHERE id > 17"}),
                              {"c: log", "another last entry than was sealed", fix}));
    EXPECT_TRUE(
        opening_fails(after("d", {"UPDATE log SET id = -id", "UPDATE log SET id = 24 + id"}),
                      {"d: log entry 1", "a change since it was written", fix}));
    EXPECT_TRUE(opening_fails(after("e", {"DELETE FROM seal"}), {"e: log", "no seal", fix}));
    EXPECT_TRUE(opening_fails(after("f", {"UPDATE seal SET entry = 8"}),
                              {"f: log", "another last entry than was sealed", fix}));
    EXPECT_TRUE(opening_fails(after("g", {"DROP TABLE log"}), {"g", "log"}));
    EXPECT_TRUE(opening_fails(
        after("h", {"CREATE TRIGGER t AFTER INSERT ON log BEGIN DELETE FROM log; END"}),
        {"h: schema", "the trigger t"}));
}

TEST(BadBallots, ReadOnly) {
    const TemporaryFolder folder;
    const auto file = some_ballots(folder);
    std::filesystem::permissions(file, std::filesystem::perms(0444));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    {
        const WithoutRights nobody;
        EXPECT_TRUE(opening_fails(file, {"votes"}));
        EXPECT_TRUE(opening_fails(folder / "new", {"new"}));
    }
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    std::filesystem::permissions(file, std::filesystem::perms(0644));
    EXPECT_EQ(BallotStore(file).rounds().size(), 2u);
}

/// No file of this process may grow beyond a size: what a full disk is like.
class SmallDisk {
  public:
    explicit SmallDisk(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
        EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &was_), 0);
        const rlimit small{bytes, was_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    }
    ~SmallDisk() {
        EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &was_), 0);
        std::signal(SIGXFSZ, signal_);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

  private:
    rlimit was_{};
    void (*signal_)(int);
};

TEST(BadBallots, AFullDiskLosesNothingConfirmed) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    int confirmed = 0;
    {
        BallotStore store(file);
        const int round = store.open_round({"a", "b"}, "");
        {
            const SmallDisk disk(200'000);
            const auto vote_until_full = [&] {
                for (; confirmed < 10'000; ++confirmed) {
                    store.vote(round, "voter " + std::to_string(confirmed), {0, 1});
                }
            };
            EXPECT_TRUE(fails_with(vote_until_full, {"votes"}));
            EXPECT_GT(confirmed, 0);
            EXPECT_EQ(store.open_round().value().ballots, confirmed);
        }
        // Room again: the same store goes on.
        store.vote(round, "voter " + std::to_string(confirmed), {0, 1});
        ++confirmed;
    }
    EXPECT_EQ(BallotStore(file).open_round().value().ballots, confirmed);
}

}  // namespace
}  // namespace livery
