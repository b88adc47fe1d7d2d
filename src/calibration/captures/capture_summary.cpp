#include "calibration/captures/capture_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr int kBlocksAcross = 240;
/// A sensor's limit gathers pixels that would spread far above it; the brightest value of a picture
/// that is not clipped is reached by a few.
constexpr double kPlateauShare = 0.002, kPlateauOverBelow = 3.0;

/// Pixels exactly at the largest value, and in a range of 2% below it.
void find_plateau(const Photograph& photo, CaptureSummary& summary) {
    float largest = -std::numeric_limits<float>::infinity();
    for (const float value : photo.image.values)
        if (std::isfinite(value)) largest = std::max(largest, value);
    const float below = largest - 0.02f * (largest - static_cast<float>(photo.black_level));
    double at = 0.0, under = 0.0;
    for (const float value : photo.image.values) {
        at += value == largest;
        under += value < largest && value >= below;
    }
    const double share = 3.0 * at / static_cast<double>(photo.image.values.size());
    if (share > kPlateauShare && at > kPlateauOverBelow * under) {
        summary.plateau = static_cast<double>(largest);
        summary.plateau_share = std::min(share, 1.0);
    }
}

CaptureSummary summary_of(const RoledPhotograph& capture, int block) {
    const Photograph& photo = capture.photograph;
    const ImageF& image = photo.image;
    CaptureSummary summary;
    summary.role = capture.role;
    summary.name = capture.role;
    if (!photo.name.empty() && photo.name != capture.role) summary.name += " (" + photo.name + ")";
    summary.taken_at = photo.taken_at;
    summary.saturates_at = photo.saturates_at;
    summary.full_light = (photo.saturates_at - photo.black_level) / photo.exposure_s;
    summary.has_black_level = photo.black_level > 0.0;
    const int width = image.width / block, height = image.height / block;
    summary.colour = ImageF(width, height, 3);
    summary.light = ImageF(width, height, 1);
    summary.saturated.assign(summary.light.values.size(), 0);
    summary.unknown = summary.saturated;
    const auto gain =
        static_cast<float>(1.0 / (photo.exposure_s * static_cast<double>(block) * block));
    const auto black = static_cast<float>(photo.black_level);
    const auto limit = static_cast<float>(saturation_limit(photo));
    const auto channels = static_cast<std::size_t>(image.channels);
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (int x = 0; x < width; ++x) {
                const int y = static_cast<int>(row);
                float sum[3] = {};
                bool over = false;
                for (int v = y * block; v < (y + 1) * block; ++v)
                    for (int u = x * block; u < (x + 1) * block; ++u)
                        for (std::size_t c = 0; c < 3; ++c) {
                            const float value = image.pixel(u, v)[std::min(c, channels - 1)];
                            sum[c] += value - black;
                            over |= value >= limit;
                        }
                const bool known = std::isfinite(sum[0] + sum[1] + sum[2]);
                summary.unknown[summary.light.index(x, y)] = !known;
                if (!known) std::fill_n(sum, 3, 0.0f);
                float* const out = summary.colour.pixel(x, y);
                for (int c = 0; c < 3; ++c) out[c] = gain * sum[c];
                summary.light.at(x, y) = (out[0] + out[1] + out[2]) / 3.0f;
                summary.saturated[summary.light.index(x, y)] = over;
            }
    });
    double total = 0.0;
    for (const float value : summary.light.values) total += static_cast<double>(value);
    summary.mean = total / std::max(1.0, static_cast<double>(summary.light.values.size()));
    find_plateau(photo, summary);
    return summary;
}

/// Mean over (2 reach + 1)^2, the border held.
ImageF blurred(const ImageF& image, int reach) {
    const int width = image.width, height = image.height;
    const auto count = static_cast<float>(2 * reach + 1);
    ImageF rows(width, height, 1), out = rows;
    std::vector<float> held(static_cast<std::size_t>(width + 2 * reach));
    for (int y = 0; y < height; ++y) {
        for (int x = -reach; x < width + reach; ++x)
            held[static_cast<std::size_t>(x + reach)] = image.at(std::clamp(x, 0, width - 1), y);
        float* const row = rows.pixel(0, y);
        for (int k = 0; k <= 2 * reach; ++k)
            for (int x = 0; x < width; ++x) row[x] += held[static_cast<std::size_t>(x + k)];
        for (int x = 0; x < width; ++x) row[x] /= count;
    }
    for (int y = 0; y < height; ++y) {
        float* const row = out.pixel(0, y);
        for (int k = -reach; k <= reach; ++k) {
            const float* const from = rows.pixel(0, std::clamp(y + k, 0, height - 1));
            for (int x = 0; x < width; ++x) row[x] += from[x];
        }
        for (int x = 0; x < width; ++x) row[x] /= count;
    }
    return out;
}

