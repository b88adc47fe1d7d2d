#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "calibration/correspondence/gray_code.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// The camera pixels that decoded to one projector pixel, without those far from their median.
struct Bin {
    float count = 0.0f;
    float x = 0.0f, y = 0.0f;  ///< mean camera position
    float u = 0.0f, v = 0.0f;  ///< mean place, off the projector pixel's centre
};

struct Bins {
    int width = 0, height = 0;
    std::vector<Bin> bins;
    double camera_px_per_pixel = 1.0;  ///< along one axis

    const Bin* find(int x, int y) const {
        if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
        const Bin& bin = bins[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
        return bin.count > 0.0f ? &bin : nullptr;
    }
};

/// The decoded pixels (non-zero) without those that agree with fewer than two of the eight around
/// them to within `reach` projector pixels: in a shadow that other parts light, codes come out at
/// random and name places elsewhere.
Image8 without_strays(const CameraToProjector& decoded, double reach) {
    constexpr int kLeastAgreeing = 2;  // of eight; a corner pixel of a panel keeps three
    const int width = decoded.decoded.width, height = decoded.decoded.height;
    Image8 kept = decoded.decoded;
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                if (!decoded.decoded.at(x, y)) continue;
                const float* const own = decoded.projector_px.pixel(x, y);
                int agreeing = 0;
                for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
                    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
                        if ((u == x && v == y) || !decoded.decoded.at(u, v)) continue;
                        const float* const other = decoded.projector_px.pixel(u, v);
                        agreeing += std::abs(static_cast<double>(own[0] - other[0])) <= reach &&
                                    std::abs(static_cast<double>(own[1] - other[1])) <= reach;
                    }
                if (agreeing < kLeastAgreeing) kept.at(x, y) = 0;
            }
    });
    return kept;
}

/// `kept` says which camera pixels count. Where some of a projector pixel's are known finely, the
/// others are left out of its mean.
Bins gather(const CameraToProjector& decoded, const Image8& kept, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto place_of = [&](std::size_t i) {
        const auto x = static_cast<std::size_t>(decoded.projector_px.values[2 * i]);
        const auto y = static_cast<std::size_t>(decoded.projector_px.values[2 * i + 1]);
        return y * static_cast<std::size_t>(width) + x;
    };

    // Counting sort of the camera pixels by projector pixel
    std::vector<std::uint32_t> first(pixels + 1, 0);
    std::size_t total = 0;
    for (std::size_t i = 0; i < kept.values.size(); ++i)
        if (kept.values[i]) {
            ++first[place_of(i) + 1];
            ++total;
        }
    std::size_t hit = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        hit += first[p + 1] > 0;
        first[p + 1] += first[p];
    }
    std::vector<std::uint32_t> order(total), next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < kept.values.size(); ++i)
        if (kept.values[i]) order[next[place_of(i)]++] = static_cast<std::uint32_t>(i);

    Bins result;
    result.width = width;
    result.height = height;
    result.bins.resize(pixels);

    // Scale: how densely the camera samples, from bins with neighbours on all sides. Where few
    // pixels are hit at all, the camera is coarser than the projector, and the share tells.
    std::size_t inner = 0, inner_samples = 0;
    for (int y = 2; y + 2 < height; ++y)
        for (int x = 2; x + 2 < width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x);
            const auto row = static_cast<std::size_t>(width);
            const std::size_t around = first[p - row + 2] - first[p - row - 1];
            const std::size_t middle = first[p + 2] - first[p - 1];
            const std::size_t below = first[p + row + 2] - first[p + row - 1];
            if (around == 0 || middle == 0 || below == 0) continue;
            inner += 9;
            inner_samples += around + middle + below;
        }
    const double density =
        inner > 0 ? static_cast<double>(inner_samples) / static_cast<double>(inner)
                  : static_cast<double>(total) / static_cast<double>(std::max<std::size_t>(hit, 1));
    result.camera_px_per_pixel = std::sqrt(std::max(density, 0.01));

    // Mean of each bin without strays
    const auto camera_width = static_cast<std::uint32_t>(decoded.decoded.width);
    const auto reach = static_cast<float>(1.5 * result.camera_px_per_pixel + 1.0);
    const auto is_fine = [&](std::uint32_t i) {
        return !decoded.sigma_px.empty() && decoded.sigma_px.values[2 * i] < kWholePixelError;
    };
    parallel_for(pixels, 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<float> xs, ys;
        for (std::size_t p = begin; p < end; ++p) {
            if (first[p] == first[p + 1]) continue;
            xs.clear();
            ys.clear();
            bool any_fine = false;
            for (std::uint32_t k = first[p]; k < first[p + 1]; ++k) {
                xs.push_back(static_cast<float>(order[k] % camera_width) + 0.5f);
                ys.push_back(static_cast<float>(order[k] / camera_width) + 0.5f);
                any_fine = any_fine || is_fine(order[k]);
            }
            const bool few = xs.size() < 3;
            const float centre_x = few ? xs[0] : median(xs);
            const float centre_y = few ? ys[0] : median(ys);
            const glm::vec2 middle(static_cast<float>(p % static_cast<std::size_t>(width)) + 0.5f,
                                   static_cast<float>(p / static_cast<std::size_t>(width)) + 0.5f);
            Bin& bin = result.bins[p];
            for (const bool fine : {true, false}) {
                for (std::size_t k = 0; k < xs.size(); ++k) {
                    const std::uint32_t i = order[first[p] + k];
                    if ((any_fine && is_fine(i) != fine) || std::abs(xs[k] - centre_x) > reach ||
                        std::abs(ys[k] - centre_y) > reach)
                        continue;
                    bin.count += 1.0f;
                    bin.x += xs[k];
                    bin.y += ys[k];
                    bin.u += decoded.projector_px.values[2 * i] - middle.x;
                    bin.v += decoded.projector_px.values[2 * i + 1] - middle.y;
                }
                if (bin.count > 0.0f) break;
            }
            for (float* sum : {&bin.x, &bin.y, &bin.u, &bin.v}) *sum /= bin.count;
        }
    });
    return result;
}

