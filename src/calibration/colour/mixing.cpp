#include "calibration/colour/mixing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "calibration/colour/shrinkage.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr int kNeighbourhood = 4;  // radius in projector pixels; 81 pixels

constexpr std::array<PictureOf, 3> kChannelPictures{kRed, kGreen, kBlue};

double brightness(glm::dvec3 c) { return c.x + c.y + c.z; }

bool usable(const ColourSamples& samples, std::size_t i) {
    return samples.finite[i] && !samples.saturated[i];
}

/// Unit diagonal by columns; not finite where a channel gives nothing.
glm::dmat3 normalised(const std::array<glm::dvec3, 3>& difference) {
    glm::dmat3 vn(1.0);
    for (int k = 0; k < 3; ++k)
        vn[k] =
            difference[static_cast<std::size_t>(k)] / difference[static_cast<std::size_t>(k)][k];
    return vn;
}

bool is_finite(const glm::dmat3& m) {
    for (int k = 0; k < 3; ++k)
        if (!std::isfinite(m[k].x + m[k].y + m[k].z)) return false;
    return true;
}

/// Splits a vector of vec3 into one channel.
std::vector<float> channel_of(const std::vector<glm::vec3>& values, int channel) {
    std::vector<float> out(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i][channel];
    return out;
}

/// Per-pixel scale: the factor by which all differences together follow the pooled ones.
struct Scale {
    std::vector<float> value, variance;
};

struct Work {
    const ColourSamples& samples;
    const PooledMixing& pooled;
    std::vector<glm::vec3> dark;  ///< C_S, denoised
    std::vector<glm::vec3> dark_variance;
};

glm::dvec3 difference(const Work& work, PictureOf picture, std::size_t i) {
    return glm::dvec3(work.samples.pictures[picture].colour[i]) - glm::dvec3(work.dark[i]);
}

glm::dvec3 difference_variance(const Work& work, PictureOf picture, std::size_t i) {
    return work.samples.variance(work.samples.pictures[picture], i) +
           glm::dvec3(work.dark_variance[i]);
}

Scale scale_of(const Work& work) {
    const std::size_t count = work.samples.pixels.size();
    const std::array<std::pair<PictureOf, glm::dvec3>, 4> pictures{{{kBright, work.pooled.bright},
                                                                    {kRed, work.pooled.red},
                                                                    {kGreen, work.pooled.green},
                                                                    {kBlue, work.pooled.blue}}};
    Scale scale{std::vector<float>(count), std::vector<float>(count)};
    parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // Weights from the expected values, so that they do not follow the noise
            const double rough = std::max(
                0.0, brightness(difference(work, kBright, i)) / brightness(work.pooled.bright));
            double top = 0.0, bottom = 0.0;
            for (const auto& [picture, expected] : pictures) {
                const glm::dvec3 variance =
                    work.samples.noise.variance(rough * expected + glm::dvec3(work.dark[i])) *
                        static_cast<double>(work.samples.tap_share[i]) /
                        static_cast<double>(work.samples.pictures[picture].shots) +
                    glm::dvec3(work.dark_variance[i]) +
                    glm::dvec3(1e-12 * brightness(work.pooled.bright) *
                               brightness(work.pooled.bright));
                const glm::dvec3 d = difference(work, picture, i);
                for (int c = 0; c < 3; ++c) {
                    top += expected[c] * d[c] / variance[c];
                    bottom += expected[c] * expected[c] / variance[c];
                }
            }
            scale.value[i] = static_cast<float>(top / bottom);
            scale.variance[i] = static_cast<float>(1.0 / bottom);
        }
    });
    return scale;
}

