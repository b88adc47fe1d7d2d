// Archives as another program opens them.
#include "core/system/zip_file.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "core/random.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

constexpr std::time_t kChanged = 1'795'905'000;  // 28 November 2026

TEST(ZipFile, OpensElsewhereWithWhatWasPutIn) {
    const TemporaryFolder folder;
    std::string noise(5000, '\0');
    Random random(7);
    for (char& byte : noise) byte = static_cast<char>(random.next());
    const std::vector<ZipEntry> entries = {{"README.txt", std::string(100'000, 'a') + "\n"},
                                           {"leer.txt", ""},
                                           {"pictures/Lack grün.bin", noise}};
    const std::string archive = zip_of(entries, kChanged);
    EXPECT_LT(archive.size(), 7000u) << "what can be deflated is";
    const auto file = folder.write("a.zip", archive);
    const ProgramRun tested = run_program("python3", {"-m", "zipfile", "-t", file.string()});
    EXPECT_EQ(tested.exit_code, 0) << tested.out << tested.err;
    EXPECT_EQ(tested.out.find("corrupt"), std::string::npos) << tested.out;
    const ProgramRun opened =
        run_program("python3", {"-m", "zipfile", "-e", file.string(), (folder / "out").string()});
    ASSERT_EQ(opened.exit_code, 0) << opened.err;
    for (const ZipEntry& entry : entries) {
        EXPECT_EQ(read_text_file(folder.path() / "out" / entry.name), entry.bytes) << entry.name;
    }
    const ProgramRun list = run_program("python3", {"-m", "zipfile", "-l", file.string()});
    EXPECT_LT(list.out.find("README.txt"), list.out.find("leer.txt")) << "in their order";
    EXPECT_NE(list.out.find("2026-11-2"), std::string::npos) << list.out;
}

TEST(ZipFile, RefusesNamesThatLeadOutOfIt) {
    for (const char* name : {"", "/etc/passwd", "../up", "a/../../b", "folder/", "a\\b"}) {
        EXPECT_THROW(zip_of({{name, "x"}}, kChanged), std::invalid_argument) << name;
    }
    EXPECT_THROW(zip_of({{"a", "x"}, {"a", "y"}}, kChanged), std::invalid_argument);
    EXPECT_NO_THROW(zip_of({{"a..b/..c", "x"}}, kChanged));
}

}  // namespace
}  // namespace livery
