#include "core/log.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/time.h"
#include "support/temporary_folder.h"
#include "support/without_rights.h"

namespace livery {
namespace {

std::string content(const std::filesystem::path& file) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
    std::vector<std::string> lines;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// What comes after the time.
std::string body(const std::string& line) { return line.substr(line.find(' ') + 1); }

// Must stay the first of this file: nothing is open yet.
TEST(Log, GoesNowhereUntilOpened) {
    const TemporaryFolder folder;
    ::testing::internal::CaptureStderr();
    log_line(LogLevel::error, "nobody reads this");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Log, HoldsTimeLevelAndTextOnOneLine) {
    const TemporaryFolder folder;
    const auto file = folder / "made/when needed/Ümläut.log";
    open_log(file);
    log_line(LogLevel::info, "opened");
    log_line(LogLevel::warning, "two\nlines\r\nwith\ta tab and \x1b[31mred");
    log_line(LogLevel::error, std::string("a\0zero", 6));
    log_line(LogLevel::info, "");
    log_line(LogLevel::info, "Grün 緑");
    const auto lines = lines_of(file);
    ASSERT_EQ(lines.size(), 5u);
    const std::regex form(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z (info|warning|error) .*)");
    for (const auto& line : lines) EXPECT_TRUE(std::regex_match(line, form)) << line;
    EXPECT_EQ(body(lines[0]), "info opened");
    EXPECT_EQ(body(lines[1]), "warning two lines  with a tab and  [31mred");
    EXPECT_EQ(body(lines[2]), "error a zero");
    EXPECT_EQ(body(lines[3]), "info ");
    EXPECT_EQ(body(lines[4]), "info Grün 緑");
    EXPECT_EQ(content(file).back(), '\n');
}

TEST(Log, AppendsToWhatIsThere) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.log", "of yesterday\n");
    open_log(file);
    log_line(LogLevel::info, "of today");
    open_log(file);
    log_line(LogLevel::info, "again");
    const auto lines = lines_of(file);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "of yesterday");
    EXPECT_EQ(body(lines[2]), "info again");
}

TEST(Log, RotatesAndKeepsAsManyAsAsked) {
    const TemporaryFolder folder;
    const auto file = folder / "a.log";
    const std::size_t line_bytes = std::string("2026-11-21T08:36:00.123Z info 00\n").size();
    open_log(file, 10 * line_bytes, 3);
    for (int k = 0; k < 65; ++k) {
        log_line(LogLevel::info, (k < 10 ? "0" : "") + std::to_string(k));
    }
    // 65 lines, ten a file: 5 in the newest, and 20 to 59 in the three kept.
    const auto first_and_count = [](const std::filesystem::path& name) {
        const auto lines = lines_of(name);
        return std::pair(lines.empty() ? "" : body(lines[0]), lines.size());
    };
    EXPECT_EQ(first_and_count(file), std::pair(std::string("info 60"), std::size_t{5}));
    EXPECT_EQ(first_and_count(folder / "a.log.1"),
              std::pair(std::string("info 50"), std::size_t{10}));
    EXPECT_EQ(first_and_count(folder / "a.log.2"),
              std::pair(std::string("info 40"), std::size_t{10}));
    EXPECT_EQ(first_and_count(folder / "a.log.3"),
              std::pair(std::string("info 30"), std::size_t{10}));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.log.4"));
    EXPECT_EQ(std::filesystem::file_size(folder / "a.log.1"), 10 * line_bytes);
}

TEST(Log, KeepingNoneStartsAnew) {
    const TemporaryFolder folder;
    open_log(folder / "a.log", 100, 0);
    for (int k = 0; k < 50; ++k) log_line(LogLevel::info, "number " + std::to_string(k));
    EXPECT_LE(std::filesystem::file_size(folder / "a.log"), 100u);
    EXPECT_EQ(body(lines_of(folder / "a.log").back()), "info number 49");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.log.1"));
}

TEST(Log, ALineLongerThanAFileHasOneOfItsOwn) {
    const TemporaryFolder folder;
    open_log(folder / "a.log", 100, 2);
    log_line(LogLevel::info, "short");
    log_line(LogLevel::info, std::string(1000, 'x'));
    log_line(LogLevel::info, "short again");
    EXPECT_EQ(lines_of(folder / "a.log").size(), 1u);
    EXPECT_EQ(lines_of(folder / "a.log.1").size(), 1u);
    EXPECT_EQ(lines_of(folder / "a.log.1")[0].size(), 1000 + 30u);
    EXPECT_EQ(body(lines_of(folder / "a.log.2")[0]), "info short");
}

