// Who somebody is stands in no report, and nothing else is lost.
#include "studio/report/redaction.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "support/temporary_folder.h"

namespace livery {
namespace {

const PrivateWords kMax = {{{"/home/max", "~"}},
                           {{"Max Mustermann", "USER"}, {"max", "USER"}, {"studio-pc", "HOST"}}};

TEST(Redaction, ReplacesTheHomeFolderWithAllThatItBegins) {
    EXPECT_EQ(redacted("/home/max/a.livery and /home/max", kMax), "~/a.livery and ~");
    EXPECT_EQ(redacted(R"({"file": "/home/max/x"})", kMax), R"({"file": "~/x"})");
    EXPECT_EQ(redacted("/home/maximilian/a", kMax), "/home/maximilian/a") << "somebody else's";
    EXPECT_EQ(redacted("/home/max-2/a", kMax), "/home/USER-2/a");
    EXPECT_EQ(redacted("/mnt/home/max/a", kMax), "/mnt~/a");
}

TEST(Redaction, ReplacesNamesAsWholeWordsOnly) {
    EXPECT_EQ(redacted("max: of Max Mustermann on studio-pc", kMax), "USER: of USER on HOST");
    EXPECT_EQ(redacted("max_texture climax maximum", kMax), "max_texture climax maximum");
    EXPECT_EQ(redacted("maxé max.ply max", kMax), "maxé USER.ply USER");
}

TEST(Redaction, FindsNamesAsJsonWritesThem) {
    const PrivateWords odd = {{{R"(/home/a"b)", "~"}}, {}};
    EXPECT_EQ(redacted(R"({"file": "/home/a\"b/x"} /home/a"b)", odd), R"({"file": "~/x"} ~)");
}

/// The environment as one user has it, for the life of the object.
class As {
  public:
    As(const char* home, const char* user) {
        for (const char* name : {"HOME", "USER"}) {
            const char* value = std::getenv(name);
            before_.emplace_back(name, value ? value : "");
        }
        ::setenv("HOME", home, 1);
        ::setenv("USER", user, 1);
    }
    ~As() {
        for (const auto& [name, value] : before_) ::setenv(name.c_str(), value.c_str(), 1);
    }

  private:
    std::vector<std::pair<std::string, std::string>> before_;
};

TEST(Redaction, KnowsTheHomeFolderBehindALink) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "real");
    std::filesystem::create_symlink(folder / "real", folder / "link");
    const As anna((folder / "link/").string().c_str(), "anna");
    const PrivateWords words = private_words();
    EXPECT_EQ(redacted((folder / "link/a").string(), words), "~/a");
    EXPECT_EQ(redacted((folder / "real/a").string(), words), "~/a");
    EXPECT_EQ(redacted("seat of anna", words), "seat of USER");
}

TEST(Redaction, LeavesPathsOfWhoLivesNowhere) {
    const As nobody("/", "root");
    const PrivateWords words = private_words();
    EXPECT_EQ(redacted("/usr/share and root", words), "/usr/share and root");
    for (const auto& [folder, instead] : words.folders) EXPECT_GT(folder.size(), 1u);
}

}  // namespace
}  // namespace livery
