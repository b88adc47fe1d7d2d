#include "studio/words.h"

#include <gtest/gtest.h>

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
