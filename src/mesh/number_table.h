// A hash table of numbers, for things that their owner keeps.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace livery {

/// Open addressing over the numbers 0, 1, ... of things that the caller keeps.
class NumberTable {
  public:
    explicit NumberTable(std::size_t most)
        : mask_(std::bit_ceil(2 * most + 1) - 1), slots_(mask_ + 1, kFree) {}
    /// The number of the equal thing that is there, else `next`, which is then there.
    template <typename Equal>
    std::uint32_t find_or_add(std::uint64_t hash, std::uint32_t next, const Equal& equal) {
        hash = (hash ^ (hash >> 32u)) * 0xd6e8feb86659fd93ull;
        std::size_t slot = (hash ^ (hash >> 32u)) & mask_;
        for (; slots_[slot] != kFree; slot = (slot + 1) & mask_) {
            if (equal(slots_[slot])) return slots_[slot];
        }
        return slots_[slot] = next;
    }

  private:
    static constexpr std::uint32_t kFree = 0xffffffffu;
    std::size_t mask_;
    std::vector<std::uint32_t> slots_;
};

}  // namespace livery
