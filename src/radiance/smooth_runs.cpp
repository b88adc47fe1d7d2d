#include "radiance/smooth_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

bool continues(const Fragment& first, const Fragment& next, float least_cosine) {
    return next.part == first.part && next.coverage == 1.0f &&
           glm::dot(next.normal, first.normal) > least_cosine;
}

/// Of each pixel the fragment that fills it; kNone.
std::vector<std::uint32_t> whole_fragments(const SurfaceMap& map) {
    std::vector<std::uint32_t> of_pixel(
        static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), kNone);
    for (std::size_t i = 0; i < map.fragments.size(); ++i) {
        if (map.fragments[i].coverage != 1.0f) continue;
        of_pixel[map.fragments[i].pixel] = static_cast<std::uint32_t>(i);
    }
    return of_pixel;
}

}  // namespace

SmoothRuns::SmoothRuns(const SurfaceMap& map, const Limits& limits) : runs_(map.fragments.size()) {
    for (const std::uint32_t longest : {limits.longest_px, limits.highest_px, limits.beside_px}) {
        check_argument(longest >= 1 && longest <= 128 && std::has_single_bit(longest),
                       fmt::format("runs of {} pixels, expected a power of 2 up to 128", longest));
    }
    const auto least_cosine = static_cast<float>(std::cos(glm::radians(limits.turn_deg)));
    Columns found(runs_.size());
    find_columns(map, limits.highest_px, least_cosine, found);
    find_rows(map, limits.longest_px, least_cosine);
    const auto beside_cosine =
        static_cast<float>(std::cos(glm::radians(limits.turn_deg / limits.beside_px)));
    find_beside(map, limits.beside_px, beside_cosine, found);
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        if (runs_[i].before == kInColumn) columns_.push_back(found[i]);
    }
}

void SmoothRuns::find_columns(const SurfaceMap& map,
                              std::uint32_t highest,
                              float least_cosine,
                              Columns& found) {
    if (highest < 2) return;
    const std::vector<std::uint32_t> of_pixel = whole_fragments(map);
    const auto width = static_cast<std::uint32_t>(map.width);
    const auto height = static_cast<std::uint32_t>(map.height);
    for (std::uint32_t length = highest; length >= 2; length /= 2) {
        parallel_for(runs_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Fragment& above = map.fragments[i];
                const std::uint32_t y = above.pixel / width;
                if (y % length != 0 || y + length >= height || above.coverage != 1.0f) continue;
                const auto at = [&](std::uint32_t k) { return of_pixel[above.pixel + k * width]; };
                // Where no longer one begins
                if (at(1) == kNone || runs_[at(1)].before != 0) continue;
                bool even = true;
                for (std::uint32_t k = 1; k <= length && even; ++k) {
                    even = at(k) != kNone && continues(above, map.fragments[at(k)], least_cosine);
                }
                for (std::uint32_t k = 1; k < length && even; ++k) {
                    runs_[at(k)].before = kInColumn;
                    found[at(k)] = {at(k),
                                    static_cast<std::uint32_t>(i),
                                    at(length),
                                    static_cast<float>(k) / static_cast<float>(length)};
                }
            }
        });
    }
}

void SmoothRuns::find_rows(const SurfaceMap& map, std::uint32_t longest, float least_cosine) {
    const auto width = static_cast<std::uint32_t>(map.width);
    /// Whether the surface goes on evenly over so many more, the last of which has its own value.
    const auto is_even = [&](std::size_t first, std::uint32_t length) {
        if (first + length >= runs_.size() || runs_[first + length].before != 0) return false;
        const Fragment& left = map.fragments[first];
        for (std::uint32_t k = 1; k <= length; ++k) {
            const Fragment& f = map.fragments[first + k];
            if (f.pixel != left.pixel + k || !continues(left, f, least_cosine)) return false;
        }
        return true;
    };
    // Every run begins at a column that is a multiple of its length: none reaches into another
    for (std::uint32_t length = longest; length >= 2; length /= 2) {
        parallel_for(runs_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t x = map.fragments[i].pixel % width;
                if (x % length != 0 || x + length >= width || runs_[i].before != 0 ||
                    map.fragments[i].coverage != 1.0f) {
                    continue;
                }
                // Where no longer one begins
                const Run next = i + 1 < runs_.size() ? runs_[i + 1] : Run{1, 1};
                if (next.before != 0 && next.before != kInColumn) continue;
                if (!is_even(i, length)) continue;
                for (std::uint32_t k = 1; k < length; ++k) {
                    if (runs_[i + k].before == kInColumn) continue;
                    runs_[i + k] = {static_cast<std::uint8_t>(k),
                                    static_cast<std::uint8_t>(length - k)};
                }
            }
        });
    }
}

void SmoothRuns::find_beside(const SurfaceMap& map,
                             std::uint32_t side,
                             float least_cosine,
                             Columns& found) {
    if (side < 2) return;
    const auto width = static_cast<std::uint32_t>(map.width);
    /// Of each block of a band, who has a value of its own: fragments come by part, then by pixel.
    std::vector<std::vector<std::uint32_t>> own(width / side + 1);
    std::uint32_t part = kNone, band = kNone;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        if (!is_end(i)) continue;
        const Fragment& f = map.fragments[i];
        if (f.part != part || f.pixel / width / side != band) {
            part = f.part;
            band = f.pixel / width / side;
            for (auto& of_block : own) of_block.clear();
        }
        std::vector<std::uint32_t>& here = own[f.pixel % width / side];
        const auto alike = std::find_if(here.begin(), here.end(), [&](std::uint32_t other) {
            return glm::dot(f.normal, map.fragments[other].normal) > least_cosine;
        });
        if (f.coverage == 1.0f || alike == here.end()) {
            here.push_back(static_cast<std::uint32_t>(i));
        } else {
            runs_[i].before = kInColumn;
            found[i] = {static_cast<std::uint32_t>(i), *alike, *alike, 0.0f};
        }
    }
}

}  // namespace livery
