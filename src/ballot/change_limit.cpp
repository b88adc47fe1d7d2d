#include "ballot/change_limit.h"

#include <algorithm>

namespace livery {

namespace {

constexpr double kAtOnce = 60.0;
constexpr double kRefill_per_s = 30.0 / 60.0;

}  // namespace

ChangeLimit::Bucket ChangeLimit::bucket_of(int seat, double now_s) const {
    const auto found = buckets_.find(seat);
    if (found == buckets_.end()) return {kAtOnce, now_s};
    // A clock that is set back gives nothing, and goes on from there.
    const double since_s = std::max(0.0, now_s - found->second.at_s);
    return {std::min(kAtOnce, found->second.left + since_s * kRefill_per_s), now_s};
}

bool ChangeLimit::allowed(int seat, double now_s) const {
    return bucket_of(seat, now_s).left >= 1.0;
}

void ChangeLimit::changed(int seat, double now_s) {
    Bucket bucket = bucket_of(seat, now_s);
    bucket.left -= 1.0;
    buckets_[seat] = bucket;
}

}  // namespace livery
