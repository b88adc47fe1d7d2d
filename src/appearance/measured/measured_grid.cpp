#include "appearance/measured/measured_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/exponential.hpp>
#include <glm/mat3x3.hpp>

#include "appearance/measured/half_difference.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/random.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr int kRelativePairs = 20'000;

/// By the shader's own steps; its angles are those of f32 or f64.
template <typename Real, typename Nodes>
glm::vec<3, Real> interpolated(const MeasuredGrid& grid, const Nodes& nodes) {
    using Vec3 = glm::vec<3, Real>;
    const MeasuredGridSize& size = grid.size;
    const Vec3 at = nodes(Vec3(size.theta_h, size.theta_d, size.phi_d));
    if (std::isnan(at.x + at.y + at.z)) return Vec3(std::numeric_limits<Real>::quiet_NaN());
    const int column = std::min(static_cast<int>(at.z), size.phi_d - 1);
    const int next = column + 1 == size.phi_d ? 0 : column + 1;
    const int row = std::min(static_cast<int>(at.x), size.theta_h - 2);
    const int layer = std::min(static_cast<int>(at.y), size.theta_d - 2);
    const auto texel_at = [&](int theta_d, int theta_h, int phi_d) {
        const int index = (theta_d * size.theta_h + theta_h) * size.phi_d + phi_d;
        const float* texel = grid.texels.data() + 4 * static_cast<std::size_t>(index);
        return Vec3(texel[0], texel[1], texel[2]);
    };
    const auto in_row = [&](int l, int r) {
        return glm::mix(
            texel_at(l, r, column), texel_at(l, r, next), at.z - static_cast<Real>(column));
    };
    const auto in_layer = [&](int l) {
        return glm::mix(in_row(l, row), in_row(l, row + 1), at.x - static_cast<Real>(row));
    };
    const Vec3 logarithm =
        glm::mix(in_layer(layer), in_layer(layer + 1), at.y - static_cast<Real>(layer));
    return glm::mat<3, 3, Real>(working_from_xyz()) *
           (glm::exp2(logarithm) - Vec3(kMeasuredGridFloor));
}

}  // namespace

MeasuredGrid resampled(const MeasuredReflectance& measured,
                       MeasuredGridSize size,
                       const Progress& progress) {
    check_argument(size.theta_h >= 2 && size.theta_d >= 2 && size.phi_d >= 1,
                   "resampled: a grid of 2 x 2 x 1 nodes or more");
    MeasuredGrid grid;
    grid.size = size;
    const auto rows = static_cast<std::size_t>(size.theta_h);
    const auto columns = static_cast<std::size_t>(size.phi_d);
    grid.texels.resize(4 * rows * columns * static_cast<std::size_t>(size.theta_d));
    for (int layer = 0; layer < size.theta_d; ++layer) {
        progress.update(static_cast<double>(layer) / size.theta_d, "resampling");
        const double theta_d = 0.5 * std::numbers::pi * layer / (size.theta_d - 1);
        parallel_for(rows, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) {
                const double root = static_cast<double>(row) / (size.theta_h - 1);
                const double theta_h = 0.5 * std::numbers::pi * root * root;
                for (std::size_t column = 0; column < columns; ++column) {
                    const double phi_d =
                        std::numbers::pi * static_cast<double>(column) / size.phi_d;
                    const glm::dvec3 value = evaluate_at(measured, {theta_h, theta_d, phi_d});
                    const glm::dvec3 xyz = glm::max(xyz_from_working() * value, glm::dvec3(0.0));
                    const std::size_t at =
                        4 * ((static_cast<std::size_t>(layer) * rows + row) * columns + column);
                    for (glm::length_t c = 0; c < 3; ++c) {
                        grid.texels[at + static_cast<std::size_t>(c)] = static_cast<float>(
                            std::log2(xyz[c] + static_cast<double>(kMeasuredGridFloor)));
                    }
                }
            }
        });
    }
    return grid;
}

glm::vec3 evaluate(const MeasuredGrid& grid, glm::vec3 wi, glm::vec3 wo) {
    if (!(wi.z > 0.0f && wo.z > 0.0f)) return glm::vec3(0.0f);
    return interpolated<float>(grid, [&](const glm::vec3& size) {
        return f32::half_difference_nodes(f32::half_difference(wi, wo), size);
    });
}

glm::dvec3 evaluate_in_double(const MeasuredGrid& grid, glm::dvec3 wi, glm::dvec3 wo) {
    if (!(wi.z > 0.0 && wo.z > 0.0)) return glm::dvec3(0.0);
    return interpolated<double>(grid, [&](const glm::dvec3& size) {
        return f64::half_difference_nodes(f64::half_difference(wi, wo), size);
    });
}

