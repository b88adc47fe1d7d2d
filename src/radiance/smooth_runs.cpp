#include "radiance/smooth_runs.h"

#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {
namespace {

constexpr std::uint32_t kLongest = 4;
constexpr float kOneDegree = 0.99985f;

/// Whether the surface goes on evenly from a fragment over so many more of its row.
bool is_even(const SurfaceMap& map, std::size_t first, std::uint32_t length) {
    if (first + length >= map.fragments.size()) return false;
    const Fragment& left = map.fragments[first];
    if (left.coverage != 1.0f) return false;
    for (std::uint32_t k = 1; k <= length; ++k) {
        const Fragment& f = map.fragments[first + k];
        if (f.pixel != left.pixel + k || f.part != left.part || f.coverage != 1.0f ||
            !(glm::dot(f.normal, left.normal) > kOneDegree)) {
            return false;
        }
    }
    return true;
}

}  // namespace

SmoothRuns::SmoothRuns(const SurfaceMap& map) : runs_(map.fragments.size()) {
    const auto width = static_cast<std::uint32_t>(map.width);
    const auto fill = [&](std::size_t first, std::uint32_t length) {
        for (std::uint32_t k = 1; k < length; ++k) {
            runs_[first + k] = {static_cast<std::uint8_t>(k),
                                static_cast<std::uint8_t>(length - k)};
        }
    };
    // Every run begins at a column that is a multiple of its length: none reaches into another
    parallel_for(runs_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t x = map.fragments[i].pixel % width;
            if (x % kLongest == 0 && x + kLongest < width && is_even(map, i, kLongest)) {
                fill(i, kLongest);
            }
        }
    });
    parallel_for(runs_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t x = map.fragments[i].pixel % width;
            if (x % 2 != 0 || x + 2 >= width || runs_[i].before != 0) continue;
            // Where the longer one that begins here was not even
            if (i + 1 < runs_.size() && runs_[i + 1].before == 0 && is_even(map, i, 2)) fill(i, 2);
        }
    });
}

}  // namespace livery
