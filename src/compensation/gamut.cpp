// Gamut mapping in Oklab. The gamut of a pixel is the set of colours whose N lies in the unit cube
// (or in the drive table's range); its boundary is taken from the mean primaries of the
// neighbourhood, and a last step keeps every colour inside the pixel's own gamut.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/glm.hpp>

#include "compensation/compensation.h"
#include "compensation/drive_table.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr double kChromaKnee = 0.85;
/// Tighter: a wider one would grey the design white itself.
constexpr double kLightnessKnee = 0.95;
constexpr int kSmoothRadius_px = 8;
constexpr double kFloorPercentile = 0.95;

/// The identity up to `knee`, then bends towards 1 with slope 1 at the knee; rising everywhere.
double soft(double x, double knee) {
    if (x <= knee) return x;
    const double t = (x - knee) / (1.0 - knee);
    return knee + (1.0 - knee) * t / std::cbrt(1.0 + t * t * t);
}

/// The same from below: nothing under `floor`, the identity from `knee` on.
double soft_floor(double x, double floor, double knee) {
    if (x >= knee || knee <= floor) return x;
    const double t = (knee - x) / (knee - floor);
    return knee - (knee - floor) * t / std::cbrt(1.0 + t * t * t);
}

/// n = a * rgb_working + b.
struct Gamut {
    glm::dmat3 a;
    glm::dvec3 b;
    const NonAdditive* table;

    bool contains(const glm::dvec3& rgb) const {
        const glm::dvec3 n = a * rgb + b;
        for (int k = 0; k < 3; ++k) {
            if (!(n[k] >= 0.0 && n[k] <= 1.0)) return false;
        }
        if (table->grid == 0) return true;
        glm::vec3 residual;
        drive_of_n(*table, glm::vec3(n), &residual);
        return glm::dot(residual, residual) <= kReachableN * kReachableN;
    }

    struct Range {
        double low = 0.0, high = 0.0;
    };
    /// Oklab lightness of the neutrals inside; none when no neutral is.
    std::optional<Range> neutral_lightness() const {
        const glm::dvec3 white = a * glm::dvec3(1.0);
        double low = 0.0, high = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            if (!(white[k] > 0.0)) return std::nullopt;
            low = std::max(low, -b[k] / white[k]);
            high = std::min(high, (1.0 - b[k]) / white[k]);
        }
        if (table->grid > 0 && high > low) high = brightest_reachable(*table, white, b, high);
        if (!(high > low)) return std::nullopt;
        return Range{std::cbrt(low), std::cbrt(high)};
    }
};

glm::dvec3 rgb_from_oklab(const glm::dvec3& oklab) {
    return working_from_xyz() * xyz_from_oklab(oklab);
}

/// Largest fraction in [0, 1] of the way from the neutral to `oklab` that is inside.
double reach(const Gamut& gamut, const glm::dvec3& oklab) {
    double inside = 0.0, outside = 1.0;
    for (int i = 0; i < 16; ++i) {
        const double middle = 0.5 * (inside + outside);
        const glm::dvec3 there(oklab.x, oklab.y * middle, oklab.z * middle);
        (gamut.contains(rgb_from_oklab(there)) ? inside : outside) = middle;
    }
    return inside;
}

glm::dmat3 matrix_at(const std::vector<float>& planes, std::size_t count, std::size_t i) {
    glm::dmat3 m;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            m[static_cast<int>(column)][static_cast<int>(row)] =
                static_cast<double>(planes[(3 * row + column) * count + i]);
        }
    }
    return m;
}

glm::dvec3 vector_at(const std::vector<float>& planes, std::size_t count, std::size_t i) {
    return {static_cast<double>(planes[9 * count + i]),
            static_cast<double>(planes[10 * count + i]),
            static_cast<double>(planes[11 * count + i])};
}

/// Mean over a square window of the valid pixels of one plane, in place; `weight` is their count.
class WindowMean {
  public:
    WindowMean(int width, int height, const std::vector<std::uint32_t>& pixels)
        : width_(static_cast<std::size_t>(width)),
          height_(static_cast<std::size_t>(height)),
          pixels_(pixels),
          weight_(pixels.size(), 1.0f) {
        sum(&weight_);
    }

    void apply(float* values) const {
        std::vector<float> plane(values, values + pixels_.size());
        sum(&plane);
        for (std::size_t i = 0; i < pixels_.size(); ++i) values[i] = plane[i] / weight_[i];
    }

  private:
    /// Two passes over the full picture with running sums.
    void sum(std::vector<float>* values) const {
        std::vector<double> full(width_ * height_, 0.0);
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            full[pixels_[i]] = static_cast<double>((*values)[i]);
        }
        for (std::size_t y = 0; y < height_; ++y) run(&full[y * width_], width_, 1);
        for (std::size_t x = 0; x < width_; ++x) run(&full[x], height_, width_);
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            (*values)[i] = static_cast<float>(full[pixels_[i]]);
        }
    }

    static void run(double* line, std::size_t count, std::size_t stride) {
        constexpr std::size_t kRadius = kSmoothRadius_px;
        std::vector<double> prefix(count + 1, 0.0);
        for (std::size_t i = 0; i < count; ++i) prefix[i + 1] = prefix[i] + line[i * stride];
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t begin = i > kRadius ? i - kRadius : 0;
            const std::size_t end = std::min(i + kRadius + 1, count);
            line[i * stride] = prefix[end] - prefix[begin];
        }
    }

    std::size_t width_, height_;
    const std::vector<std::uint32_t>& pixels_;
    std::vector<float> weight_;
};

}  // namespace

