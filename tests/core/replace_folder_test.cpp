#include "core/replace_folder.h"

#include <gtest/gtest.h>

#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Path = std::filesystem::path;

std::size_t entries_in(const Path& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
    return count;
}

TEST(FolderReplacement, IsWholeOrNotAtAll) {
    const TemporaryFolder folder;
    const Path place = folder / "calibration";
    const auto write = [](const Path& to, const std::string& text) {
        write_text_file(to / "a", text);
        write_text_file(to / "last", text);
    };
    {
        FolderReplacement first(place);
        write(first.staging(), "1");
        EXPECT_FALSE(std::filesystem::exists(place));
        first.commit("last");
    }
    EXPECT_EQ(read_text_file(place / "a"), "1");
    write_text_file(place / "projector.json", "kept");
    {
        FolderReplacement stopped(place);
        write(stopped.staging(), "2");
    }
    EXPECT_EQ(read_text_file(place / "a"), "1");
    EXPECT_EQ(read_text_file(place / "last"), "1");
    {
        FolderReplacement second(place);
        write(second.staging(), "3");
        EXPECT_EQ(read_text_file(place / "a"), "1");
        second.commit("last");
    }
    EXPECT_EQ(read_text_file(place / "a"), "3");
    EXPECT_EQ(read_text_file(place / "projector.json"), "kept");
    EXPECT_EQ(entries_in(folder.path()), 1u) << "nothing is left beside it";
}

TEST(FolderReplacement, LeavesAFolderOfOtherThingsWhereItIs) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "home/photographs");
    folder.write("home/photographs/1", "mine");
    FolderReplacement replacement(folder / "home");
    write_text_file(replacement.staging() / "last", "new");
    replacement.commit("last");
    EXPECT_EQ(read_text_file(folder / "home/last"), "new");
    EXPECT_EQ(read_text_file(folder / "home/photographs/1"), "mine");
    EXPECT_TRUE(fails_with([&] { FolderReplacement(folder / "home/last"); }, {"a file"}));
}

}  // namespace
}  // namespace livery
