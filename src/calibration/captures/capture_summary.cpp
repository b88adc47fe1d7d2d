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

/// By 1, 2, 1 a quarter in both directions, the border held.
ImageF smoothed(const ImageF& image) {
    ImageF rows = image, out = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            rows.at(x, y) = 0.25f * (image.at(std::max(x - 1, 0), y) + 2.0f * image.at(x, y) +
                                     image.at(std::min(x + 1, image.width - 1), y));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            out.at(x, y) = 0.25f * (rows.at(x, std::max(y - 1, 0)) + 2.0f * rows.at(x, y) +
                                    rows.at(x, std::min(y + 1, image.height - 1)));
    return out;
}

/// log(light) minus its surroundings'. Light is smoothed first, over more than a block: the
/// logarithm of an edge that lies somewhere within one is no function that one can interpolate, and
/// a movement of a part of a block is then found half as large.
ImageF texture_of(const ImageF& light) {
    const float floor = std::max(0.02f * quantile(light.values, 0.99), 1e-20f);
    ImageF texture = smoothed(smoothed(light));
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

constexpr int kBorder = 6;

/// Gauss-Newton from `start`.
glm::vec2 refine(const std::vector<TextureBlock>& still, const ImageF& moved, glm::vec2 start) {
    constexpr std::size_t kEach = 4;  // of the errors, whose median weighs them
    if (still.size() < 64) return glm::vec2(std::numeric_limits<float>::quiet_NaN());
    std::vector<float> errors(still.size()), sizes((still.size() + kEach - 1) / kEach);
    glm::vec2 d = start;
    for (int round = 0; round < 10; ++round) {
        for (std::size_t i = 0; i < still.size(); ++i) {
            const auto& at = still[i];
            errors[i] =
                bilinear(moved, static_cast<float>(at.x) + d.x, static_cast<float>(at.y) + d.y) -
                at.value;
        }
        for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = std::abs(errors[k * kEach]);
        // What does not fit (a shadow's border, a silhouette) counts less: Geman and McClure.
        const float scale = 6.0f * quantile_in_place(std::span<float>(sizes), 0.5) + 1e-4f;
        double xx = 0, xy = 0, yy = 0, xe = 0, ye = 0;
        for (std::size_t i = 0; i < still.size(); ++i) {
            const float gx = still[i].gradient_x, gy = still[i].gradient_y, e = errors[i];
            const float q = 1.0f / (1.0f + e * e / (scale * scale));
            const double w = static_cast<double>(q) * q;
            xx += w * gx * gx;
            xy += w * gx * gy;
            yy += w * gy * gy;
            xe += w * gx * e;
            ye += w * gy * e;
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
glm::vec2 nearest_step(const std::vector<TextureBlock>& still, const ImageF& moved) {
    constexpr int kReach = 4;
    // A sum that is above `most` is not finished.
    const auto misfit = [&](int dx, int dy, double most) {
        double sum = 0.0;
        for (const auto& at : still) {
            if ((at.x | at.y) & 1) continue;  // every second one of every second row
            sum += static_cast<double>(
                std::min(std::abs(moved.at(at.x + dx, at.y + dy) - at.value), 0.3f));
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

std::vector<TextureBlock> texture_blocks(const ImageF& light, const Image8& mask) {
    const ImageF texture = texture_of(light);
    std::vector<TextureBlock> blocks;
    for (int y = kBorder; y + kBorder < texture.height; ++y)
        for (int x = kBorder; x + kBorder < texture.width; ++x)
            if (mask.at(x, y))
                blocks.push_back({x,
                                  y,
                                  texture.at(x, y),
                                  0.5f * (texture.at(x + 1, y) - texture.at(x - 1, y)),
                                  0.5f * (texture.at(x, y + 1) - texture.at(x, y - 1))});
    return blocks;
}

glm::vec2 displacement(const std::vector<TextureBlock>& still, const ImageF& moved) {
    const ImageF texture = texture_of(moved);
    // So that the fit starts within a block of the answer
    return refine(still, texture, nearest_step(still, texture));
}

}  // namespace livery