GamutMap::GamutMap(const CompensationTable& table) : table_(table) {
    const std::size_t count = table.pixels.size();
    // Primaries and black in working RGB are what has a meaningful mean; their inverse is a gamut.
    boundary_.resize(12 * count);
    parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dmat3 primaries = glm::inverse(matrix_at(table.coefficients, count, i));
            store(i, primaries, primaries * -vector_at(table.coefficients, count, i));
        }
    });
    const WindowMean mean(table.width, table.height, table.pixels);
    parallel_for(12, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t plane = begin; plane < end; ++plane) {
            mean.apply(boundary_.data() + plane * count);
        }
    });
    std::vector<double> floors(count, 0.0);
    parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dmat3 a = glm::inverse(matrix_at(boundary_, count, i));
            const glm::dvec3 b = a * -vector_at(boundary_, count, i);
            store(i, a, b);
            const auto range = Gamut{a, b, &table_.non_additive}.neutral_lightness();
            if (range) floors[i] = range->low;
        }
    });
    if (count > 0) floor_lightness_ = quantile(std::move(floors), kFloorPercentile);
}

void GamutMap::store(std::size_t pixel, const glm::dmat3& matrix, const glm::dvec3& vector) {
    const std::size_t count = table_.pixels.size();
    for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column) {
            boundary_[(3 * row + column) * count + pixel] =
                static_cast<float>(matrix[static_cast<int>(column)][r]);
        }
        boundary_[(9 + row) * count + pixel] = static_cast<float>(vector[r]);
    }
}

ImageF GamutMap::preserve(const ImageF& wanted) const {
    check_argument(wanted.width == table_.width && wanted.height == table_.height &&
                       (wanted.channels == 3 || wanted.channels == 4),
                   "wanted picture of " + std::to_string(wanted.width) + "x" +
                       std::to_string(wanted.height) + " with " + std::to_string(wanted.channels) +
                       " channels, the calibration has " + std::to_string(table_.width) + "x" +
                       std::to_string(table_.height) + " and wants 3 or 4");
    ImageF mapped = wanted;
    const std::size_t count = table_.pixels.size();
    const auto channels = static_cast<std::size_t>(wanted.channels);
    parallel_for(count, 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float* colour = &mapped.values[channels * table_.pixels[i]];
            if (channels == 4 && !(colour[3] >= 0.5f)) continue;
            const glm::dvec3 rgb(colour[0], colour[1], colour[2]);
            if (!std::isfinite(rgb.x + rgb.y + rgb.z)) continue;
            const glm::dvec3 result = map_pixel(i, rgb);
            if (result == rgb) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                colour[k] = static_cast<float>(result[static_cast<int>(k)]);
            }
        }
    });
    return mapped;
}

glm::dvec3 GamutMap::map_pixel(std::size_t i, const glm::dvec3& rgb) const {
    const std::size_t count = table_.pixels.size();
    const Gamut local{
        matrix_at(boundary_, count, i), vector_at(boundary_, count, i), &table_.non_additive};
    const auto range = local.neutral_lightness();
    if (!range) return rgb;  // nothing to aim at: compensate() clips and counts it
    const glm::dvec3 wanted = oklab_from_xyz(xyz_from_working() * rgb);

    // Lightness, only where no neutral of it can be shown.
    const double floor = std::min(std::max(floor_lightness_, range->low), range->high);
    glm::dvec3 lab = wanted;
    lab.x = soft_floor(lab.x, floor, std::min(floor / kChromaKnee, range->high));
    lab.x = range->high * soft(lab.x / range->high, kLightnessKnee);

    // Chroma, at that lightness and hue.
    const double stretch = 1.0 / kChromaKnee;
    const glm::dvec3 beyond(lab.x, lab.y * stretch, lab.z * stretch);
    if (!local.contains(rgb_from_oklab(beyond))) {
        const double boundary = reach(local, beyond) * stretch;  // in units of the wanted chroma
        const double kept = boundary > 0.0 ? boundary * soft(1.0 / boundary, kChromaKnee) : 0.0;
        lab.y *= kept;
        lab.z *= kept;
    }

    // The pixel's own gamut has the last word.
    const Gamut own{matrix_at(table_.coefficients, count, i),
                    vector_at(table_.coefficients, count, i),
                    &table_.non_additive};
    glm::dvec3 result = lab == wanted ? rgb : rgb_from_oklab(lab);
    if (own.contains(result)) return result;
    const auto own_range = own.neutral_lightness();
    if (!own_range) return result;
    // A hair inside: Oklab's neutrals, by its rounded matrices, are D65 to about 1e-4 only.
    const double margin = 5e-4 * (own_range->high - own_range->low);
    lab.x = std::clamp(lab.x, own_range->low + margin, own_range->high - margin);
    const double kept = reach(own, lab);
    return rgb_from_oklab({lab.x, lab.y * kept, lab.z * kept});
}

ImageF map_gamut(const CompensationTable& table,
                 const ImageF& wanted_working,
                 GamutMapping mapping) {
    return mapping == GamutMapping::strict ? wanted_working
                                           : GamutMap(table).preserve(wanted_working);
}

}  // namespace livery
