// How many rays were traced, counted where Embree is asked.
#pragma once

#include <cstddef>
#include <cstdint>

namespace livery {

struct RayCounters {
    std::uint64_t closest = 0;   ///< what a ray meets first
    std::uint64_t occluded = 0;  ///< whether it meets anything

    bool operator==(const RayCounters&) const = default;
};
inline RayCounters operator-(const RayCounters& later, const RayCounters& earlier) {
    return {later.closest - earlier.closest, later.occluded - earlier.occluded};
}

/// Of all threads and tracers so far.
RayCounters ray_counters();

namespace tracing_detail {
void count_closest(std::size_t rays);
void count_occluded(std::size_t rays);
}  // namespace tracing_detail

}  // namespace livery
