#include "calibration/environment/map_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr double kCoarse_rad = 2.0 * std::numbers::pi / 180.0;
constexpr float kSeen = 0.5f;
constexpr int kNormals = 512, kCellsAcross = 128;

double luminance(const ImageF& map, std::size_t texel) {
    const float* value = map.values.data() + 3 * texel;
    const glm::dmat3& xyz = xyz_from_rec709();
    return xyz[0].y * static_cast<double>(value[0]) + xyz[1].y * static_cast<double>(value[1]) +
           xyz[2].y * static_cast<double>(value[2]);
}

/// Light from one direction: luminance times solid angle.
struct Beam {
    glm::dvec3 direction;
    double light;
};

/// The map as beams, texels of a cell together.
std::vector<Beam> beams_of(const ImageF& map) {
    const int step = std::max(1, map.width / kCellsAcross);
    std::vector<Beam> beams;
    for (int y0 = 0; y0 < map.height; y0 += step) {
        for (int x0 = 0; x0 < map.width; x0 += step) {
            glm::dvec3 middle(0.0);
            double light = 0.0;
            for (int y = y0; y < std::min(y0 + step, map.height); ++y) {
                const double sr = texel_sr(map, y);
                for (int x = x0; x < std::min(x0 + step, map.width); ++x) {
                    const double one = sr * luminance(map, map.index(x, y) / 3);
                    light += one;
                    middle += one * texel_direction(map, x, y);
                }
            }
            if (light > 0.0) beams.push_back({glm::normalize(middle), light});
        }
    }
    return beams;
}

double irradiance(const std::vector<Beam>& beams, const glm::dvec3& normal) {
    double sum = 0.0;
    for (const Beam& beam : beams) {
        sum += beam.light * std::max(glm::dot(beam.direction, normal), 0.0);
    }
    return sum;
}

}  // namespace

std::vector<ClippedLamp> clipped_lamps(const RadianceMap& map) {
    const ImageF& radiance = map.radiance;
    const int width = radiance.width, height = radiance.height;
    std::vector<std::uint8_t> visited(map.saturated.values.size(), 0);
    std::vector<ClippedLamp> lamps;
    const auto beams = beams_of(radiance);
    for (std::size_t start = 0; start < visited.size(); ++start) {
        if (visited[start] != 0 || map.saturated.values[start] <= 0.0f) continue;
        std::vector<std::size_t> open{start};
        visited[start] = 1;
        ClippedLamp lamp;
        glm::dvec3 middle(0.0);
        double light = 0.0;
        while (!open.empty()) {
            const std::size_t texel = open.back();
            open.pop_back();
            const int x = static_cast<int>(texel % static_cast<std::size_t>(width));
            const int y = static_cast<int>(texel / static_cast<std::size_t>(width));
            const double sr = texel_sr(radiance, y), one = sr * luminance(radiance, texel);
            middle += one * texel_direction(radiance, x, y);
            light += one;
            lamp.solid_angle_sr += sr;
            ++lamp.texels;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
                for (int u = x - 1; u <= x + 1; ++u) {
                    const std::size_t other = map.saturated.index((u % width + width) % width, v);
                    if (visited[other] != 0 || map.saturated.values[other] <= 0.0f) continue;
                    visited[other] = 1;
                    open.push_back(other);
                }
            }
        }
        // Light all around has no middle.
        lamp.direction = glm::length(middle) > 0.0 ? glm::normalize(middle) : glm::dvec3(0, 1, 0);
        lamp.luminance = light / lamp.solid_angle_sr;
        const double all = irradiance(beams, lamp.direction);
        lamp.irradiance_share =
            all > 0.0 ? std::min(glm::dot(middle, lamp.direction) / all, 1.0) : 0.0;
        lamps.push_back(lamp);
    }
    std::sort(lamps.begin(), lamps.end(), [](const ClippedLamp& a, const ClippedLamp& b) {
        return a.irradiance_share > b.irradiance_share;
    });
    return lamps;
}

double brightest_white(const ImageF& radiance_rec709) {
    const auto beams = beams_of(radiance_rec709);
    double most = 0.0;
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int k = 0; k < kNormals; ++k) {
        const double y = 1.0 - (2.0 * k + 1.0) / kNormals, r = std::sqrt(1.0 - y * y);
        const glm::dvec3 normal(r * std::cos(golden_angle * k), y, r * std::sin(golden_angle * k));
        most = std::max(most, irradiance(beams, normal) / std::numbers::pi);
    }
    return most;
}

double dynamic_range_stops(const RadianceMap& map) {
    std::vector<double> seen;
    double brightest = 0.0;
    for (std::size_t k = 0; k < map.seen.values.size(); ++k) {
        if (map.seen.values[k] < kSeen) continue;
        const double value = luminance(map.radiance, k);
        brightest = std::max(brightest, value);
        if (value > 0.0) seen.push_back(value);
    }
    const double dark = quantile(std::move(seen), 0.01);
    return dark > 0.0 ? std::log2(brightest / dark) : 0.0;
}

Coverage coverage_of(const RadianceMap& map) {
    Coverage coverage;
    for (int y = 0; y < map.seen.height; ++y) {
        const double share = texel_sr(map.seen, y) / (4.0 * std::numbers::pi);
        for (int x = 0; x < map.seen.width; ++x) {
            if (map.seen.at(x, y) < kSeen) continue;
            const auto widest = static_cast<double>(map.widest_rad.at(x, y));
            (widest <= kCoarse_rad ? coverage.covered : coverage.coarse) += share;
        }
    }
    return coverage;
}

}  // namespace livery