struct WindowSample {
    float dx, dy;  ///< projector offset
    float x, y;    ///< camera offset from the seed
    float weight;
};

/// Value at the origin of a weighted affine fit x(dx, dy); nothing when the samples lie on a line.
struct Affine {
    glm::dvec2 value, along_x, along_y;
    glm::dvec2 at(double dx, double dy) const { return value + along_x * dx + along_y * dy; }
};

std::optional<Affine> fit_affine(const WindowSample* samples, int count) {
    double w = 0, wx = 0, wy = 0;
    glm::dvec2 wc(0.0);
    for (int i = 0; i < count; ++i) {
        const WindowSample& s = samples[i];
        w += s.weight;
        wx += s.weight * s.dx;
        wy += s.weight * s.dy;
        wc += static_cast<double>(s.weight) * glm::dvec2(s.x, s.y);
    }
    if (w < 4.0) return std::nullopt;
    const double mx = wx / w, my = wy / w;
    const glm::dvec2 mc = wc / w;
    double xx = 0, xy = 0, yy = 0;
    glm::dvec2 xc(0.0), yc(0.0);
    for (int i = 0; i < count; ++i) {
        const WindowSample& s = samples[i];
        const double dx = s.dx - mx, dy = s.dy - my;
        const glm::dvec2 dc = glm::dvec2(s.x, s.y) - mc;
        xx += s.weight * dx * dx;
        xy += s.weight * dx * dy;
        yy += s.weight * dy * dy;
        xc += s.weight * dx * dc;
        yc += s.weight * dy * dc;
    }
    const double determinant = xx * yy - xy * xy;
    if (determinant < 0.02 * w * w) return std::nullopt;
    Affine fit;
    fit.along_x = (yy * xc - xy * yc) / determinant;
    fit.along_y = (xx * yc - xy * xc) / determinant;
    fit.value = mc - fit.along_x * mx - fit.along_y * my;
    return fit;
}

