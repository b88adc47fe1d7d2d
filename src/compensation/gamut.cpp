// What gamut mapping needs to know of a calibration. The gamut of a pixel is the set of colours
// whose N lies in the unit cube (or in the drive table's range); its boundary is taken from the
// mean primaries of the neighbourhood.
#include "compensation/gamut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/glm.hpp>

#include "compensation/drive_table.h"
#include "core/colour.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr int kSmoothRadius_px = 8;
constexpr double kFloorPercentile = 0.95;

/// n = a * rgb_working + b.
struct Gamut {
    glm::dmat3 a;
    glm::dvec3 b;
    const NonAdditive* table;

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
        return Range{std::cbrt(low), LIVERY_MUTATED(gamut_lightness, std::cbrt(high))};
    }
};

Gamut gamut_at(const std::vector<float>& planes,
               std::size_t count,
               std::size_t pixel,
               const NonAdditive& table) {
    Gamut gamut{glm::dmat3(0.0), glm::dvec3(0.0), &table};
    for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column) {
            gamut.a[static_cast<int>(column)][r] =
                static_cast<double>(planes[(3 * row + column) * count + pixel]);
        }
        gamut.b[r] = static_cast<double>(planes[(9 + row) * count + pixel]);
    }
    return gamut;
}

void store(const glm::dmat3& matrix,
           const glm::dvec3& vector,
           std::size_t pixel,
           std::size_t count,
           std::vector<float>* planes) {
    for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column) {
            (*planes)[(3 * row + column) * count + pixel] =
                static_cast<float>(matrix[static_cast<int>(column)][r]);
        }
        (*planes)[(9 + row) * count + pixel] = static_cast<float>(vector[r]);
    }
}

void store(const std::optional<Gamut::Range>& range,
           std::size_t pixel,
           std::vector<float>* darkest,
           std::vector<float>* brightest) {
    if (!range) return;
    (*darkest)[pixel] = static_cast<float>(range->low);
    (*brightest)[pixel] = static_cast<float>(range->high);
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

GamutBoundary make_gamut_boundary(const CompensationTable& table) {
    const std::size_t count = table.pixels.size();
    GamutBoundary boundary;
    boundary.coefficients.resize(12 * count);
    for (auto* plane :
         {&boundary.darkest, &boundary.brightest, &boundary.own_darkest, &boundary.own_brightest}) {
        plane->resize(count);
    }
    // Primaries and black in working RGB are what has a meaningful mean; their inverse is a gamut.
    parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Gamut own = gamut_at(table.coefficients, count, i, table.non_additive);
            store(own.neutral_lightness(), i, &boundary.own_darkest, &boundary.own_brightest);
            const glm::dmat3 primaries = glm::inverse(own.a);
            store(primaries, primaries * -own.b, i, count, &boundary.coefficients);
        }
    });
    const WindowMean mean(table.width, table.height, table.pixels);
    parallel_for(12, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t plane = begin; plane < end; ++plane) {
            mean.apply(boundary.coefficients.data() + plane * count);
        }
    });
    parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Gamut outer = gamut_at(boundary.coefficients, count, i, table.non_additive);
            outer.a = glm::inverse(outer.a);
            outer.b = outer.a * -outer.b;
            store(outer.a, outer.b, i, count, &boundary.coefficients);
            store(outer.neutral_lightness(), i, &boundary.darkest, &boundary.brightest);
        }
    });
    if (count == 0) return boundary;
    boundary.floor_lightness = static_cast<double>(quantile(boundary.darkest, kFloorPercentile));
    const auto floor = static_cast<float>(boundary.floor_lightness);
    for (std::size_t i = 0; i < count; ++i) {
        boundary.darkest[i] = std::min(std::max(floor, boundary.darkest[i]), boundary.brightest[i]);
    }
    return boundary;
}

OklabMatrices oklab_matrices() {
    OklabMatrices m;
    m.cones = oklab_cones_from_xyz() * xyz_from_working();
    m.lab = oklab_from_cone_roots();
    m.roots = glm::inverse(m.lab);
    m.rgb = glm::inverse(m.cones);
    return m;
}

kernel::GamutJob gamut_job(const CompensationTable& table, std::size_t begin) {
    const GamutBoundary& boundary = table.gamut;
    kernel::GamutJob job;
    for (std::size_t plane = 0; plane < 12; ++plane) {
        job.boundary[plane] = boundary.coefficients.data() + plane * table.pixels.size() + begin;
    }
    job.darkest = boundary.darkest.data() + begin;
    job.brightest = boundary.brightest.data() + begin;
    job.own_darkest = boundary.own_darkest.data() + begin;
    job.own_brightest = boundary.own_brightest.data() + begin;
    job.table = table.non_additive.grid > 0 ? &table.non_additive : nullptr;
    return job;
}

}  // namespace livery