std::string measured_glsl() {
    const auto source = [](const char* name) {
        return read_text_file(shipped_path(std::filesystem::path("shaders/bsdf") / name)) + "\n";
    };
    const glm::mat3 m(working_from_xyz());
    std::string columns;
    for (glm::length_t c = 0; c < 3; ++c) {
        columns += fmt::format("{}{:.9e}, {:.9e}, {:.9e}", c ? ", " : "", m[c].x, m[c].y, m[c].z);
    }
    return source("prelude_glsl.glsl") + source("half_difference.glsl") +
           fmt::format("#define MEASURED_FLOOR {:.9e}\n#define WORKING_FROM_XYZ mat3({})\n",
                       kMeasuredGridFloor,
                       columns) +
           source("measured.glsl");
}

std::vector<DirectionPair> lit_sphere_pairs(int pixels_across) {
    std::vector<DirectionPair> pairs;
    for (const double light_deg : {10.0, 35.0, 60.0, 90.0}) {
        const double angle = light_deg * std::numbers::pi / 180.0;
        const glm::dvec3 light(std::sin(angle), 0.0, std::cos(angle));
        for (int row = 0; row < pixels_across; ++row) {
            for (int column = 0; column < pixels_across; ++column) {
                const double x = 2.0 * (column + 0.5) / pixels_across - 1.0;
                const double y = 2.0 * (row + 0.5) / pixels_across - 1.0;
                const double z2 = 1.0 - x * x - y * y;
                if (z2 <= 0.0) continue;
                // The eye looks along -z; each pixel's own frame has its normal for z.
                const glm::dvec3 n(x, y, std::sqrt(z2));
                const glm::dvec3 t = glm::normalize(glm::dvec3(n.z, 0.0, -n.x));
                const glm::dvec3 b = glm::cross(n, t);
                const auto local = [&](const glm::dvec3& w) {
                    return glm::dvec3(glm::dot(w, t), glm::dot(w, b), glm::dot(w, n));
                };
                const DirectionPair pair{local(light), local({0.0, 0.0, 1.0})};
                if (pair.wi.z > 0.0) pairs.push_back(pair);
            }
        }
    }
    return pairs;
}

glm::dvec3 lab_on_sphere(const glm::dvec3& reflectance, double cosine) {
    const glm::dvec3 seen =
        glm::clamp(reflectance * (std::numbers::pi * cosine), glm::dvec3(0.0), glm::dvec3(1.0));
    return lab_from_xyz(xyz_from_working() * seen, d65_xyz());
}

DifferenceTruth difference_truth(const ReflectanceFunction& truth) {
    DifferenceTruth known;
    Random random(1);
    constexpr double kLowest = 0.17;
    for (int k = 0; k < kRelativePairs; ++k) {
        const auto direction = [&] {
            return direction_from_angles(std::acos(1.0 - (1.0 - kLowest) * random.uniform()),
                                         2.0 * std::numbers::pi * random.uniform());
        };
        const glm::dvec3 wi = direction();
        const glm::dvec3 wo = direction();
        const double expected = luminance_of_working(truth(wi, wo));
        if (expected <= 0.0) continue;
        known.pairs.push_back({wi, wo});
        known.luminances.push_back(expected);
    }
    known.sphere_pairs = lit_sphere_pairs();
    for (const DirectionPair& pair : known.sphere_pairs) {
        known.sphere_labs.push_back(lab_on_sphere(truth(pair.wi, pair.wo), pair.wi.z));
    }
    return known;
}

ReflectanceDifference difference_of(const ReflectanceFunction& value,
                                    const DifferenceTruth& truth) {
    ReflectanceDifference difference;
    std::vector<double> relative;
    for (std::size_t k = 0; k < truth.pairs.size(); ++k) {
        const double luminance = luminance_of_working(value(truth.pairs[k].wi, truth.pairs[k].wo));
        relative.push_back(std::abs(luminance - truth.luminances[k]) / truth.luminances[k]);
    }
    difference.relative_median = quantile(relative, 0.5);
    difference.relative_p95 = quantile(relative, 0.95);
    std::vector<double> colours;
    double sum = 0.0;
    for (std::size_t k = 0; k < truth.sphere_pairs.size(); ++k) {
        const DirectionPair& pair = truth.sphere_pairs[k];
        colours.push_back(
            ciede2000(lab_on_sphere(value(pair.wi, pair.wo), pair.wi.z), truth.sphere_labs[k]));
        sum += colours.back();
    }
    difference.de00_mean = sum / static_cast<double>(colours.size());
    difference.de00_p95 = quantile(colours, 0.95);
    return difference;
}

ReflectanceDifference difference_of(const ReflectanceFunction& value,
                                    const ReflectanceFunction& truth) {
    return difference_of(value, difference_truth(truth));
}

ReflectanceDifference resampling_error(const MeasuredGrid& grid,
                                       const MeasuredReflectance& measured) {
    return difference_of(
        [&](const glm::dvec3& wi, const glm::dvec3& wo) {
            return glm::dvec3(evaluate(grid, glm::vec3(wi), glm::vec3(wo)));
        },
        [&](const glm::dvec3& wi, const glm::dvec3& wo) { return evaluate(measured, wi, wo); });
}

}  // namespace livery