/// Symmetric 3 x 3 system of the separated span from all pictures that tell about it.
void solve_span(const Work& work,
                const glm::dmat3& vn,
                bool additive,
                std::size_t i,
                glm::dvec3& span,
                glm::dvec3& variance) {
    const glm::dvec3 bright = difference(work, kBright, i);
    const glm::dvec3 bright_variance = difference_variance(work, kBright, i) + glm::dvec3(1e-30);
    if (!additive) {
        const glm::dmat3 inverse = glm::inverse(vn);
        span = inverse * bright;
        variance = glm::dvec3(0.0);
        for (int c = 0; c < 3; ++c) variance += inverse[c] * inverse[c] * bright_variance[c];
        return;
    }
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (int j = 0; j < 3; ++j) {
        const glm::dvec3 d = difference(work, kChannelPictures[static_cast<std::size_t>(j)], i);
        const glm::dvec3 v =
            difference_variance(work, kChannelPictures[static_cast<std::size_t>(j)], i) +
            glm::dvec3(1e-30);
        for (int c = 0; c < 3; ++c) {
            normal[j][j] += vn[j][c] * vn[j][c] / v[c];
            right[j] += vn[j][c] * (d[c] / v[c] + bright[c] / bright_variance[c]);
            for (int k = 0; k < 3; ++k) normal[k][j] += vn[j][c] * vn[k][c] / bright_variance[c];
        }
    }
    const glm::dmat3 covariance = glm::inverse(normal);
    span = LIVERY_MUTATED(mixing_span, covariance * right);
    variance = {covariance[0][0], covariance[1][1], covariance[2][2]};
}

}  // namespace

void PixelMixing::resize(std::size_t count) {
    unmixing.assign(count, glm::mat3(1.0f));
    dark.assign(count, glm::vec3(0.0f));
    span.assign(count, glm::vec3(0.0f));
    span_sigma.assign(count, glm::vec3(0.0f));
    condition.assign(count, std::numeric_limits<float>::infinity());
}

double condition_number(const glm::dmat3& matrix) {
    if (!is_finite(matrix)) return std::numeric_limits<double>::infinity();
    // Eigenvalues of A'A in closed form (Smith 1961)
    const glm::dmat3 a = glm::transpose(matrix) * matrix;
    const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    const glm::dmat3 b = a - glm::dmat3(mean);
    double p2 = 0.0;
    for (int k = 0; k < 3; ++k) p2 += glm::dot(b[k], b[k]);
    if (!(mean > 0.0)) return std::numeric_limits<double>::infinity();
    if (p2 <= 1e-30 * mean * mean) return 1.0;
    const double p = std::sqrt(p2 / 6.0);
    const double half = std::clamp(0.5 * glm::determinant(b / p), -1.0, 1.0);
    const double angle = std::acos(half) / 3.0;
    const double largest = mean + 2.0 * p * std::cos(angle);
    // The smallest from the determinant: the difference of large numbers would lose it.
    const double middle = mean + 2.0 * p * std::cos(angle - 2.0 * std::numbers::pi / 3.0);
    const double determinant = glm::determinant(matrix);
    const double smallest = determinant * determinant / (largest * middle);
    return smallest > 0.0 ? std::sqrt(largest / smallest) : std::numeric_limits<double>::infinity();
}

