#include "radiance/smooth_runs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr int kReach_px = 2;

/// Same part, normals within 25 degrees, and either lies within 30 degrees of the other's plane.
bool continues(const Fragment& a, const Fragment& b) {
    if (a.part != b.part || glm::dot(a.normal, b.normal) < 0.9f) return false;
    const glm::vec3 apart = b.position_mm - a.position_mm;
    const float most = 0.5f * glm::length(apart);
    return std::abs(glm::dot(apart, a.normal)) <= most &&
           std::abs(glm::dot(apart, b.normal)) <= most;
}

std::size_t turn_of_pixel(int x, int y) {
    // Rows of blocks are set off by half of one
    return static_cast<std::size_t>(((x + (y & 2)) & 3) + 4 * (y & 1));
}

}  // namespace

std::size_t neighbour_turn(const SurfaceMap& map, std::size_t fragment) {
    const int pixel = static_cast<int>(map.fragments[fragment].pixel);
    return turn_of_pixel(pixel % map.width, pixel / map.width);
}

FragmentNeighbours::FragmentNeighbours(const SurfaceMap& map) : map_(map) {
    first_.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height) + 1,
                  0);
    for (const Fragment& f : map.fragments) ++first_[f.pixel + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    sorted_.resize(map.fragments.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < map.fragments.size(); ++i) {
        sorted_[next[map.fragments[i].pixel]++] = static_cast<std::uint32_t>(i);
    }
}

void FragmentNeighbours::around(std::size_t fragment, std::vector<Neighbour>& found) const {
    found.clear();
    const Fragment& own = map_.fragments[fragment];
    const int x0 = static_cast<int>(own.pixel) % map_.width;
    const int y0 = static_cast<int>(own.pixel) / map_.width;
    for (int y = std::max(y0 - kReach_px, 0); y <= std::min(y0 + kReach_px, map_.height - 1); ++y) {
        for (int x = std::max(x0 - kReach_px, 0); x <= std::min(x0 + kReach_px, map_.width - 1);
             ++x) {
            const auto pixel = static_cast<std::size_t>(y * map_.width + x);
            const auto weight = static_cast<float>((kReach_px + 1 - std::abs(x - x0)) *
                                                   (kReach_px + 1 - std::abs(y - y0)));
            for (std::uint32_t i = first_[pixel]; i < first_[pixel + 1]; ++i) {
                const std::size_t other = sorted_[i];
                // Its own pixel's others are others because they do not continue it
                const bool same_pixel = pixel == own.pixel;
                if (same_pixel ? other != fragment : !continues(own, map_.fragments[other])) {
                    continue;
                }
                found.push_back({other, turn_of_pixel(x, y), weight});
                break;
            }
        }
    }
}

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
