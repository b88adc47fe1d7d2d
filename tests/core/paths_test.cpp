#include "core/paths.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/bad_disk.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Sets a variable for a test, and puts it back.
class Environment {
  public:
    Environment(const char* name, const std::string& value) : name_(name) {
        const char* old = std::getenv(name);
        had_ = old != nullptr;
        if (had_) old_ = old;
        ::setenv(name, value.c_str(), 1);
    }
    ~Environment() {
        if (had_) {
            ::setenv(name_, old_.c_str(), 1);
        } else {
            ::unsetenv(name_);
        }
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    const char* name_;
    std::string old_;
    bool had_ = false;
};

std::size_t count_of_files(const std::filesystem::path& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
    return count;
}

TEST(TextFile, ReplacesAsAWhole) {
    const TemporaryFolder folder;
    const auto file = folder / "a.txt";
    write_text_file(file, "first, and longer");
    write_text_file(file, std::string("se\0cond", 7));
    EXPECT_EQ(read_text_file(file), std::string("se\0cond", 7));
    EXPECT_EQ(count_of_files(folder.path()), 1u) << "a temporary file was left";
    write_text_file(file, "");
    EXPECT_EQ(read_text_file(file), "");
}

TEST(TextFile, AFailedWriteLeavesTheOldContent) {
    const TemporaryFolder folder;
    // A folder in the file's place: the temporary is complete, the replacement fails.
    std::filesystem::create_directories(folder / "a.txt/inside");
    EXPECT_TRUE(fails_with([&] { write_text_file(folder / "a.txt", "x"); },
                           {"a.txt", "cannot replace", "a writable place"}));
    EXPECT_EQ(count_of_files(folder.path()), 1u) << "a temporary file was left";
    EXPECT_TRUE(fails_with([&] { write_text_file(folder / "no/a.txt", "x"); },
                           {"no/a.txt", "cannot create: No such file", "a writable place"}));
}

TEST(TextFile, AFullDiskIsReported) {
    const TemporaryFolder folder;
    folder.write("a.txt", "old");
    {
        const FullDisk full(50'000);
        EXPECT_TRUE(
            fails_with([&] { write_text_file(folder / "a.txt", std::string(100'000, 'x')); },
                       {"a.txt", "cannot write: File too large"}));
    }
    EXPECT_EQ(read_text_file(folder / "a.txt"), "old");
    EXPECT_EQ(count_of_files(folder.path()), 1u) << "a temporary file was left";
}

TEST(TextFile, IsNotWrittenThroughALinkOfSomebodyElse) {
    const TemporaryFolder folder;
    folder.write("precious", "kept");
    // The name of what is written first can be guessed.
    for (int attempt = 0; attempt < 3; ++attempt) {
        std::filesystem::create_symlink(
            folder / "precious",
            folder / ("a.txt.tmp" + std::to_string(::getpid()) + "-" + std::to_string(attempt)));
    }
    write_text_file(folder / "a.txt", "x");
    EXPECT_EQ(read_text_file(folder / "a.txt"), "x");
    EXPECT_EQ(read_text_file(folder / "precious"), "kept");
    EXPECT_EQ(count_of_files(folder.path()), 5u);
}

TEST(TextFile, ADeviceIsWrittenToAndNotReplaced) {
    // /dev/full may be opened by anybody; replacing it would need the rights of root.
    EXPECT_TRUE(fails_with([&] { write_text_file("/dev/full", "x"); },
                           {"/dev/full", "cannot write", "a writable place"}));
    write_text_file("/dev/null", "x");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(TextFile, BadFilesSayWhy) {
    const TemporaryFolder folder;
    EXPECT_TRUE(fails_with([&] { read_text_file(folder / "no"); }, {"no", "no such file"}));
    EXPECT_TRUE(fails_with([&] { read_text_file(folder.path()); }, {"a folder", "a file"}));
    folder.write("big", std::string(100, 'x'));
    EXPECT_EQ(read_text_file(folder / "big", 100).size(), 100u);
    EXPECT_TRUE(
        fails_with([&] { read_text_file(folder / "big", 99); }, {"big", "more than 99 bytes"}));
    if (::geteuid() != 0) {
        std::filesystem::permissions(folder / "big", std::filesystem::perms::none);
        EXPECT_TRUE(fails_with([&] { read_text_file(folder / "big"); }, {"Permission denied"}));
    }
}

TEST(OutputFolder, IsMadeOrSaysWhyNot) {
    const TemporaryFolder folder;
    make_output_folder(folder / "a/b c/d");
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b c/d"));
    EXPECT_NO_THROW(make_output_folder(folder / "a/b c/d"));
    folder.write("file", "");
    EXPECT_TRUE(fails_with([&] { make_output_folder(folder / "file"); }, {"file", "can be made"}));
    EXPECT_TRUE(fails_with([&] { make_output_folder(folder / "file/x"); }, {"file/x"}));
}

TEST(ShippedData, IsLookedUpInOrder) {
    const TemporaryFolder folder;
    for (const char* root : {"option", "variable"}) {
        std::filesystem::create_directories(folder / root);
        folder.write(std::string(root) + "/a.txt", root);
    }
    {
        const Environment variable("LIVERY_DATA", folder / "variable");
        EXPECT_EQ(shipped_path("a.txt"), folder / "variable/a.txt");
        set_data_folder(folder / "option");
        EXPECT_EQ(shipped_path("a.txt"), folder / "option/a.txt");
        EXPECT_TRUE(fails_with([&] { shipped_path("b.txt"); },
                               {"b.txt", "nothing in", (folder / "option").string(), "--data"}));
        set_data_folder({});
        EXPECT_TRUE(fails_with([&] { shipped_path("b.txt"); }, {(folder / "variable").string()}));
    }
    // Neither: beside the program, as in an installation.
    const Environment none("LIVERY_DATA", "");
    for (const char* shipped : {"materials", "shaders", "calibration", "assets/looks"}) {
        EXPECT_EQ(shipped_path(shipped),
                  (executable_folder() / "../share/livery" / shipped).lexically_normal());
    }
}

TEST(UserFolder, IsLookedUpInOrder) {
    const Environment home("LIVERY_HOME", "/a/livery home"), data("XDG_DATA_HOME", "/b"),
        user("HOME", "/c");
    EXPECT_EQ(user_folder(), "/a/livery home");
    const Environment no_home("LIVERY_HOME", "");
    EXPECT_EQ(user_folder(), "/b/livery");
    const Environment no_data("XDG_DATA_HOME", "");
    EXPECT_EQ(user_folder(), "/c/.local/share/livery");
    const Environment no_user("HOME", "");
    EXPECT_TRUE(fails_with([] { user_folder(); }, {"LIVERY_HOME or HOME"}));
}

TEST(ExecutableFolder, HoldsThisTest) {
    EXPECT_TRUE(std::filesystem::exists(executable_folder() / "test_core"));
}

TEST(ReadTextFile, TakesFilesOnlyAndOfTheirSize) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_TRUE(
        fails_with([&] { read_text_file(folder / "pipe"); }, {"pipe", "a pipe or a device"}));
    EXPECT_TRUE(
        fails_with([] { read_text_file("/dev/zero"); }, {"/dev/zero", "a pipe or a device"}));
    // Refused by its length, without reading it.
    const auto large = folder.write("large", "");
    std::filesystem::resize_file(large, std::uintmax_t{1} << 36u);
    EXPECT_TRUE(fails_with([&] { read_text_file(large); }, {"more than 67108864 bytes"}));
}

}  // namespace
}  // namespace livery
