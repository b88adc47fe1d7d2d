#include "jobs/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/worst_error.h"

namespace livery {

namespace {

glm::dvec3 vec3_at(const ImageF& image, std::size_t pixel) {
    const float* v = image.values.data() + pixel * static_cast<std::size_t>(image.channels);
    return {v[0], v[1], v[2]};
}

}  // namespace

ErrorStatistics statistics_of(std::vector<float> errors) {
    ErrorStatistics statistics;
    statistics.pixels = errors.size();
    if (errors.empty()) return statistics;
    for (float& error : errors) error = worst_if_nan(error);
    std::sort(errors.begin(), errors.end());
    const auto ranked = [&](double fraction) {
        const auto rank =
            static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(errors.size())));
        return static_cast<double>(errors[std::max<std::size_t>(rank, 1) - 1]);
    };
    statistics.median = ranked(0.5);
    statistics.p95 = ranked(0.95);
    double sum = 0.0;
    for (const float error : errors) sum += static_cast<double>(error);
    statistics.mean = sum / static_cast<double>(errors.size());
    statistics.worst = static_cast<double>(errors.back());
    return statistics;
}

Comparison compare_xyz(const ImageF& wanted_xyz,
                       const ImageF& shown_xyz,
                       glm::dvec3 white_xyz,
                       const ComparisonMasks& masks) {
    const std::size_t count = wanted_xyz.pixel_count();
    check_argument(shown_xyz.pixel_count() == count && masks.lit.pixel_count() == count &&
                       masks.edge.pixel_count() == count && masks.valid.pixel_count() == count &&
                       masks.reachable.pixel_count() == count &&
                       (masks.predicted.empty() || masks.predicted.pixel_count() == count),
                   "compare_xyz: pictures and masks must have one size");
    check_argument(wanted_xyz.channels == 3 && shown_xyz.channels == 3,
                   "compare_xyz: pictures must have three channels");
    check_argument(white_xyz.y > 0.0, "compare_xyz: white must be positive");

    Comparison result;
    result.de00 =
        ImageF(wanted_xyz.width, wanted_xyz.height, 1, std::numeric_limits<float>::quiet_NaN());
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!masks.lit.values[i]) continue;
            result.de00.values[i] =
                static_cast<float>(ciede2000(lab_from_xyz(vec3_at(wanted_xyz, i), white_xyz),
                                             lab_from_xyz(vec3_at(shown_xyz, i), white_xyz)));
        }
    });

    std::vector<float> interior, edge, clipped, reachable, predicted;
    std::size_t lit = 0, lit_predicted = 0, lit_reachable = 0, masked = 0, interior_reachable = 0,
                interior_valid = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (!masks.lit.values[i]) continue;
        const bool valid = masks.valid.values[i] != 0;
        const bool can = masks.reachable.values[i] != 0;
        const bool at_edge = masks.edge.values[i] != 0;
        ++lit;
        lit_reachable += can;
        masked += !valid;
        if (can && !at_edge) {
            ++interior_reachable;
            interior_valid += valid;
            reachable.push_back(result.de00.values[i]);
        }
        if (!valid) continue;
        if (!masks.predicted.empty() && masks.predicted.values[i]) {
            ++lit_predicted;
            if (can) predicted.push_back(result.de00.values[i]);
        }
        if (can) {
            (at_edge ? edge : interior).push_back(result.de00.values[i]);
        } else if (!at_edge) {
            clipped.push_back(result.de00.values[i]);
        }
    }
    const auto fraction = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    result.interior = statistics_of(std::move(interior));
    result.edge = statistics_of(std::move(edge));
    result.clipped = statistics_of(std::move(clipped));
    result.reachable_with_masked = statistics_of(std::move(reachable));
    result.predicted = statistics_of(std::move(predicted));
    result.reachable_fraction = fraction(lit_reachable, lit);
    result.valid_fraction = fraction(interior_valid, interior_reachable);
    result.masked_fraction = fraction(masked, lit);
    result.predicted_fraction = fraction(lit_predicted, lit);
    return result;
}

ImageF xyz_from_wanted(const ImageF& wanted_working, double design_white_y) {
    check_argument(wanted_working.channels >= 3, "xyz_from_wanted: needs three channels");
    ImageF xyz(wanted_working.width, wanted_working.height, 3);
    for (std::size_t i = 0; i < xyz.pixel_count(); ++i) {
        const glm::dvec3 value = design_white_y * (xyz_from_working() * vec3_at(wanted_working, i));
        for (int c = 0; c < 3; ++c) {
            xyz.values[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
        }
    }
    return xyz;
}

Image8 corrected_pixels(const ColourCalibration& calibration, bool predicted_only) {
    Image8 mask(calibration.width, calibration.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) {
        const auto status = static_cast<PixelStatus>(calibration.status.values[i]);
        const bool holds = predicted_only ? status == PixelStatus::predicted : is_valid(status);
        mask.values[i] = holds ? 255 : 0;
    }
    return mask;
}

ComparisonMasks masks_of_eye(const Bench& bench,
                             const Image8& valid,
                             const Image8& predicted,
                             const ImageF& wanted_eye_xyz) {
    const Observer& eye = bench.eye().observer;
    ComparisonMasks masks{eye.truth.lit,
                          mostly_lit_by(eye, bench.truth().edge),
                          mostly_lit_by(eye, valid),
                          bench.reachable_from_eye(wanted_eye_xyz),
                          mostly_lit_by(eye, predicted)};
    for (std::size_t i = 0; i < masks.edge.values.size(); ++i) {
        masks.edge.values[i] |= eye.truth.edge.values[i];
    }
    return masks;
}

ErrorStatistics picture_offset(const View& true_view,
                               const Mesh& true_mesh,
                               const View& believed_view,
                               const Mesh& believed_mesh,
                               const Image8& lit) {
    check_argument(true_mesh.positions_mm.size() == believed_mesh.positions_mm.size(),
                   "picture_offset: two meshes of unequal vertices");
    std::vector<float> off_px;
    for (std::size_t i = 0; i < true_mesh.positions_mm.size(); ++i) {
        const auto there = project(true_view, glm::dvec3(true_mesh.positions_mm[i]));
        const auto drawn = project(believed_view, glm::dvec3(believed_mesh.positions_mm[i]));
        if (!there || !drawn || there->x < 0.0 || there->y < 0.0) continue;
        if (there->x >= lit.width || there->y >= lit.height) continue;
        if (!lit.at(static_cast<int>(there->x), static_cast<int>(there->y))) continue;
        off_px.push_back(static_cast<float>(glm::distance(*there, *drawn)));
    }
    return statistics_of(std::move(off_px));
}

}  // namespace livery
