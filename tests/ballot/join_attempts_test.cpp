#include "ballot/join_attempts.h"

#include <string>

#include <gtest/gtest.h>

namespace livery {
namespace {

/// How often a client that tries all the time is let try within `seconds`.
int tries(JoinAttempts& attempts, const std::string& client, double from_s, double seconds) {
    int count = 0;
    for (double now = from_s; now < from_s + seconds; now += 0.1) {
        if (!attempts.allowed(client, now)) continue;
        attempts.failed(client, now);
        ++count;
    }
    return count;
}

TEST(JoinAttempts, AreFiveAMinuteForOne) {
    JoinAttempts attempts;
    EXPECT_EQ(tries(attempts, "a", 1000.0, 1.0), 5);
    EXPECT_TRUE(attempts.allowed("b", 1001.0)) << "others are free";
    EXPECT_EQ(tries(attempts, "a", 1001.0, 60.0), 5);
    // A minute's rest: five at once again.
    EXPECT_EQ(tries(attempts, "a", 1200.0, 1.0), 5);
}

TEST(JoinAttempts, AreSixtyAMinuteForAll) {
    JoinAttempts attempts;
    int count = 0;
    for (int client = 0; client < 100; ++client) {
        count += tries(attempts, std::to_string(client), 1000.0, 0.5);
    }
    EXPECT_GE(count, 60);
    EXPECT_LE(count, 61);
    EXPECT_FALSE(attempts.allowed("honest", 1000.5));
    EXPECT_TRUE(attempts.allowed("honest", 1003.0));
}

TEST(JoinAttempts, AreForgotten) {
    JoinAttempts attempts;
    for (int client = 0; client < 5000; ++client) {
        attempts.failed(std::to_string(client), 1000.0);
    }
    EXPECT_LE(attempts.clients(), 256u);
    attempts.failed("late", 1100.0);
    EXPECT_EQ(attempts.clients(), 1u);
}

TEST(JoinAttempts, SurviveAClockThatGoesBack) {
    JoinAttempts attempts;
    EXPECT_EQ(tries(attempts, "a", 1000.0, 1.0), 5);
    EXPECT_FALSE(attempts.allowed("a", 10.0));
    EXPECT_TRUE(attempts.allowed("b", 10.0));
}

}  // namespace
}  // namespace livery
