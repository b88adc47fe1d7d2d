#include "radiance/smooth_runs.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

/// Whether the surface goes on evenly from a fragment over so many more of its row.
bool is_even(const SurfaceMap& map, std::size_t first, std::uint32_t length, float least_cosine) {
    if (first + length >= map.fragments.size()) return false;
    const Fragment& left = map.fragments[first];
    if (left.coverage != 1.0f) return false;
    for (std::uint32_t k = 1; k <= length; ++k) {
        const Fragment& f = map.fragments[first + k];
        if (f.pixel != left.pixel + k || f.part != left.part || f.coverage != 1.0f ||
            !(glm::dot(f.normal, left.normal) > least_cosine)) {
            return false;
        }
    }
    return true;
}

}  // namespace

SmoothRuns::SmoothRuns(const SurfaceMap& map, const Limits& limits) : runs_(map.fragments.size()) {
    const std::uint32_t longest = limits.longest_px;
    check_argument(longest >= 2 && longest <= 128 && std::has_single_bit(longest),
                   fmt::format("runs of {} pixels, expected a power of 2 up to 128", longest));
    const auto least_cosine = static_cast<float>(std::cos(glm::radians(limits.turn_deg)));
    const auto width = static_cast<std::uint32_t>(map.width);
    // Every run begins at a column that is a multiple of its length: none reaches into another
    for (std::uint32_t length = longest; length >= 2; length /= 2) {
        parallel_for(runs_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t x = map.fragments[i].pixel % width;
                if (x % length != 0 || x + length >= width || runs_[i].before != 0) continue;
                // Where no longer one begins
                if (i + 1 >= runs_.size() || runs_[i + 1].before != 0) continue;
                if (!is_even(map, i, length, least_cosine)) continue;
                for (std::uint32_t k = 1; k < length; ++k) {
                    runs_[i + k] = {static_cast<std::uint8_t>(k),
                                    static_cast<std::uint8_t>(length - k)};
                }
            }
        });
    }
}

}  // namespace livery
