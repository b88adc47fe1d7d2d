// Colours as people type them and as tables of chips have them.
#include "appearance/paint_colour.h"

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "support/file_error.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double within) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], within) << c;
}

TEST(PaintColour, IsTakenAsPaintMakersWriteIt) {
    expect_near(parse_colour("lab:45,30.5,-20"), {45.0, 30.5, -20.0}, 1e-12);
    expect_near(parse_colour("LAB: 45 , +30.5 , -20 "), {45.0, 30.5, -20.0}, 1e-12);
    // White of ASTM E308.
    expect_near(parse_colour("xyz:94.811,100,107.304"), {100.0, 0.0, 0.0}, 0.05);
    expect_near(parse_colour("xyz:0,0,0"), {0.0, 0.0, 0.0}, 1e-9);
    expect_near(parse_colour("#ffffff"), {100.0, 0.0, 0.0}, 1e-9);
    expect_near(parse_colour("#777777"), {50.034, 0.0, 0.0}, 0.001);
    EXPECT_GT(parse_colour("#D01020").y, 50.0);
    EXPECT_EQ(parse_colour("#D01020"), parse_colour("#d01020"));
}

TEST(PaintColour, IsTakenAsOtherProgramsWriteIt) {
    const glm::dvec3 blue = parse_colour("#1a4f9c");
    for (const char* text : {"1a4f9c",
                             "1A4F9C",
                             "rgb(26,79,156)",
                             "rgb( 26, 79 , 156 )",
                             "RGB(26 79  156)",
                             "rgb(10.196078431372549%, 30.980392156862745%, 61.1764705882353%)"}) {
        expect_near(parse_colour(text), blue, 1e-9);
    }
    EXPECT_EQ(parse_colour("#1ac"), parse_colour("#11aacc"));
    EXPECT_EQ(parse_colour("tomato"), parse_colour("#ff6347"));
    EXPECT_EQ(parse_colour("RebeccaPurple"), parse_colour("#663399"));
    EXPECT_EQ(parse_colour("lightslategrey"), parse_colour("lightslategray"));
    for (const char* text : {"rgb()",
                             "rgb(1,2)",
                             "rgb(1,2,3",
                             "rgb(1,2,256)",
                             "rgb(1%,2,3)",
                             "rgb(  )",
                             "rgb(1,2,3,4)",
                             "bad",
                             "1a4f9",
                             "tomatoes"}) {
        EXPECT_THROW(parse_colour(text), std::invalid_argument) << text;
    }
}

TEST(PaintColour, SaysWhatIsWrong) {
    const auto message = [](const std::string& text) {
        return message_of([&] { parse_colour(text); });
    };
    for (const char* text : {"", "rot", "#12345", "#1234567", "#12345g", "12,3,4", "rgb:1,2,3"}) {
        const std::string expected =
            std::string("colour '") + text +
            "': expected #RRGGBB, #RGB, rgb(R, G, B), a colour's name in CSS, lab:";
        EXPECT_EQ(message(text).substr(0, expected.size()), expected);
    }
    EXPECT_NE(message("lab:1,2").find("expected three numbers"), std::string::npos);
    EXPECT_NE(message("lab:1,2,3,4").find("expected three numbers"), std::string::npos);
    EXPECT_NE(message("lab:x,2,3").find("L is 'x', expected a number from 0 to 200"),
              std::string::npos);
    EXPECT_NE(message("lab:50,nan,3").find("a is 'nan'"), std::string::npos);
    EXPECT_NE(message("lab:-1,2,3").find("L is '-1'"), std::string::npos);
    EXPECT_NE(message("xyz:1,2,1e9").find("Z is '1e9', expected a number from 0 to 500"),
              std::string::npos);
    EXPECT_NE(message("lab:,,").find("L is ''"), std::string::npos);
    EXPECT_THROW(parse_colour(std::string(100'000, '#')), std::invalid_argument);
}

TEST(ColourChips, AreReadInEachForm) {
    const auto lab = parse_colour_chips(
        "# our fan\ncode,Name,L*,a*,b*\n1,\"Signal red\",42,55,33\n2,Ivory,88,1,14\n", "fan.csv");
    ASSERT_EQ(lab.size(), 2u);
    EXPECT_EQ(lab[0].name, "Signal red");
    expect_near(lab[0].lab10, {42.0, 55.0, 33.0}, 1e-12);
    const auto xyz = parse_colour_chips("name,X,Y,Z\nwhite,94.811,100,107.304\n", "fan.csv");
    expect_near(xyz[0].lab10, {100.0, 0.0, 0.0}, 0.05);
    const auto hex = parse_colour_chips("name,hex\nblue,#102080\nsame,102080\n", "fan.csv");
    EXPECT_EQ(hex[0].lab10, parse_colour("#102080"));
    EXPECT_EQ(hex[1].lab10, hex[0].lab10);
    EXPECT_EQ(&chip_named(lab, "signal-red"), &lab[0]);
    const std::string missing = message_of([&] { chip_named(lab, "green"); });
    EXPECT_EQ(missing, "no chip named 'green' among 2: 'Signal red', 'Ivory'");
}

TEST(ColourChips, NameTheLineThatIsWrong) {
    const auto fails = [](const std::string& text, std::initializer_list<std::string_view> parts) {
        return fails_with([&] { parse_colour_chips(text, "fan.csv"); }, parts);
    };
    EXPECT_TRUE(fails("", {"fan.csv"}));
    EXPECT_TRUE(
        fails("name,L,a\nx,1,2\n", {"fan.csv", "header", "no colours", "L, a, b or X, Y, Z"}));
    EXPECT_TRUE(fails("L,a,b\n1,2,3\n", {"header", "no column name"}));
    EXPECT_TRUE(
        fails("name,L,a,b,hex\nx,1,2,3,#000000\n", {"header", "colours in 2 forms", "either"}));
    EXPECT_TRUE(fails("name,L,a,b\n", {"no chips"}));
    EXPECT_TRUE(fails("name,L,a,b\nx,1,2,3\ny,4,5\n", {"line 3"}));
    EXPECT_TRUE(fails("name,L,a,b\nx,1,2,3\n\ny,4,red,6\n", {"line 4", "a", "'red'", "number"}));
    EXPECT_TRUE(fails("name,L,a,b\nx,201,2,3\n", {"line 2", "L", "201", "from 0 to 200"}));
    EXPECT_TRUE(fails("name,L,a,b\nx,nan,2,3\n", {"line 2", "nan"}));
    EXPECT_TRUE(fails("name,X,Y,Z\nx,1,-2,3\n", {"line 2", "Y", "-2", "from 0 to 500"}));
    EXPECT_TRUE(fails("name,hex\nx,#12\n", {"line 2", "hex", "#12", "six hexadecimal digits"}));
    EXPECT_TRUE(fails("name,hex\n,#123456\n", {"line 2", "name", "a name"}));
    EXPECT_TRUE(fails("name,hex\nred,#123456\nRed,#123456\n",
                      {"line 3", "name", "'Red'", "no chip above"}));
    // Such rows would be taken for comments.
    EXPECT_TRUE(fails("hex,name\n#123456,x\n", {"hex as the first column", "comment"}));
    const TemporaryFolder folder;
    EXPECT_TRUE(fails_with([&] { read_colour_chips(folder / "none.csv"); },
                           {(folder / "none.csv").string()}));
    std::string many = "name,hex\n";
    for (int k = 0; k <= 100'000; ++k) many += std::to_string(k) + ",#000000\n";
    EXPECT_TRUE(fails(many, {"line 100002", "more chips", "at most 100000"}));
}

}  // namespace
}  // namespace livery
