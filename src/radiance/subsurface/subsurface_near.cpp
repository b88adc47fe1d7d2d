#include "radiance/subsurface/subsurface_near.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/parallel.h"

namespace livery {

namespace {

/// The kernel's near part averaged over discs of that radius at each distance: fragments are about
/// as wide as light goes, and the profile is steep.
std::vector<glm::vec3> over_discs(const SubsurfaceKernel& kernel, float radius_mm) {
    std::vector<glm::vec3> means(kDistanceSteps);
    parallel_for(means.size(), 128, [&](std::size_t begin, std::size_t end) {
        for (std::size_t code = begin; code < end; ++code) {
            const float part = static_cast<float>(code) / static_cast<float>(kDistanceSteps - 1);
            const auto distance_mm = static_cast<double>(part * part * kernel.near_mm);
            means[code] =
                mean_over_disc(distance_mm, static_cast<double>(radius_mm), [&](double distance) {
                    const auto at = static_cast<float>(distance);
                    if (at >= kernel.near_mm) return glm::vec3(0.0f);
                    return kernel.near_per_mm2[distance_code(at, kernel.near_mm)];
                });
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

glm::ivec3 cell_of(const glm::vec3& position, float side_mm) {
    return glm::ivec3(glm::floor(position / side_mm));
}
std::uint64_t cell_key(const glm::ivec3& cell, std::uint64_t kind = 0) {
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
            index =
                known.emplace(cell_key(cell_of(f.position_mm, side_mm), side), index).first->second;
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

/// What lies in and around a cube as wide as the reach, coordinate by coordinate: so is it gone
/// through for each fragment within.
struct Around {
    std::vector<float> x, y, z, nx, ny, nz;
    std::vector<glm::vec4> power;  ///< what enters times the area, and the area
    std::vector<std::uint32_t> patch;
    std::vector<float> part2;         ///< of the fragment at hand: (distance/reach)^2
    std::vector<std::uint32_t> seen;  ///< by it: places here
    std::size_t seen_count = 0;

    void clear() {
        for (auto* list : {&x, &y, &z, &nx, &ny, &nz}) list->clear();
        power.clear();
        patch.clear();
    }
    void add(const FragmentPatch& one, std::uint32_t index) {
        x.push_back(one.position_mm.x);
        y.push_back(one.position_mm.y);
        z.push_back(one.position_mm.z);
        nx.push_back(one.normal.x);
        ny.push_back(one.normal.y);
        nz.push_back(one.normal.z);
        power.emplace_back(one.area_mm2 * one.entering, one.area_mm2);
        patch.push_back(index);
    }
    /// All within reach but the fragment's own patch and those that face away.
    void see_from(const Fragment& own, std::uint32_t own_patch, float reach) {
        const std::size_t all = patch.size();
        part2.resize(all);
        seen.resize(all);
        const float per_mm2 = 1.0f / (reach * reach);
        for (std::size_t k = 0; k < all; ++k) {
            const float dx = x[k] - own.position_mm.x;
            const float dy = y[k] - own.position_mm.y;
            const float dz = z[k] - own.position_mm.z;
            const float facing = own.normal.x * nx[k] + own.normal.y * ny[k] + own.normal.z * nz[k];
            part2[k] = facing > 0.0f ? (dx * dx + dy * dy + dz * dz) * per_mm2 : 1.0f;
        }
        // Each is written, and the next one over it where it is not seen: no branch to foretell
        seen_count = 0;
        for (std::size_t k = 0; k < all; ++k) {
            seen[seen_count] = static_cast<std::uint32_t>(k);
            seen_count += static_cast<std::size_t>((part2[k] < 1.0f) & (patch[k] != own_patch));
        }
    }
    /// Of the n-th that is seen, as distance_code().
    std::size_t code(std::size_t n) const {
        constexpr float kMost = static_cast<float>(kDistanceSteps - 1);
        return static_cast<std::size_t>(
            static_cast<int>(std::sqrt(std::sqrt(part2[seen[n]])) * kMost + 0.5f));
    }
};

/// Places in order of the cube that each lies in, and where each cube's begin.
struct ByCell {
    std::vector<std::uint32_t> order;
    std::vector<std::uint64_t> cells;
    std::vector<std::uint32_t> first;

    template <typename CellOf>
    ByCell(std::size_t count, const CellOf& cell_of) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(count);
        for (std::uint32_t k = 0; k < count; ++k) keyed[k] = {cell_of(k), k};
        std::sort(keyed.begin(), keyed.end());
        for (std::uint32_t k = 0; k < count; ++k) {
            if (cells.empty() || cells.back() != keyed[k].first) {
                cells.push_back(keyed[k].first);
                first.push_back(k);
            }
            order.push_back(keyed[k].second);
        }
        first.push_back(static_cast<std::uint32_t>(count));
    }
};

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
    std::vector<float> areas;
    for (const FragmentPatch& patch : patches.all) areas.push_back(patch.area_mm2);
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    // Where it enters and where it leaves are both averaged: twice the disc
    std::vector<glm::vec4> per_mm2;
    for (const glm::vec3& mean :
         over_discs(kernel, std::sqrt(2.0f * *middle / std::numbers::pi_v<float>))) {
        per_mm2.emplace_back(mean, 0.0f);
    }
    const ByCell patches_in(patches.all.size(), [&](std::uint32_t k) {
        return cell_key(cell_of(patches.all[k].position_mm, reach));
    });
    std::unordered_map<std::uint64_t, std::size_t> place_of;
    for (std::size_t k = 0; k < patches_in.cells.size(); ++k) place_of[patches_in.cells[k]] = k;
    const ByCell own_in(past - first, [&](std::uint32_t k) {
        return cell_key(cell_of(map.fragments[first + k].position_mm, reach));
    });
    parallel_for(own_in.cells.size(), 4, [&](std::size_t begin, std::size_t end) {
        Around around;
        for (std::size_t cell = begin; cell < end; ++cell) {
            const std::span own(own_in.order.data() + own_in.first[cell],
                                own_in.order.data() + own_in.first[cell + 1]);
            const glm::ivec3 here = cell_of(map.fragments[first + own.front()].position_mm, reach);
            around.clear();
            for (int c = 0; c < 27; ++c) {
                const glm::ivec3 step(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1);
                const auto found = place_of.find(cell_key(here + step));
                if (found == place_of.end()) continue;
                for (std::uint32_t k = patches_in.first[found->second];
                     k < patches_in.first[found->second + 1];
                     ++k) {
                    const std::uint32_t patch = patches_in.order[k];
                    around.add(patches.all[patch], patch);
                }
            }
            for (const std::uint32_t k : own) {
                around.see_from(map.fragments[first + k], patches.of[k], reach);
                glm::vec4 all(0.0f), of_areas(0.0f);
                for (std::size_t n = 0; n < around.seen_count; ++n) {
                    const glm::vec4& power = around.power[around.seen[n]];
                    const glm::vec4& weight = per_mm2[around.code(n)];
                    all += weight * power;
                    of_areas += weight * power.w;
                }
                const glm::vec3 sum(all), others(of_areas);
                // Its own pixel has the rest, and what the view does not show is lit as it is
                const glm::vec3 share = glm::max(kernel.near_share, glm::vec3(1e-20f));
                const glm::vec3 own_share = glm::max(share - others, glm::vec3(0.0f));
                nearby[first + k] = (sum + own_share * entering[k]) / glm::max(others, share);
            }
        }
    });
    return nearby;
}

}  // namespace livery
