#include "core/utf8.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace livery {
namespace {

TEST(Utf8, CodePointsAreTakenOneByOne) {
    std::string_view text = "aé€😀";
    for (const char32_t point : {U'a', U'é', U'€', U'😀'}) EXPECT_EQ(take_code_point(text), point);
    EXPECT_EQ(take_code_point(text), std::nullopt);
    // Cut off, a lone continuation, too long, a surrogate, beyond the last.
    for (const char* bad :
         {"\xc3", "\x80", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"}) {
        std::string_view rest = bad;
        EXPECT_EQ(take_code_point(rest), std::nullopt);
        EXPECT_EQ(rest, bad);
    }
}

TEST(Utf8, WhatIsPrintedIsOneLine) {
    EXPECT_EQ(printable("é\n\x1b[31m\xff\xc2\x85|"), "é??[31m??|");
    EXPECT_EQ(printable("ééé", 2), "éé...");
    EXPECT_EQ(printable("éé", 2), "éé");
    EXPECT_EQ(printable(std::string_view("\0", 1)), "?");
}

TEST(FileErrors, ShowNothingOfAFileButText) {
    const FileError error("a.json", "b\n", std::string(2000, 'x'), "\xff");
    EXPECT_EQ(std::string(error.what()),
              "a.json: b?: found " + std::string(600, 'x') + "..., expected ?");
}

}  // namespace
}  // namespace livery
