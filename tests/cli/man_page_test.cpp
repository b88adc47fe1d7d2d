#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "cli/parse.h"
#include "core/system/version.h"

namespace livery {
namespace {

std::vector<Command> some_commands(std::string& text, bool& flag) {
    Command command;
    command.name = "paint dry";
    command.summary = "wait, and say when it is done";
    command.example = "livery paint dry --wall 'back\\slash' -- .hidden";
    command.options = {
        {"--wall", "NAME", "which wall, e.g. north-east (default all)", &text, true, {}},
        {"--quietly", "", "no sound", &flag, false, {}},
        {"rooms", "ROOM...", "which rooms", &text, false, {}},
    };
    return {command};
}

TEST(ManPage, HasEveryCommandWithEveryOption) {
    std::string text;
    bool flag = false;
    const std::string page = man_page(some_commands(text, flag));
    for (const char* part : {".TH LIVERY 1 ",
                             ".SS \"livery paint dry\"\nWait, and say when it is done.\n",
                             ".TP\n\\fB\\-\\-wall\\fR \\fINAME\\fR\n"
                             "which wall, e.g. north\\-east (default all) (required)\n",
                             ".TP\n\\fB\\-\\-quietly\\fR\nno sound\n",
                             ".TP\n\\fIROOM...\\fR\nwhich rooms\n",
                             "\nlivery paint dry \\-\\-wall 'back\\eslash' \\-\\- .hidden\n",
                             "\\fB\\-\\-json\\fR",
                             "\\fB\\-\\-gl\\fR \\fIKIND\\fR",
                             ".SH \"EXIT STATUS\"",
                             "\\fB130\\fR",
                             "\\fBLIVERY_HOME\\fR",
                             ".SH FILES"}) {
        EXPECT_NE(page.find(part), std::string::npos) << part << "\nin\n" << page;
    }
}

TEST(ManPage, IsPlainRoff) {
    std::string text;
    bool flag = false;
    auto commands = some_commands(text, flag);
    commands[0].summary =
        "'quoted' and .dotted words at the start, and a summary that is long enough for two or "
        ".three 'lines' of the page";
    std::istringstream page(man_page(commands));
    for (std::string line; std::getline(page, line);) {
        EXPECT_FALSE(line.empty()) << "mandoc wants .PP";
        if (line[0] == '\'') ADD_FAILURE() << line;
        if (line[0] == '.') {
            EXPECT_TRUE(line[1] >= 'A' && line[1] <= 'z') << line;
        } else {
            EXPECT_LE(line.size(), 100u) << line;
        }
    }
}

TEST(Version, NamesItself) {
    EXPECT_TRUE(version_text().starts_with("livery " + version_number()));
    EXPECT_EQ(version_text().back(), '\n');
    EXPECT_NE(version_text().find("MIT licence"), std::string::npos);
    EXPECT_EQ(version_date().size(), std::string("2026-11-21").size());
}

}  // namespace
}  // namespace livery
