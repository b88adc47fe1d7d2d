#include "core/text/csv.h"

#include <gtest/gtest.h>

#include "support/file_error.h"

namespace livery {
namespace {

TEST(Csv, ReadsWhatSpreadsheetsWrite) {
    const std::string text =
        "\xEF\xBB\xBF# a comment\r\n\"a\", b ,c\r\n\r\n1,-2.5e-3,\"7\"\r\n# another\n 4,5,6";
    CsvReader csv(text, "a.csv");
    EXPECT_EQ(csv.names(), (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(csv.find("b"), std::size_t{1});
    EXPECT_FALSE(csv.find("d"));
    ASSERT_TRUE(csv.next());
    EXPECT_EQ(csv.number(1), -2.5e-3);
    EXPECT_EQ(csv.number(2), 7.0);
    EXPECT_EQ(csv.place(), "line 4");
    ASSERT_TRUE(csv.next());
    EXPECT_EQ(csv.number(0), 4.0);
    EXPECT_FALSE(csv.next());
    EXPECT_FALSE(csv.next());
}

TEST(Csv, SaysWhereAndWhatIsWrong) {
    const auto refuses = [](const std::string& text, auto... parts) {
        EXPECT_TRUE(fails_with(
            [&] {
                CsvReader csv(text, "a.csv", 4);
                csv.column("a", "columns a and b");
                while (csv.next()) {
                    for (std::size_t c = 0; c < csv.names().size(); ++c) csv.number(c);
                }
            },
            {"a.csv", parts...}))
            << text;
    };
    refuses("", "nothing", "a header");
    refuses("#\n \n", "nothing", "a header");
    refuses("b\n1\n", "header", "no column 'a'", "columns a and b");
    refuses("a,,b\n", "line 1, column 2", "no name", "a name for each");
    refuses("a,b,a\n", "line 1, column 3", "'a' a second time", "a name for each");
    refuses("a,b,c,d,e\n", "line 1", "5 columns", "at most 4");
    refuses("a,b\n1\n", "line 2", "1 cell", "2, as in the header");
    refuses("a,b\n1,2,3\n", "line 2", "3 cells", "2, as in the header");
    for (const char* cell : {"nan", "inf", "-inf", "1e999", "1x", "x", "0x10", "1 2", "+-1"}) {
        refuses("a,b\n1,2\n3," + std::string(cell) + "\n", "line 3, b", cell, "a finite number");
    }
    refuses("a,b\n1,\n", "line 2, b", "''", "a finite number");
    refuses("a," + std::string(200, 'b') + "\n1,x\n", "line 2, " + std::string(40, 'b') + ":");
}

}  // namespace
}  // namespace livery