constexpr int kMaxRadius = 4;
constexpr int kMaxSide = 2 * kMaxRadius + 1;

/// The bins around a projector pixel, each of which belongs to one piece of surface.
struct SearchWindow {
    int radius = 0, side = 0;
    std::array<const Bin*, kMaxSide * kMaxSide> bins{};
    std::array<bool, kMaxSide * kMaxSide> seen{};  ///< already part of a piece
    int filled = 0;                                ///< bins that hold something
};

SearchWindow window_around(const Bins& bins, int x, int y, int radius) {
    SearchWindow window;
    window.radius = radius;
    window.side = 2 * radius + 1;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const Bin* const bin = bins.find(x + dx, y + dy);
            window.bins[static_cast<std::size_t>((dy + radius) * window.side + dx + radius)] = bin;
            window.filled += bin != nullptr;
        }
    return window;
}

/// The unseen bin nearest to the middle, within `reach`; -1: none.
int seed_of(const SearchWindow& window, int reach) {
    for (int ring = 0; ring <= reach; ++ring)
        for (int dy = -ring; dy <= ring; ++dy)
            for (int dx = -ring; dx <= ring; ++dx) {
                const int k = (dy + window.radius) * window.side + dx + window.radius;
                if (std::max(std::abs(dx), std::abs(dy)) == ring &&
                    window.bins[static_cast<std::size_t>(k)] &&
                    !window.seen[static_cast<std::size_t>(k)])
                    return k;
            }
    return -1;
}

/// What can be reached from the seed without a jump, flood-filled inside the window.
int connected_samples(SearchWindow& around,
                      float scale,
                      int seed,
                      int link_reach,
                      std::array<WindowSample, kMaxSide * kMaxSide>& samples) {
    const int side = around.side, radius = around.radius;
    const auto& window = around.bins;
    auto& seen = around.seen;
    std::array<int, kMaxSide * kMaxSide> queue{};
    int queued = 0, count = 0;
    queue[static_cast<std::size_t>(queued++)] = seed;
    seen[static_cast<std::size_t>(seed)] = true;
    const Bin& origin = *window[static_cast<std::size_t>(seed)];
    for (int head = 0; head < queued; ++head) {
        const int k = queue[static_cast<std::size_t>(head)];
        const Bin& bin = *window[static_cast<std::size_t>(k)];
        const int bx = k % side, by = k / side;
        samples[static_cast<std::size_t>(count++)] = {static_cast<float>(bx - radius) + bin.u,
                                                      static_cast<float>(by - radius) + bin.v,
                                                      bin.x - origin.x,
                                                      bin.y - origin.y,
                                                      bin.count};
        for (int ny = std::max(0, by - link_reach); ny <= std::min(side - 1, by + link_reach); ++ny)
            for (int nx = std::max(0, bx - link_reach); nx <= std::min(side - 1, bx + link_reach);
                 ++nx) {
                const auto n = static_cast<std::size_t>(ny * side + nx);
                if (seen[n] || !window[n]) continue;
                // A step of one projector pixel moves about `scale` in the camera, up to three
                // times that where the surface turns away, plus rounding.
                const auto steps =
                    static_cast<float>(std::max(std::abs(nx - bx), std::abs(ny - by)));
                const float limit = 2.5f * scale * steps + 1.0f;
                if (std::abs(window[n]->x - bin.x) > limit ||
                    std::abs(window[n]->y - bin.y) > limit)
                    continue;
                seen[n] = true;
                queue[static_cast<std::size_t>(queued++)] = static_cast<int>(n);
            }
    }
    return count;
}

struct Located {
    glm::dvec2 camera{0.0};
    bool filled = false;    ///< from neighbours: the pixel's own bin lies elsewhere or nowhere
    float sigma_px = 0.0f;  ///< of `camera` along an axis, by the fit's residuals
};