TEST(Log, LosesNoLineOfManyThreads) {
    const TemporaryFolder folder;
    const int threads = 8, each = 300;
    open_log(folder / "a.log", 20'000, 50);
    std::vector<std::thread> writers;
    for (int thread = 0; thread < threads; ++thread) {
        writers.emplace_back([thread] {
            for (int k = 0; k < each; ++k) {
                log_line(LogLevel::info, std::to_string(thread) + "/" + std::to_string(k));
            }
        });
    }
    for (auto& writer : writers) writer.join();
    std::set<std::string> found;
    std::size_t lines = 0, files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        ++files;
        EXPECT_LE(entry.file_size(), 20'000u);
        for (const auto& line : lines_of(entry.path())) {
            found.insert(body(line));
            ++lines;
        }
    }
    EXPECT_GT(files, 3u);
    EXPECT_EQ(lines, std::size_t{threads * each});
    EXPECT_EQ(found.size(), std::size_t{threads * each});
}

TEST(Log, LosesNoLineOfTwoPrograms) {
    const TemporaryFolder folder;
    const auto write_all = [&](const std::string& who) {
        open_log(folder / "a.log", 5'000, 50);
        for (int k = 0; k < 400; ++k) log_line(LogLevel::info, who + std::to_string(k));
    };
    std::vector<pid_t> programs;
    for (const char* who : {"a", "b"}) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            write_all(who);
            ::_exit(0);
        }
        programs.push_back(child);
    }
    for (const pid_t child : programs) {
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_EQ(status, 0);
    }
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        for (const auto& line : lines_of(entry.path())) found.insert(body(line));
    }
    EXPECT_EQ(found.size(), 800u);
}

TEST(Log, AFullDiskIsSaidOnceAndTheLogGoesOnAfterwards) {
    const TemporaryFolder folder;
    const auto file = folder / "a.log";
    std::filesystem::create_symlink("/dev/full", file);
    ::testing::internal::CaptureStderr();
    open_log(file);
    for (int k = 0; k < 5; ++k) log_line(LogLevel::info, "lost");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "livery: the log " + file.string() +
                  " cannot be written: No space left on device; going on without it\n");
    std::filesystem::remove(file);  // the disk has room again
    log_line(LogLevel::info, "kept");
    ASSERT_EQ(lines_of(file).size(), 1u);
    EXPECT_EQ(body(lines_of(file)[0]), "info kept");
}

TEST(Log, AReadOnlyFolderIsSaidOnce) {
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    ::testing::internal::CaptureStderr();
    {
        const WithoutRights nobody;
        open_log(folder / "logs/a.log");
        for (int k = 0; k < 5; ++k) log_line(LogLevel::info, "lost");
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "livery: the log " + (folder / "logs/a.log").string() +
                  " cannot be written: Permission denied; going on without it\n");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

TEST(Log, ALogThatCannotBeRotatedStaysWithinItsSize) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.log", "");
    std::filesystem::permissions(file, std::filesystem::perms(0666));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    ::testing::internal::CaptureStderr();
    {
        const WithoutRights nobody;
        open_log(file, 200, 2);
        for (int k = 0; k < 20; ++k) log_line(LogLevel::info, "a line of a certain length");
    }
    const auto said = ::testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("Permission denied"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_LE(std::filesystem::file_size(file), 200u);
    EXPECT_GT(std::filesystem::file_size(file), 0u);
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
}

TEST(Log, SomethingElseInItsPlaceIsSaidOnce) {
    const TemporaryFolder folder;
    folder.write("file", "");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const auto& [place, reason] : std::vector<std::pair<std::filesystem::path, std::string>>{
             {folder.path(), "Is a directory"},
             {folder / "file/a.log", "Not a directory"},
             {folder / "pipe", "No such device or address"}}) {
        ::testing::internal::CaptureStderr();
        open_log(place);
        log_line(LogLevel::info, "lost");
        log_line(LogLevel::info, "lost");
        const auto said = ::testing::internal::GetCapturedStderr();
        EXPECT_NE(said.find(place.string() + " cannot be written: " + reason), std::string::npos)
            << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
}

TEST(Log, RefusesSizesThatMakeNoSense) {
    EXPECT_THROW(open_log(""), std::invalid_argument);
    EXPECT_THROW(open_log("a.log", 0), std::invalid_argument);
    EXPECT_THROW(open_log("a.log", 100, -1), std::invalid_argument);
}

TEST(Utc, IsIso8601) {
    EXPECT_TRUE(std::regex_match(utc_now(), std::regex(R"(20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
    EXPECT_TRUE(
        std::regex_match(utc_now_ms(), std::regex(R"(20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)")));
}

}  // namespace
}  // namespace livery
