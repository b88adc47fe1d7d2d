#include "ballot/change_limit.h"

#include <gtest/gtest.h>

namespace livery {
namespace {

/// How many changes a seat that tries all the time makes within `seconds`.
int changes(ChangeLimit& limit, int seat, double from_s, double seconds) {
    int count = 0;
    for (double now_s = from_s; now_s < from_s + seconds; now_s += 0.1) {
        if (!limit.allowed(seat, now_s)) continue;
        limit.changed(seat, now_s);
        ++count;
    }
    return count;
}

TEST(ChangeLimit, IsSixtyAtOnceAndThirtyAMinuteForASeat) {
    ChangeLimit limit;
    // A hundred tries: sixty at once, five that ten seconds give.
    EXPECT_NEAR(changes(limit, 1, 1000.0, 10.0), 65, 1);
    EXPECT_NEAR(changes(limit, 1, 1010.0, 60.0), 30, 1);
    EXPECT_NEAR(changes(limit, 2, 1010.0, 5.0), 50, 1) << "others are free";
}

TEST(ChangeLimit, GoesOnAfterAClockThatGoesBack) {
    ChangeLimit limit;
    changes(limit, 1, 1000.0, 20.0);
    EXPECT_FALSE(limit.allowed(1, 10.0)) << "gives nothing";
    limit.changed(1, 10.0);
    EXPECT_TRUE(limit.allowed(1, 20.0)) << "takes nothing either";
}

}  // namespace
}  // namespace livery