std::optional<Located> fit_piece(const Bins& bins,
                                 const Bin& seed,
                                 std::array<WindowSample, kMaxSide * kMaxSide>& samples,
                                 int count) {
    if (count < 4) return std::nullopt;
    const double tolerance = 1.0 + 0.75 * bins.camera_px_per_pixel;
    std::optional<Affine> fit;
    for (int round = 0; round < 3; ++round) {
        fit = fit_affine(samples.data(), count);
        if (!fit) return std::nullopt;
        const auto is_far = [&](const WindowSample& s) {
            const glm::dvec2 error = glm::dvec2(s.x, s.y) - fit->at(s.dx, s.dy);
            return std::max(std::abs(error.x), std::abs(error.y)) > tolerance;
        };
        const auto kept = std::remove_if(samples.begin(), samples.begin() + count, is_far);
        const int left = static_cast<int>(kept - samples.begin());
        if (left == count) break;
        count = left;
        if (count < 4) return std::nullopt;
    }
    // No extrapolation: projector pixels must lie on both sides along both axes.
    float low_x = 1e9f, high_x = -1e9f, low_y = 1e9f, high_y = -1e9f;
    for (int i = 0; i < count; ++i) {
        const WindowSample& s = samples[static_cast<std::size_t>(i)];
        low_x = std::min(low_x, s.dx);
        high_x = std::max(high_x, s.dx);
        low_y = std::min(low_y, s.dy);
        high_y = std::max(high_y, s.dy);
    }
    // Half a pixel: places within their own projector pixel lie on its both sides.
    if (low_x > 0.5f || high_x < -0.5f || low_y > 0.5f || high_y < -0.5f) return std::nullopt;
    double squares = 0.0;
    for (int i = 0; i < count; ++i) {
        const WindowSample& s = samples[static_cast<std::size_t>(i)];
        const glm::dvec2 error = glm::dvec2(s.x, s.y) - fit->at(s.dx, s.dy);
        squares += 0.5 * glm::dot(error, error);
    }
    const double variance = squares / (std::max(count - 3, 1) * static_cast<double>(count));
    return Located{
        fit->value + glm::dvec2(seed.x, seed.y), false, static_cast<float>(std::sqrt(variance))};
}

/// From the piece of surface that the pixel's own bin belongs to, else (a stray) most of the
/// window.
std::optional<Located> locate(const Bins& bins, int x, int y, int radius, int link_reach) {
    SearchWindow window = window_around(bins, x, y, radius);
    const auto scale = static_cast<float>(bins.camera_px_per_pixel);
    std::array<WindowSample, kMaxSide * kMaxSide> samples;
    const bool has_own = bins.find(x, y) != nullptr;
    for (int attempt = 0, seed; (seed = seed_of(window, link_reach)) >= 0; ++attempt) {
        const int count = connected_samples(window, scale, seed, link_reach, samples);
        if (attempt > 0 && 5 * count < 3 * window.filled) continue;
        auto located =
            fit_piece(bins, *window.bins[static_cast<std::size_t>(seed)], samples, count);
        if (!located) continue;
        located->filled = has_own && attempt > 0;
        return located;
    }
    return std::nullopt;
}

/// What the camera pixels are that a sample is read from.
enum class Sees { this_place, with_gap, another };

/// Whether they see this place alone. One not decoded while those around it see this place is a
/// gap.
Sees seen_there(const CameraToProjector& decoded,
                const Image8& kept,
                glm::dvec2 camera,
                int x,
                int y,
                double reach) {
    constexpr int kSurrounded = 6;  // of eight
    const int left = static_cast<int>(std::floor(camera.x - 0.5));
    const int top = static_cast<int>(std::floor(camera.y - 0.5));
    if (left < 0 || top < 0 || left + 1 >= kept.width || top + 1 >= kept.height)
        return Sees::another;
    const auto is_here = [&](int cx, int cy, double within) {
        if (cx < 0 || cy < 0 || cx >= kept.width || cy >= kept.height || !kept.at(cx, cy))
            return false;
        const float* const place = decoded.projector_px.pixel(cx, cy);
        return std::abs(static_cast<double>(place[0]) - x - 0.5) <= within &&
               std::abs(static_cast<double>(place[1]) - y - 0.5) <= within;
    };
    Sees sees = Sees::this_place;
    for (int cy = top; cy <= top + 1; ++cy)
        for (int cx = left; cx <= left + 1; ++cx) {
            if (is_here(cx, cy, reach)) continue;
            int around = 0;
            for (int v = cy - 1; v <= cy + 1; ++v)
                for (int u = cx - 1; u <= cx + 1; ++u)
                    around += (u != cx || v != cy) && is_here(u, v, reach + 1.0);
            if (kept.at(cx, cy) || around < kSurrounded) return Sees::another;
            sees = Sees::with_gap;
        }
    return sees;
}

