#include "tracing/ray_counters.h"

#include <array>
#include <atomic>

namespace livery {
namespace {

/// Threads add to different ones, so that none waits for another's cache line.
struct alignas(64) Share {
    std::atomic<std::uint64_t> closest{0}, occluded{0};
};
constexpr std::size_t kShares = 32;
std::array<Share, kShares> shares;

Share& own_share() {
    static std::atomic<std::size_t> threads{0};
    thread_local const std::size_t own = threads.fetch_add(1, std::memory_order_relaxed) % kShares;
    return shares[own];
}

}  // namespace

namespace tracing_detail {

void count_closest(std::size_t rays) {
    own_share().closest.fetch_add(rays, std::memory_order_relaxed);
}

void count_occluded(std::size_t rays) {
    own_share().occluded.fetch_add(rays, std::memory_order_relaxed);
}

}  // namespace tracing_detail

RayCounters ray_counters() {
    RayCounters sum;
    for (const Share& share : shares) {
        sum.closest += share.closest.load(std::memory_order_relaxed);
        sum.occluded += share.occluded.load(std::memory_order_relaxed);
    }
    return sum;
}

}  // namespace livery
