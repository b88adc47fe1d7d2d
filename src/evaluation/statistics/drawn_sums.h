// Sums over a round in which every choice is equally likely, drawn quickly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace livery {

/// Draws `draws` rounds of `evaluators`, each of whom makes one of `choices` (what it adds to each
/// of up to 26 sums, at most 60 each): told(index, sums) for every draw, from any thread. The same
/// for a seed and `purpose` on any number of threads.
void draw_sums(const std::vector<std::vector<int>>& choices,
               int evaluators,
               std::size_t draws,
               std::uint64_t seed,
               std::uint32_t purpose,
               const std::function<void(std::size_t index, const std::vector<int>& sums)>& told);

}  // namespace livery