/// Places of small holes, where the neighbours agree and no camera pixel there sees another place.
void fill_holes(const CameraToProjector& decoded,
                const Image8& kept,
                double scale,
                double reach,
                ProjectorToCamera& map) {
    // Seven: then one lies in the hole's own row or column, and a jump in depth shows.
    constexpr int kSurrounded = 7, kRounds = 2;
    const int width = map.edge.width, height = map.edge.height;
    const auto is_placed = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < width && y < height &&
               std::isfinite(map.camera_px.at(x, y)) && !map.edge.at(x, y);
    };
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::pair<std::size_t, glm::vec2>> found;
        for (int y = 1; y + 1 < height; ++y)
            for (int x = 1; x + 1 < width; ++x) {
                if (is_placed(x, y)) continue;
                std::array<WindowSample, 8> around;
                int count = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                        if ((dx != 0 || dy != 0) && is_placed(x + dx, y + dy))
                            around[static_cast<std::size_t>(count++)] = {
                                static_cast<float>(dx),
                                static_cast<float>(dy),
                                map.camera_px.at(x + dx, y + dy, 0),
                                map.camera_px.at(x + dx, y + dy, 1),
                                1.0f};
                if (count < kSurrounded) continue;
                const auto fit = fit_affine(around.data(), count);
                if (!fit) continue;
                const double steepest = 2.5 * scale + 0.5;
                bool agree =
                    glm::length(fit->along_x) < steepest && glm::length(fit->along_y) < steepest;
                for (int i = 0; i < count; ++i) {
                    const WindowSample& s = around[static_cast<std::size_t>(i)];
                    const glm::dvec2 off = glm::dvec2(s.x, s.y) - fit->at(s.dx, s.dy);
                    agree = agree && glm::dot(off, off) <= 0.25 * std::max(1.0, scale * scale);
                }
                if (!agree) continue;
                bool free = true;
                const int left = static_cast<int>(std::floor(fit->value.x - 0.5));
                const int top = static_cast<int>(std::floor(fit->value.y - 0.5));
                for (int cy = top; cy <= top + 1; ++cy)
                    for (int cx = left; cx <= left + 1; ++cx) {
                        if (cx < 0 || cy < 0 || cx >= kept.width || cy >= kept.height) {
                            free = false;
                        } else if (kept.at(cx, cy)) {
                            const float* const place = decoded.projector_px.pixel(cx, cy);
                            free = free &&
                                   std::abs(static_cast<double>(place[0]) - x - 0.5) <= reach &&
                                   std::abs(static_cast<double>(place[1]) - y - 0.5) <= reach;
                        }
                    }
                if (free) found.emplace_back(map.edge.index(x, y), glm::vec2(fit->value));
            }
        for (const auto& [p, camera] : found) {
            map.camera_px.values[2 * p] = camera.x;
            map.camera_px.values[2 * p + 1] = camera.y;
            map.edge.values[p] = 0;
            map.filled.values[p] = 255;
        }
    }
}

}  // namespace

