#include "radiance/fragment_neighbours.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>

namespace livery {
namespace {

constexpr int kReach = 2;

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
    for (int y = std::max(y0 - kReach, 0); y <= std::min(y0 + kReach, map_.height - 1); ++y) {
        for (int x = std::max(x0 - kReach, 0); x <= std::min(x0 + kReach, map_.width - 1); ++x) {
            const auto pixel = static_cast<std::size_t>(y * map_.width + x);
            const auto weight = static_cast<float>((kReach + 1 - std::abs(x - x0)) *
                                                   (kReach + 1 - std::abs(y - y0)));
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

}  // namespace livery
