#include "core/cache.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/log.h"
#include "core/paths.h"
#include "support/bad_disk.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

class CacheTest : public ::testing::Test {
  protected:
    CacheTest() {
        ::setenv("LIVERY_HOME", (folder_ / "home").c_str(), 1);
        open_log(folder_ / "log");
    }
    ~CacheTest() override {
        open_log("/dev/null");
        ::unsetenv("LIVERY_HOME");
    }
    std::string told() const { return read_text_file(folder_ / "log"); }
    fs::path kept(const std::string& name) const { return folder_ / "home/cache" / name; }

    TemporaryFolder folder_;
};

TEST_F(CacheTest, GivesBackWhatWasKeptAndNothingElse) {
    EXPECT_FALSE(read_cache("a"));
    const std::string bytes("any bytes \0 at all", 18);
    write_cache("a", bytes);
    write_cache("b", "");
    EXPECT_EQ(read_cache("a"), bytes);
    EXPECT_EQ(read_cache("b"), "");
    write_cache("a", "newer");
    EXPECT_EQ(read_cache("a"), "newer");
}

TEST_F(CacheTest, WhatIsDamagedIsNotThereAndTheLogSaysSo) {
    const std::string bytes(1000, 'x');
    for (const auto& damage : {std::string(), std::string(500, 'x'), std::string(1032, 'y')}) {
        write_cache("a", bytes);
        std::ofstream(kept("a"), std::ios::binary) << damage;
        EXPECT_FALSE(read_cache("a")) << damage.size();
        EXPECT_FALSE(fs::exists(kept("a")));
        EXPECT_NE(told().find("is damaged; what it held is worked out again"), std::string::npos);
    }
    // One byte, and a whole file under another's name
    write_cache("a", bytes);
    fs::copy_file(kept("a"), kept("b"));
    EXPECT_FALSE(read_cache("b"));
    std::fstream stream(kept("a"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(700).put('y');
    stream.close();
    EXPECT_FALSE(read_cache("a"));
}

TEST_F(CacheTest, WhatWasNotReadForLongestGoesFirst) {
    const auto age = [&](const char* name, int hours) {
        fs::last_write_time(kept(name),
                            fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    for (const char* name : {"a", "b", "c"}) write_cache(name, std::string(100, 'x'), 500);
    age("a", 3);
    age("b", 2);
    age("c", 1);
    EXPECT_TRUE(read_cache("a"));
    write_cache("d", std::string(100, 'x'), 400);
    EXPECT_TRUE(read_cache("a"));
    EXPECT_FALSE(read_cache("b"));
    EXPECT_TRUE(read_cache("c"));
    EXPECT_TRUE(read_cache("d"));
    write_cache("too large", std::string(1000, 'x'), 400);
    EXPECT_FALSE(read_cache("too large"));
    EXPECT_TRUE(read_cache("d"));
}

TEST_F(CacheTest, APlaceThatCannotBeWrittenOrReadIsOnlyToldToTheLog) {
    fs::create_directories(kept("a"));  // a folder in its place
    EXPECT_FALSE(read_cache("a"));
    EXPECT_NE(told().find("a folder"), std::string::npos);
    fs::remove_all(folder_ / "home");
    fs::create_directories(folder_ / "home");
    fs::permissions(folder_ / "home", fs::perms::owner_read | fs::perms::owner_exec);
    {
        const OrdinaryUser user;
        write_cache("a", "bytes");
        EXPECT_FALSE(read_cache("a"));
    }
    fs::permissions(folder_ / "home", fs::perms::all);
    EXPECT_FALSE(fs::exists(folder_ / "home/cache"));
    fs::remove_all(folder_ / "home");
    std::ofstream(folder_ / "home") << "a file where the user's folder should be";
    write_cache("a", "bytes");
    EXPECT_FALSE(read_cache("a"));
    EXPECT_NE(told().find("it is worked out again next time"), std::string::npos);
    fs::remove(folder_ / "home");
    {
        const FullDisk disk(100);
        write_cache("a", std::string(1000, 'x'));
    }
    EXPECT_FALSE(read_cache("a"));
    EXPECT_TRUE(fs::is_empty(folder_ / "home/cache"));
}

}  // namespace
}  // namespace livery