/// log(light) minus its surroundings'.
ImageF texture_of(const ImageF& light) {
    const float floor = std::max(0.02f * quantile(light.values, 0.99), 1e-20f);
    ImageF texture = light;
    for (float& value : texture.values) value = std::log(std::max(value, 0.0f) + floor);
    const ImageF mean = blurred(texture, 4);
    for (std::size_t i = 0; i < texture.values.size(); ++i) texture.values[i] -= mean.values[i];
    return texture;
}

float bilinear(const ImageF& image, float x, float y) {
    const float cx = std::clamp(x, 0.0f, static_cast<float>(image.width) - 1.001f);
    const float cy = std::clamp(y, 0.0f, static_cast<float>(image.height) - 1.001f);
    const int left = static_cast<int>(cx), top = static_cast<int>(cy);
    const float fx = cx - static_cast<float>(left), fy = cy - static_cast<float>(top);
    return (1 - fy) * ((1 - fx) * image.at(left, top) + fx * image.at(left + 1, top)) +
           fy * ((1 - fx) * image.at(left, top + 1) + fx * image.at(left + 1, top + 1));
}

/// Gauss-Newton from `start`.
glm::vec2 refine(const ImageF& still, const ImageF& moved, const Image8& mask, glm::vec2 start) {
    constexpr int kBorder = 6;
    struct Row {
        float x, y, value, gx, gy, e;
    };
    std::vector<Row> rows;
    for (int y = kBorder; y + kBorder < still.height; ++y)
        for (int x = kBorder; x + kBorder < still.width; ++x)
            if (mask.at(x, y))
                rows.push_back({static_cast<float>(x),
                                static_cast<float>(y),
                                still.at(x, y),
                                0.5f * (still.at(x + 1, y) - still.at(x - 1, y)),
                                0.5f * (still.at(x, y + 1) - still.at(x, y - 1)),
                                0.0f});
    if (rows.size() < 64) return glm::vec2(std::numeric_limits<float>::quiet_NaN());
    std::vector<float> sizes(rows.size());
    glm::vec2 d = start;
    for (int round = 0; round < 6; ++round) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            Row& r = rows[i];
            r.e = bilinear(moved, r.x + d.x, r.y + d.y) - r.value;
            sizes[i] = std::abs(r.e);
        }
        // What does not fit (a shadow's border, a silhouette) counts less: Geman and McClure.
        const float scale = 3.0f * quantile_in_place(std::span<float>(sizes), 0.5) + 1e-4f;
        double xx = 0, xy = 0, yy = 0, xe = 0, ye = 0;
        for (const Row& r : rows) {
            const float q = 1.0f / (1.0f + r.e * r.e / (scale * scale));
            const double w = static_cast<double>(q) * q;
            xx += w * r.gx * r.gx;
            xy += w * r.gx * r.gy;
            yy += w * r.gy * r.gy;
            xe += w * r.gx * r.e;
            ye += w * r.gy * r.e;
        }
        const double determinant = xx * yy - xy * xy;
        if (!(determinant > 1e-6 * (xx + yy) * (xx + yy)))
            return glm::vec2(std::numeric_limits<float>::quiet_NaN());
        const glm::dvec2 step((yy * xe - xy * ye) / determinant, (xx * ye - xy * xe) / determinant);
        d -= glm::vec2(glm::clamp(step, glm::dvec2(-2.0), glm::dvec2(2.0)));
        if (glm::length(step) < 1e-3) break;
    }
    return d;
}

/// The whole step, up to 4 blocks, after which most of the two agrees.
glm::vec2 nearest_step(const ImageF& still, const ImageF& moved, const Image8& mask) {
    constexpr int kReach = 4;
    std::vector<std::size_t> blocks;  // every second one
    for (int y = 6; y + 6 < still.height; y += 2)
        for (int x = 6; x + 6 < still.width; x += 2)
            if (mask.at(x, y)) blocks.push_back(still.index(x, y));
    // A sum that is above `most` is not finished
    const auto misfit = [&](int dx, int dy, double most) {
        const float* const there = moved.values.data() + dy * moved.width + dx;
        double sum = 0.0;
        for (const std::size_t i : blocks) {
            sum += static_cast<double>(std::min(std::abs(there[i] - still.values[i]), 0.3f));
            if (sum >= most) break;
        }
        return sum;
    };
    glm::vec2 nearest(0.0f);
    double best = misfit(0, 0, std::numeric_limits<double>::infinity());
    for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
            const double here = misfit(x, y, 0.98 * best);
            if (here < 0.98 * best) {
                best = here;
                nearest = glm::vec2(x, y);
            }
        }
    return nearest;
}

}  // namespace

int summary_block_px(int picture_width) { return std::max(1, picture_width / kBlocksAcross); }

CaptureSummary summarise(const RoledPhotograph& photograph) {
    return summary_of(photograph, summary_block_px(photograph.photograph.image.width));
}

glm::vec2 displacement(const ImageF& still, const ImageF& moved, const Image8& mask) {
    const ImageF a = texture_of(still), b = texture_of(moved);
    // So that the fit starts within a block of the answer
    return refine(a, b, mask, nearest_step(a, b, mask));
}

}  // namespace livery
