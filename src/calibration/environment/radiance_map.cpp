#include "calibration/environment/radiance_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/look.h"

namespace livery {

namespace {

constexpr double kPartsAPixel = 1.5;  ///< looks a pixel's width
constexpr int kFewestParts = 2, kMostParts = 32, kEdgeParts = 4;
/// How little a clipped picture counts beside one that is not.
constexpr double kClippedWeight = 1e-9;

const Environment& unturned() {
    static const Environment environment;
    return environment;
}

int parts_of(double texel_rad, double pixel_rad) {
    return std::clamp(
        static_cast<int>(std::ceil(std::min(kPartsAPixel * texel_rad / pixel_rad, 1e3))),
        kFewestParts,
        kMostParts);
}

/// The polar angle at a share of a row, even in solid angle.
double polar_at(int height, int y, double share) {
    const double from = std::cos(std::numbers::pi * y / height),
                 to = std::cos(std::numbers::pi * (y + 1) / height);
    return std::acos(std::clamp(from + (to - from) * share, -1.0, 1.0));
}

void gather_texel(const LightPicture& picture,
                  const SeeDirection& see,
                  bool wraps,
                  int x,
                  int y,
                  RadianceMap& map) {
    const int width = map.radiance.width, height = map.radiance.height;
    const auto middle = see(texel_direction(map.radiance, x, y));
    const double row_rad =
        2.0 * std::numbers::pi / width * std::sin(std::numbers::pi * (y + 0.5) / height);
    const int across = middle ? parts_of(row_rad, middle->finest_rad) : kEdgeParts;
    const int down = middle ? parts_of(std::numbers::pi / height, middle->finest_rad) : kEdgeParts;
    glm::dvec3 sum(0.0);
    double saturated = 0.0, widest = 0.0;
    int seen = 0;
    for (int v = 0; v < down; ++v) {
        const double polar = polar_at(height, y, (v + 0.5) / down);
        for (int u = 0; u < across; ++u) {
            const glm::dvec3 direction = direction_from_uv(
                unturned(), {(x + (u + 0.5) / across) / width, polar / std::numbers::pi});
            const auto at = see(direction);
            if (!at) continue;
            const auto light = sample(picture, at->pixel, wraps);
            if (!light) continue;
            sum += light->light / at->passed;
            saturated += light->saturated;
            widest += at->widest_rad;
            ++seen;
        }
    }
    if (seen == 0) return;
    for (int c = 0; c < 3; ++c) map.radiance.at(x, y, c) = static_cast<float>(sum[c] / seen);
    map.seen.at(x, y) = static_cast<float>(seen) / static_cast<float>(across * down);
    map.widest_rad.at(x, y) = static_cast<float>(widest / seen);
    map.saturated.at(x, y) = static_cast<float>(saturated / seen);
}

RadianceMap empty_map(int width) {
    const int height = width / 2;
    return {ImageF(width, height, 3),
            ImageF(width, height, 1),
            ImageF(width, height, 1),
            ImageF(width, height, 1)};
}

}  // namespace

glm::dvec3 texel_direction(const ImageF& map, int x, int y) {
    return direction_from_uv(unturned(), {(x + 0.5) / map.width, (y + 0.5) / map.height});
}

double texel_sr(const ImageF& map, int y) {
    return 2.0 * std::numbers::pi / map.width *
           (std::cos(std::numbers::pi * y / map.height) -
            std::cos(std::numbers::pi * (y + 1) / map.height));
}

RadianceMap gather(const LightPicture& picture,
                   const SeeDirection& see,
                   bool wraps,
                   int width,
                   const Progress& progress) {
    check_argument(width > 0 && width % 2 == 0, fmt::format("gather: a map {} wide", width));
    RadianceMap map = empty_map(width);
    parallel_for(
        static_cast<std::size_t>(map.radiance.height), 2, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                progress.check_stop();
                for (int x = 0; x < width; ++x) {
                    gather_texel(picture, see, wraps, x, static_cast<int>(y), map);
                }
            }
        });
    return map;
}

RadianceMap merge(std::span<const RadianceMap> maps) {
    check_argument(!maps.empty(), "merge: no maps");
    if (maps.size() == 1) return maps.front();
    RadianceMap merged = empty_map(maps.front().radiance.width);
    for (const RadianceMap& map : maps) {
        check_argument(
            map.radiance.width == merged.radiance.width &&
                map.radiance.height == merged.radiance.height,
            fmt::format("merge: maps {} and {} wide", map.radiance.width, merged.radiance.width));
    }
    for (std::size_t k = 0; k < merged.seen.values.size(); ++k) {
        glm::dvec3 sum(0.0);
        double weights = 0.0, saturated = 0.0;
        for (const RadianceMap& map : maps) {
            const auto share = static_cast<double>(map.seen.values[k]);
            if (share <= 0.0) continue;
            const auto pixel_rad = static_cast<double>(map.widest_rad.values[k]);
            const auto clipped = static_cast<double>(map.saturated.values[k]);
            const double weight =
                share / (pixel_rad * pixel_rad) * (clipped > 0.0 ? kClippedWeight : 1.0);
            const float* light = map.radiance.values.data() + 3 * k;
            sum += weight * glm::dvec3(light[0], light[1], light[2]);
            saturated += weight * clipped;
            weights += weight;
            float& finest = merged.widest_rad.values[k];
            const float here = map.widest_rad.values[k];
            finest = finest > 0.0f ? std::min(finest, here) : here;
            merged.seen.values[k] = std::max(merged.seen.values[k], map.seen.values[k]);
        }
        if (weights <= 0.0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            merged.radiance.values[3 * k + c] =
                static_cast<float>(sum[static_cast<int>(c)] / weights);
        }
        // Only where no picture is without it.
        const double share = saturated / weights;
        merged.saturated.values[k] = share > 1e-3 ? static_cast<float>(share) : 0.0f;
    }
    return merged;
}

}  // namespace livery
