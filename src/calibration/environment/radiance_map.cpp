#include "calibration/environment/radiance_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"
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

namespace {

constexpr float kKnown = 0.5f;
constexpr double kResidual = 1e-6;  ///< of the equation, relative to where it began
constexpr int kMostSteps = 20'000;
/// A lamp at a hole's edge is not continued into it: what is brighter than so many times the median
/// of the edge counts as that.
constexpr double kBrightestEdge = 3.0;

/// Texels to solve for, with what each exchanges with its four neighbours.
class Laplace {
  public:
    explicit Laplace(const RadianceMap& map) : width_(map.seen.width), height_(map.seen.height) {
        place_.assign(map.seen.values.size(), kNone);
        for (std::size_t k = 0; k < place_.size(); ++k) {
            if (map.seen.values[k] >= kKnown) continue;
            place_[k] = static_cast<std::int32_t>(texels_.size());
            texels_.push_back(k);
        }
    }

    std::size_t size() const { return texels_.size(); }
    std::size_t texel(std::size_t unknown) const { return texels_[unknown]; }
    std::size_t count() const { return place_.size(); }

    /// Calls visit(neighbour's texel, weight): the shared edge's length over the middles' distance.
    template <typename Visit>
    void around(std::size_t texel, const Visit& visit) const {
        const auto width = static_cast<std::size_t>(width_);
        const std::size_t y = texel / width, x = texel % width;
        const double row = static_cast<double>(y);
        const double dtheta = std::numbers::pi / height_, dphi = 2.0 * std::numbers::pi / width_;
        const double sideways = dtheta / (dphi * std::sin(dtheta * (row + 0.5)));
        visit(y * width + (x + 1) % width, sideways);
        visit(y * width + (x + width - 1) % width, sideways);
        // No light crosses a pole: its edge has no length.
        if (y > 0) visit(texel - width, std::sin(dtheta * row) * dphi / dtheta);
        if (y + 1 < static_cast<std::size_t>(height_)) {
            visit(texel + width, std::sin(dtheta * (row + 1.0)) * dphi / dtheta);
        }
    }

    bool is_unknown(std::size_t texel) const { return place_[texel] != kNone; }
    std::size_t unknown(std::size_t texel) const { return static_cast<std::size_t>(place_[texel]); }

    /// The operator on the unknown texels alone.
    void apply(const std::vector<double>& x, std::vector<double>& result) const {
        for (std::size_t k = 0; k < size(); ++k) {
            double sum = 0.0;
            around(texels_[k], [&](std::size_t other, double weight) {
                sum += weight * (x[k] - (is_unknown(other) ? x[unknown(other)] : 0.0));
            });
            result[k] = sum;
        }
    }
    double diagonal(std::size_t k) const {
        double sum = 0.0;
        around(texels_[k], [&](std::size_t, double weight) { sum += weight; });
        return sum;
    }

  private:
    static constexpr std::int32_t kNone = -1;
    int width_, height_;
    std::vector<std::int32_t> place_;
    std::vector<std::size_t> texels_;
};

/// Which hole each unknown texel belongs to, from 0 on.
std::vector<std::size_t> holes_of(const Laplace& laplace, std::size_t& count) {
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::vector<std::size_t> hole(laplace.size(), kNone);
    count = 0;
    for (std::size_t start = 0; start < hole.size(); ++start) {
        if (hole[start] != kNone) continue;
        std::vector<std::size_t> open{start};
        hole[start] = count;
        while (!open.empty()) {
            const std::size_t texel = laplace.texel(open.back());
            open.pop_back();
            laplace.around(texel, [&](std::size_t other, double) {
                if (!laplace.is_unknown(other)) return;
                const std::size_t k = laplace.unknown(other);
                if (hole[k] != kNone) return;
                hole[k] = count;
                open.push_back(k);
            });
        }
        ++count;
    }
    return hole;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

/// Conjugate gradients, preconditioned by the diagonal; `x` holds where to begin.
void solve(const Laplace& laplace, const std::vector<double>& right, std::vector<double>& x) {
    const std::size_t n = laplace.size();
    std::vector<double> inverse(n), residual(n), scaled(n), step(n), product(n);
    for (std::size_t k = 0; k < n; ++k) inverse[k] = 1.0 / laplace.diagonal(k);
    laplace.apply(x, product);
    for (std::size_t k = 0; k < n; ++k) {
        residual[k] = right[k] - product[k];
        scaled[k] = inverse[k] * residual[k];
        step[k] = scaled[k];
    }
    double size = dot(residual, scaled);
    const double enough = kResidual * kResidual * size;
    for (int round = 0; round < kMostSteps && size > enough; ++round) {
        laplace.apply(step, product);
        const double length = size / dot(step, product);
        for (std::size_t k = 0; k < n; ++k) {
            x[k] += length * step[k];
            residual[k] -= length * product[k];
            scaled[k] = inverse[k] * residual[k];
        }
        const double next = dot(residual, scaled);
        for (std::size_t k = 0; k < n; ++k) step[k] = scaled[k] + next / size * step[k];
        size = next;
    }
}

}  // namespace

double fill_unseen(RadianceMap& map) {
    const Laplace laplace(map);
    if (laplace.size() == laplace.count()) {
        throw Refused("the photographs show no direction's light",
                      "check camera and sphere in manifest.json, and the masks");
    }
    double filled = 0.0;
    for (std::size_t k = 0; k < laplace.size(); ++k) {
        const auto row = laplace.texel(k) / static_cast<std::size_t>(map.seen.width);
        filled += texel_sr(map.seen, static_cast<int>(row)) / (4.0 * std::numbers::pi);
    }
    std::size_t holes = 0;
    const std::vector<std::size_t> hole = holes_of(laplace, holes);
    for (std::size_t c = 0; c < 3 && laplace.size() > 0; ++c) {
        const auto value = [&](std::size_t texel) {
            return static_cast<double>(map.radiance.values[3 * texel + c]);
        };
        std::vector<std::vector<double>> edges(holes);
        for (std::size_t k = 0; k < laplace.size(); ++k) {
            laplace.around(laplace.texel(k), [&](std::size_t other, double) {
                if (!laplace.is_unknown(other)) edges[hole[k]].push_back(value(other));
            });
        }
        std::vector<double> middle, low;
        for (const std::vector<double>& edge : edges) {
            middle.push_back(median(edge));
            low.push_back(*std::min_element(edge.begin(), edge.end()));
        }
        std::vector<double> right(laplace.size(), 0.0), x(laplace.size());
        for (std::size_t k = 0; k < laplace.size(); ++k) {
            x[k] = middle[hole[k]];
            laplace.around(laplace.texel(k), [&](std::size_t other, double weight) {
                if (laplace.is_unknown(other)) return;
                right[k] += weight * std::min(value(other), kBrightestEdge * middle[hole[k]]);
            });
        }
        solve(laplace, right, x);
        for (std::size_t k = 0; k < laplace.size(); ++k) {
            // What the solver leaves unsolved must not break what a harmonic function promises.
            map.radiance.values[3 * laplace.texel(k) + c] = static_cast<float>(std::clamp(
                x[k], low[hole[k]], std::max(low[hole[k]], kBrightestEdge * middle[hole[k]])));
        }
    }
    return filled;
}

}  // namespace livery