PooledMixing pool_mixing(const ColourSamples& samples) {
    const std::size_t count = samples.pixels.size();
    std::vector<float> bright(count, 0.0f), some;
    for (std::size_t i = 0; i < count; ++i) {
        if (!usable(samples, i)) continue;
        bright[i] = static_cast<float>(
            brightness(samples.pictures[kBright].colour[i] - samples.pictures[kDark].colour[i]));
        some.push_back(bright[i]);
    }
    const float peak = quantile(some, 0.999);
    const float limit = std::max(0.05f * peak, 1e-30f);

    PooledMixing pooled;
    std::array<glm::dvec3, 3> channel{};
    double used = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!usable(samples, i) || bright[i] < limit) continue;
        const glm::dvec3 dark = samples.pictures[kDark].colour[i];
        pooled.bright += glm::dvec3(samples.pictures[kBright].colour[i]) - dark;
        for (std::size_t k = 0; k < 3; ++k)
            channel[k] += glm::dvec3(samples.pictures[kChannelPictures[k]].colour[i]) - dark;
        used += 1.0;
    }
    const double saturated =
        std::accumulate(samples.saturated.begin(), samples.saturated.end(), 0.0);
    if (used == 0.0 && saturated > 0.5 * static_cast<double>(count))
        throw Refused(
            "the camera is saturated on the whole mock-up",
            "shorten the exposure until white on the mock-up stays under 85% of full scale");
    if (used < 16.0)
        throw Refused(
            "bright-gray is nowhere on the mock-up brighter than dark-gray",
            "check that each photograph shows its own picture, the exposure, and that the "
            "geometry photographs belong to these");
    pooled.bright /= used;
    for (glm::dvec3& c : channel) c /= used;
    pooled.red = channel[0];
    pooled.green = channel[1];
    pooled.blue = channel[2];
    constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};
    for (int k = 0; k < 3; ++k)
        if (!(channel[static_cast<std::size_t>(k)][k] > 1e-4 * pooled.bright[k]))
            throw Refused(std::string("the camera's ") + kNames[static_cast<std::size_t>(k)] +
                              " channel does not see the projector's " +
                              kNames[static_cast<std::size_t>(k)] + " picture",
                          "check that red, green and blue photographs are not swapped and that all "
                          "three colours of the projector work");
    int swapped = 0;
    for (int c = 0; c < 3; ++c)
        swapped += channel[0][c] > channel[static_cast<std::size_t>(c)][c] ||
                   channel[1][c] > channel[static_cast<std::size_t>(c)][c] ||
                   channel[2][c] > channel[static_cast<std::size_t>(c)][c];
    if (swapped >= 2)
        throw Refused(
            "the camera's red, green and blue see other pictures best than red, green, blue",
            "check the roles of the photographs: two of the three are swapped");
    pooled.vn = normalised(channel);
    const glm::dvec3 sum = channel[0] + channel[1] + channel[2];
    pooled.additivity_error = glm::length(pooled.bright - sum) / glm::length(pooled.bright);

    // Scatter of Vn's six free entries over what noise alone gives, on the brighter half
    const float half = quantile(some, 0.5);
    double scatter = 0.0, terms = 0.0, deviation = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!usable(samples, i) || bright[i] < std::max(half, limit)) continue;
        const glm::dvec3 dark = samples.pictures[kDark].colour[i];
        const glm::dvec3 dark_variance = samples.variance(samples.pictures[kDark], i);
        for (int k = 0; k < 3; ++k) {
            const SampledPicture& picture =
                samples.pictures[kChannelPictures[static_cast<std::size_t>(k)]];
            const glm::dvec3 d = glm::dvec3(picture.colour[i]) - dark;
            const glm::dvec3 v = samples.variance(picture, i) + dark_variance;
            for (int c = 0; c < 3; ++c) {
                if (c == k) continue;
                const double r = pooled.vn[k][c], e = d[c] / d[k] - r;
                const double noise = (v[c] + r * r * v[k]) / (d[k] * d[k]);
                if (!std::isfinite(e)) continue;
                scatter += e * e / (noise + 1e-12);
                deviation += e * e;
                terms += 1.0;
            }
        }
    }
    pooled.spread = terms > 0.0 ? std::sqrt(scatter / terms) : 0.0;
    // Within three times its noise, or under a hundredth of a channel: neutral.
    pooled.neutral = terms > 0.0 && (pooled.spread < 3.0 || std::sqrt(deviation / terms) < 0.01);
    return pooled;
}

PixelMixing mix_by_pixel(const ColourSamples& samples) {
    const std::size_t count = samples.pixels.size();
    PixelMixing mixing;
    mixing.resize(count);
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!samples.finite[i]) continue;
            const glm::dvec3 dark = samples.pictures[kDark].colour[i];
            std::array<glm::dvec3, 3> d;
            for (std::size_t k = 0; k < 3; ++k)
                d[k] = glm::dvec3(samples.pictures[kChannelPictures[k]].colour[i]) - dark;
            const glm::dmat3 vn = normalised(d);
            const double condition = condition_number(vn);
            if (!std::isfinite(condition)) continue;
            const glm::dmat3 inverse = glm::inverse(vn);
            const glm::dvec3 variance = samples.variance(samples.pictures[kBright], i) +
                                        samples.variance(samples.pictures[kDark], i);
            glm::dvec3 span_variance(0.0);
            for (int c = 0; c < 3; ++c) span_variance += inverse[c] * inverse[c] * variance[c];
            mixing.unmixing[i] = glm::mat3(inverse);
            mixing.dark[i] = glm::vec3(inverse * dark);
            mixing.span[i] =
                glm::vec3(inverse * (glm::dvec3(samples.pictures[kBright].colour[i]) - dark));
            mixing.span_sigma[i] = glm::vec3(glm::sqrt(span_variance));
            mixing.condition[i] = static_cast<float>(condition);
        }
    });
    return mixing;
}

