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

/// Fragments that are finer than the gathering needs to be, taken together.
struct FragmentPatch {
    glm::vec3 position_mm{0.0f}, normal{0.0f}, entering{0.0f};  ///< means by area
    float area_mm2 = 0.0f;
};
struct FragmentPatches {
    std::vector<FragmentPatch> all;
    std::vector<std::uint32_t> of;  ///< of each fragment of the part
};

std::uint64_t cell_key(const glm::vec3& position, float side_mm, std::uint64_t kind = 0) {
    const glm::ivec3 cell(glm::floor(position / side_mm));
    const auto of = [](int v) { return static_cast<std::uint64_t>(v + 0x80000) & 0xfffffu; };
    return of(cell.x) | of(cell.y) << 20u | of(cell.z) << 40u | kind << 60u;
}

FragmentPatches patches_of(std::span<const Fragment> fragments,
                           const PixelSize& pixels,
                           std::span<const glm::vec3> entering,
                           float side_mm) {
    FragmentPatches patches;
    patches.of.resize(fragments.size());
    std::vector<float> area_mm2(fragments.size());
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const Fragment& f = fragments[k];
        const double side = pixel_side_mm(pixels, glm::dvec3(f.position_mm), glm::dvec3(f.normal));
        area_mm2[k] = f.coverage * static_cast<float>(side * side);
    }
    std::vector<float> sorted = area_mm2;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const bool together = *middle < side_mm * side_mm;
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const Fragment& f = fragments[k];
        auto index = static_cast<std::uint32_t>(patches.all.size());
        if (together) {
            // Both sides of a sheet are two
            const std::uint64_t side = (f.normal.x > 0.0f ? 1u : 0u) |
                                       (f.normal.y > 0.0f ? 2u : 0u) |
                                       (f.normal.z > 0.0f ? 4u : 0u);
            index = known.emplace(cell_key(f.position_mm, side_mm, side), index).first->second;
        }
        if (index == patches.all.size()) patches.all.emplace_back();
        patches.of[k] = index;
        FragmentPatch& patch = patches.all[index];
        patch.area_mm2 += area_mm2[k];
        patch.position_mm += area_mm2[k] * f.position_mm;
        patch.normal += area_mm2[k] * f.normal;
        patch.entering += area_mm2[k] * entering[k];
    }
    for (FragmentPatch& patch : patches.all) {
        const float area = std::max(patch.area_mm2, 1e-20f);
        patch.position_mm /= area;
        patch.normal /= area;
        patch.entering /= area;
    }
    return patches;
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
    constexpr float kAcross = 6.0f;  // patches from the beam to where nothing is near any more
    const FragmentPatches patches = patches_of(
        std::span(map.fragments).subspan(first, past - first), pixels, entering, reach / kAcross);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    std::vector<float> areas;
    for (std::size_t k = 0; k < patches.all.size(); ++k) {
        cells[cell_key(patches.all[k].position_mm, reach)].push_back(static_cast<std::uint32_t>(k));
        areas.push_back(patches.all[k].area_mm2);
    }
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    // Where it enters and where it leaves are both averaged: twice the disc
    const std::vector<glm::vec3> per_mm2 =
        over_discs(kernel, std::sqrt(2.0f * *middle / std::numbers::pi_v<float>));
    parallel_for(past - first, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Fragment& own = map.fragments[first + k];
            glm::vec3 sum(0.0f), others(0.0f);
            for (int c = 0; c < 27; ++c) {
                const glm::vec3 step(glm::ivec3(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1));
                const auto found = cells.find(cell_key(own.position_mm + reach * step, reach));
                if (found == cells.end()) continue;
                for (const std::uint32_t j : found->second) {
                    if (j == patches.of[k]) continue;
                    const FragmentPatch& other = patches.all[j];
                    const glm::vec3 way = other.position_mm - own.position_mm;
                    const float square = glm::dot(way, way);
                    if (square >= reach * reach || glm::dot(own.normal, other.normal) <= 0.0f) {
                        continue;
                    }
                    const glm::vec3 weight =
                        other.area_mm2 * per_mm2[distance_code(std::sqrt(square), reach)];
                    sum += weight * other.entering;
                    others += weight;
                }
            }
            // Its own pixel has the rest, and what the view does not show is lit as it is
            const glm::vec3 share = glm::max(kernel.near_share, glm::vec3(1e-20f));
            const glm::vec3 own_share = glm::max(share - others, glm::vec3(0.0f));
            nearby[first + k] = (sum + own_share * entering[k]) / glm::max(others, share);
        }
    });
    return nearby;
}

}  // namespace livery
