#include <gtest/gtest.h>

#include "studio/kit/widgets.h"

namespace livery {
namespace {

TEST(Words, SayTimesAsPeopleDo) {
    EXPECT_EQ(readable_time("2026-11-21T09:16:05Z"), "2026-11-21 09:16 UTC");
    EXPECT_EQ(readable_calibration("2026-11-21T09-16-13Z-397cfee1"), "2026-11-21 09:16 · 397cfee1");
    for (const char* other :
         {"", "yesterday", "2026-11-21T09:16:05", "2026-11-21", "my calibration"}) {
        EXPECT_EQ(readable_time(other), other);
        EXPECT_EQ(readable_calibration(other), other);
    }
}

TEST(Words, SayNumbersAsPeopleWriteThem) {
    EXPECT_EQ(readable_number(19650.0), "19,650");
    EXPECT_EQ(readable_number(1234567.4), "1,234,567");
    EXPECT_EQ(readable_number(-1000.0), "-1,000");
    EXPECT_EQ(readable_number(999.96), "1,000");
    EXPECT_EQ(readable_number(999.9), "999.9");
    EXPECT_EQ(readable_number(320.0), "320");
    EXPECT_EQ(readable_number(12.345), "12.35");
    EXPECT_EQ(readable_number(1.0), "1");
    EXPECT_EQ(readable_number(0.0425), "0.0425");
    EXPECT_EQ(readable_number(0.000123456), "0.0001235");
    EXPECT_EQ(readable_number(0.0), "0");
    EXPECT_EQ(readable_number(-0.0), "0");
    EXPECT_EQ(readable_number(2e-7), "2e-07");
}

TEST(Words, SayDurations) {
    EXPECT_EQ(milliseconds(0.04), "0.0 ms");
    EXPECT_EQ(milliseconds(27.84), "27.8 ms");
    EXPECT_EQ(milliseconds(123.4), "123 ms");
    EXPECT_EQ(milliseconds(4870.0), "4.87 s");
}

TEST(Words, MakeSentences) {
    EXPECT_EQ(sentence("no calibration"), "No calibration.");
    EXPECT_EQ(sentence("Done!"), "Done!");
    EXPECT_EQ(sentence(""), "");
    EXPECT_EQ(sentence("été"), "été.");
}

}  // namespace
}  // namespace livery
