#include "cli/parse.h"

#include <memory>

#include <gtest/gtest.h>

namespace livery {
namespace {

struct Fixture {
    std::shared_ptr<std::string> out = std::make_shared<std::string>();
    std::shared_ptr<double> budget = std::make_shared<double>(0.0);
    std::vector<Command> commands;

    Fixture() {
        Command draw;
        draw.name = "draw";
        draw.summary = "draws";
        draw.example = "livery draw --out a.png";
        draw.options = {{"--out", "FILE", "where", out.get(), true, {}},
                        {"--budget-ms", "N", "limit", budget.get(), false, {}}};
        draw.run = [](const CommonOptions&, const Progress&) { return Outcome{}; };
        Command nested = draw;
        nested.name = "solve colour";
        nested.options = {};
        commands = {draw, nested};
    }
    ParsedCommandLine parse(const std::vector<std::string>& words) {
        return parse_command_line(words, commands);
    }
};

TEST(Parse, FillsTheChosenCommand) {
    Fixture fixture;
    const auto parsed =
        fixture.parse({"draw", "--out", "a b.png", "--budget-ms", "2.5", "--json", "--seed", "7"});
    ASSERT_NE(parsed.command, nullptr) << parsed.text;
    EXPECT_EQ(parsed.command->name, "draw");
    EXPECT_EQ(*fixture.out, "a b.png");
    EXPECT_DOUBLE_EQ(*fixture.budget, 2.5);
    EXPECT_TRUE(parsed.common.json);
    EXPECT_EQ(parsed.common.seed, 7);
}

TEST(Parse, FindsCommandsInGroups) {
    Fixture fixture;
    const auto parsed = fixture.parse({"solve", "colour"});
    ASSERT_NE(parsed.command, nullptr) << parsed.text;
    EXPECT_EQ(parsed.command->name, "solve colour");
    EXPECT_EQ(fixture.parse({"solve"}).exit_code, 2);
}

TEST(Parse, SaysInOneLineWhatIsWrong) {
    Fixture fixture;
    const std::vector<std::vector<std::string>> wrong = {{"paint"},
                                                         {"draw"},
                                                         {"draw", "--out"},
                                                         {"draw", "--out", "a", "--nonsense"},
                                                         {"draw", "--out", "a", "--budget-ms", "x"},
                                                         {"draw", "--out", "a", "--seed", "1.5"},
                                                         {"draw", "--out", "a", "--seed", "-1"},
                                                         {"draw", "--out", "a", "--threads", "-2"},
                                                         {"draw", "--out", "a", "--gl", "vulkan"}};
    for (const auto& words : wrong) {
        const auto parsed = fixture.parse(words);
        EXPECT_EQ(parsed.command, nullptr) << words.back();
        EXPECT_EQ(parsed.exit_code, 2) << words.back();
        EXPECT_FALSE(parsed.text.empty());
        EXPECT_EQ(parsed.text.find('\n'), std::string::npos) << parsed.text;
    }
}

TEST(Parse, HelpShowsEveryOptionAndAnExample) {
    Fixture fixture;
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"help", "draw"}, {"draw", "--help"}}) {
        const auto parsed = fixture.parse(words);
        EXPECT_EQ(parsed.exit_code, 0);
        EXPECT_NE(parsed.text.find("--budget-ms N"), std::string::npos);
        EXPECT_NE(parsed.text.find("livery draw --out a.png"), std::string::npos);
        EXPECT_NE(parsed.text.find("--json"), std::string::npos);
    }
    EXPECT_NE(fixture.parse({"help"}).text.find("solve colour"), std::string::npos);
    EXPECT_EQ(fixture.parse({"help", "paint"}).exit_code, 2);
    EXPECT_EQ(fixture.parse({}).exit_code, 2);
}

TEST(Parse, SizesAndNumbers) {
    EXPECT_EQ(parse_size("--size", "1280x800").y, 800);
    for (const char* wrong :
         {"1280", "x800", "1280x", "1280x800x3", "0x10", "99999x10", "axb", ""}) {
        EXPECT_THROW(parse_size("--size", wrong), std::invalid_argument) << wrong;
    }
    EXPECT_EQ(parse_numbers("--eye", "1,-2.5,3e2", 3), (std::vector<double>{1.0, -2.5, 300.0}));
    for (const char* wrong :
         {"1,2", "1,2,3,4", "1;2;3", "1,,3", "1,2,x", "", "1,2,nan", "1,2,inf"}) {
        EXPECT_THROW(parse_numbers("--eye", wrong, 3), std::invalid_argument) << wrong;
    }
}

}  // namespace
}  // namespace livery