ProjectorToCamera invert_map(const CameraToProjector& decoded,
                             int projector_width,
                             int projector_height) {
    check_argument(projector_width >= 2 && projector_height >= 2, "projector size is under 2x2");
    check_argument(decoded.projector_px.channels == 2 &&
                       decoded.projector_px.width == decoded.decoded.width &&
                       decoded.projector_px.height == decoded.decoded.height,
                   "decoded planes differ in size");
    for (std::size_t i = 0; i < decoded.decoded.values.size(); ++i)
        check_argument(
            !decoded.decoded.values[i] ||
                (decoded.projector_px.values[2 * i] >= 0.0f &&
                 decoded.projector_px.values[2 * i] < static_cast<float>(projector_width) &&
                 decoded.projector_px.values[2 * i + 1] >= 0.0f &&
                 decoded.projector_px.values[2 * i + 1] < static_cast<float>(projector_height)),
            "a decoded projector pixel lies outside " + std::to_string(projector_width) + "x" +
                std::to_string(projector_height));

    Bins bins = gather(decoded, decoded.decoded, projector_width, projector_height);
    const Image8 kept = without_strays(decoded, 1.5 + 2.0 / bins.camera_px_per_pixel);
    bins = gather(decoded, kept, projector_width, projector_height);
    const double scale = bins.camera_px_per_pixel;
    const int link_reach = scale >= 0.9 ? 1 : std::min(2, static_cast<int>(std::ceil(1.2 / scale)));
    const int radius =
        scale >= 0.9 ? 2 : std::clamp(static_cast<int>(std::ceil(2.5 / scale)), 3, kMaxRadius);
    // A neighbouring camera pixel lies 1 / scale projector pixels away, more where stretched.
    const double reach = 1.5 + 2.0 / scale;

    ProjectorToCamera map;
    map.camera_px =
        ImageF(projector_width, projector_height, 2, std::numeric_limits<float>::quiet_NaN());
    map.edge = Image8(projector_width, projector_height, 1);
    map.filled = Image8(projector_width, projector_height, 1);
    std::vector<float> sigma_px(map.edge.values.size(), 0.0f);
    parallel_for(
        static_cast<std::size_t>(projector_height), 4, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < projector_width; ++x) {
                    const auto located = locate(bins, x, y, radius, link_reach);
                    if (!located) {
                        map.edge.at(x, y) = bins.find(x, y) ? 255 : 0;
                        continue;
                    }
                    map.camera_px.at(x, y, 0) = static_cast<float>(located->camera.x);
                    map.camera_px.at(x, y, 1) = static_cast<float>(located->camera.y);
                    sigma_px[map.edge.index(x, y)] = located->sigma_px;
                    const Sees sees = seen_there(decoded, kept, located->camera, x, y, reach);
                    if (sees == Sees::another)
                        map.edge.at(x, y) = 255;
                    else if (located->filled || sees == Sees::with_gap)
                        map.filled.at(x, y) = 255;
                }
        });
    fill_holes(decoded, kept, scale, reach, map);
    // Whole pixels' rounding is no noise: where both grids run in step, residuals hide it.
    if (!decoded.sigma_px.empty()) {
        std::erase(sigma_px, 0.0f);
        if (!sigma_px.empty())
            map.sigma_px = std::clamp(
                static_cast<double>(median(std::move(sigma_px))), kFineMapError, kMapError);
    }
    return map;
}

bool is_mirrored(const ProjectorToCamera& map) {
    const ImageF& at = map.camera_px;
    std::ptrdiff_t kept = 0, turned = 0;
    for (int y = 0; y + 4 < at.height; y += 2)
        for (int x = 0; x + 4 < at.width; x += 2) {
            const glm::vec2 here(at.at(x, y, 0), at.at(x, y, 1));
            const glm::vec2 right = glm::vec2(at.at(x + 4, y, 0), at.at(x + 4, y, 1)) - here;
            const glm::vec2 down = glm::vec2(at.at(x, y + 4, 0), at.at(x, y + 4, 1)) - here;
            const float turn = right.x * down.y - right.y * down.x;
            kept += turn > 0.0f;
            turned += turn < 0.0f;
        }
    return turned > 4 * kept;
}

}  // namespace livery