PixelMixing mix_robustly(const ColourSamples& samples, const PooledMixing& pooled, bool additive) {
    const std::size_t count = samples.pixels.size();
    const SampleGrid grid(samples.width, samples.pixels);
    Work work{samples, pooled, samples.pictures[kDark].colour, std::vector<glm::vec3>(count)};

    // Dark picture: read noise averaged over the neighbourhood
    std::vector<glm::vec3> dark_variance(count);
    for (std::size_t i = 0; i < count; ++i)
        dark_variance[i] = samples.finite[i]
                               ? glm::vec3(samples.variance(samples.pictures[kDark], i))
                               : glm::vec3(std::numeric_limits<float>::quiet_NaN());
    parallel_for(3, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const auto channel = static_cast<int>(c);
            const Shrunk shrunk = shrink_locally(grid,
                                                 channel_of(work.dark, channel),
                                                 channel_of(dark_variance, channel),
                                                 kNeighbourhood,
                                                 false);
            for (std::size_t i = 0; i < count; ++i) {
                work.dark[i][channel] = shrunk.value[i];
                work.dark_variance[i][channel] = shrunk.variance[i];
            }
        }
    });

    const Scale scale = scale_of(work);

    // Vn: deviations of its six free entries from the pooled ones
    std::vector<glm::mat3> vn(count, glm::mat3(pooled.vn));
    parallel_for(6, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t entry = begin; entry < end; ++entry) {
            const auto k = static_cast<int>(entry / 2);
            const int c = (k + 1 + static_cast<int>(entry % 2)) % 3;
            const double r = pooled.vn[k][c];
            std::vector<float> deviation(count), variance(count);
            for (std::size_t i = 0; i < count; ++i) {
                const PictureOf picture = kChannelPictures[static_cast<std::size_t>(k)];
                const glm::dvec3 d = difference(work, picture, i);
                const glm::dvec3 v = difference_variance(work, picture, i);
                const double own = std::max(d[k], 1e-30);
                deviation[i] = static_cast<float>(d[c] / own - r);
                variance[i] = usable(samples, i) && d[k] > 0.0
                                  ? static_cast<float>((v[c] + r * r * v[k]) / (own * own) + 1e-14)
                                  : 0.0f;
            }
            const Shrunk shrunk = shrink_locally(grid, deviation, variance, kNeighbourhood, true);
            for (std::size_t i = 0; i < count; ++i)
                vn[i][k][c] = static_cast<float>(
                    r + (variance[i] > 0.0f ? static_cast<double>(shrunk.value[i]) : 0.0));
        }
    });

    // Span: deviations of each channel's share of the common scale
    const glm::dvec3 share = glm::inverse(pooled.vn) * pooled.bright;
    std::array<std::vector<float>, 3> deviation, variance;
    for (int k = 0; k < 3; ++k) {
        deviation[static_cast<std::size_t>(k)].assign(count, 0.0f);
        variance[static_cast<std::size_t>(k)].assign(count, 0.0f);
    }
    PixelMixing mixing;
    mixing.resize(count);
    parallel_for(count, 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!usable(samples, i)) continue;
            glm::dmat3 own(vn[i]);
            double condition = condition_number(own);
            if (condition > kMixingConditionLimit && pooled.neutral) {
                vn[i] = glm::mat3(pooled.vn);
                own = pooled.vn;
                condition = condition_number(own);
            }
            mixing.condition[i] = static_cast<float>(condition);
            if (!std::isfinite(condition) || !(scale.value[i] > 0.0f)) continue;
            mixing.unmixing[i] = glm::mat3(glm::inverse(own));
            mixing.dark[i] = mixing.unmixing[i] * work.dark[i];
            glm::dvec3 span, span_variance;
            solve_span(work, own, additive, i, span, span_variance);
            const auto s = static_cast<double>(scale.value[i]);
            for (int k = 0; k < 3; ++k) {
                deviation[static_cast<std::size_t>(k)][i] =
                    static_cast<float>(span[k] / s - share[k]);
                variance[static_cast<std::size_t>(k)][i] =
                    static_cast<float>(span_variance[k] / (s * s));
            }
        }
    });
    parallel_for(3, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t channel = begin; channel < end; ++channel) {
            const auto k = static_cast<int>(channel);
            const Shrunk shrunk =
                shrink_locally(grid, deviation[channel], variance[channel], kNeighbourhood, true);
            for (std::size_t i = 0; i < count; ++i) {
                if (!(variance[channel][i] > 0.0f)) continue;
                const float ratio = static_cast<float>(share[k]) + shrunk.value[i];
                mixing.span[i][k] = scale.value[i] * ratio;
                mixing.span_sigma[i][k] =
                    std::sqrt(scale.variance[i] * ratio * ratio +
                              scale.value[i] * scale.value[i] * shrunk.variance[i]);
            }
        }
    });
    return mixing;
}

}  // namespace livery
