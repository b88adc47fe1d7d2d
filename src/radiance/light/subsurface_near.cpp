#include "radiance/light/subsurface_near.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {

namespace {

/// The kernel's near part averaged over discs of that radius at each distance: fragments are about
/// as wide as light goes, and the profile is steep.
std::vector<glm::vec3> over_discs(const SubsurfaceKernel& kernel, float radius_mm) {
    constexpr int kRings = 3, kSpokes = 8;
    std::vector<glm::vec3> means(kDistanceSteps, glm::vec3(0.0f));
    parallel_for(means.size(), 128, [&](std::size_t begin, std::size_t end) {
        for (std::size_t code = begin; code < end; ++code) {
            const float part = static_cast<float>(code) / static_cast<float>(kDistanceSteps - 1);
            const float distance = part * part * kernel.near_mm;
            for (int ring = 0; ring < kRings; ++ring) {
                const float r = radius_mm * std::sqrt((static_cast<float>(ring) + 0.5f) / kRings);
                for (int spoke = 0; spoke < kSpokes; ++spoke) {
                    const float angle = (static_cast<float>(spoke) + 0.5f) * 2.0f *
                                        std::numbers::pi_v<float> / kSpokes;
                    const float at =
                        std::hypot(distance + r * std::cos(angle), r * std::sin(angle));
                    if (at >= kernel.near_mm) continue;
                    means[code] += kernel.near_per_mm2[distance_code(at, kernel.near_mm)];
                }
            }
            means[code] /= static_cast<float>(kRings * kSpokes);
        }
    });
    return means;
}

}  // namespace

std::vector<glm::vec3> entering_nearby(const SurfaceMap& map,
                                       const PixelSize& pixels,
                                       std::size_t part,
                                       const SubsurfaceKernel& kernel,
                                       std::span<const glm::vec3> entering) {
    std::vector<glm::vec3> nearby(map.fragments.size(), glm::vec3(0.0f));
    const std::size_t first = map.part_begin[part], past = map.part_begin[part + 1];
    if (first == past || !(kernel.near_mm > 0.0f)) return nearby;
    const float reach = kernel.near_mm;
    const auto cell_of = [&](std::size_t i) {
        return glm::ivec3(glm::floor(map.fragments[i].position_mm / reach));
    };
    const auto key = [](const glm::ivec3& cell) {
        const auto of = [](int v) { return static_cast<std::uint64_t>(v + 0x100000) & 0x1fffffu; };
        return of(cell.x) | of(cell.y) << 21u | of(cell.z) << 42u;
    };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    std::vector<float> area_mm2(past - first);
    for (std::size_t i = first; i < past; ++i) {
        const Fragment& f = map.fragments[i];
        const double side = pixel_side_mm(pixels, glm::dvec3(f.position_mm), glm::dvec3(f.normal));
        area_mm2[i - first] = f.coverage * static_cast<float>(side * side);
        cells[key(cell_of(i))].push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<float> sorted = area_mm2;
    const auto middle_one = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle_one, sorted.end());
    // Where it enters and where it leaves are both averaged: twice the disc
    const std::vector<glm::vec3> per_mm2 =
        over_discs(kernel, std::sqrt(2.0f * *middle_one / std::numbers::pi_v<float>));
    parallel_for(past - first, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = first + k;
            const Fragment& own = map.fragments[i];
            glm::vec3 sum(0.0f), others(0.0f);
            const glm::ivec3 middle = cell_of(i);
            for (int c = 0; c < 27; ++c) {
                const auto found =
                    cells.find(key(middle + glm::ivec3(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1)));
                if (found == cells.end()) continue;
                for (const std::uint32_t j : found->second) {
                    if (j == i) continue;
                    const Fragment& other = map.fragments[j];
                    const glm::vec3 way = other.position_mm - own.position_mm;
                    const float square = glm::dot(way, way);
                    if (square >= reach * reach || glm::dot(own.normal, other.normal) <= 0.0f) {
                        continue;
                    }
                    const glm::vec3 weight =
                        area_mm2[j - first] * per_mm2[distance_code(std::sqrt(square), reach)];
                    sum += weight * entering[j - first];
                    others += weight;
                }
            }
            // Its own pixel has the rest, and what the view does not show is lit as it is
            const glm::vec3 share = glm::max(kernel.near_share, glm::vec3(1e-20f));
            const glm::vec3 own_share = glm::max(share - others, glm::vec3(0.0f));
            nearby[i] = (sum + own_share * entering[k]) / glm::max(others, share);
        }
    });
    return nearby;
}

}  // namespace livery
