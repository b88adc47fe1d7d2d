#include "jobs/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/worst_error.h"

namespace livery {

namespace {

std::uint8_t byte_of(double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// byte_of(srgb_encode(value)) by table: the byte of each of kSteps equal steps of [0, 1], and
/// where the bytes change. A step holds at most one change: the curve rises by 12.92 x 255 a unit
/// at most.
class SrgbBytes {
  public:
    SrgbBytes() {
        for (int k = 0; k < 256; ++k) from_[static_cast<std::size_t>(k)] = first_of(k);
        int byte = 0;
        for (int step = 0; step <= kSteps; ++step) {
            while (byte < 255 && from_[static_cast<std::size_t>(byte) + 1] * kSteps <= step) ++byte;
            bytes_[static_cast<std::size_t>(step)] = static_cast<std::uint8_t>(byte);
        }
    }
    std::uint8_t operator()(double value) const {
        const double clipped = value > 0.0 ? std::min(value, 1.0) : 0.0;
        const std::size_t byte = bytes_[static_cast<std::size_t>(clipped * kSteps)];
        const bool next = byte < 255 && clipped >= from_[byte + 1];
        return static_cast<std::uint8_t>(byte + (next ? 1 : 0));
    }

  private:
    static constexpr int kSteps = 4096;
    /// The smallest value that becomes byte k, by halving.
    static double first_of(int k) {
        if (k == 0) return 0.0;
        double below = 0.0, above = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (below + above);
            (byte_of(srgb_encode(middle)) >= k ? above : below) = middle;
        }
        return above;
    }
    std::array<double, 256> from_{};
    std::array<std::uint8_t, kSteps + 1> bytes_{};
};

/// Any linear picture through `rec709_from_source` into sRGB bytes.
void encode_srgb(const ImageF& source, const glm::dmat3& rec709_from_source, Image8* result) {
    static const SrgbBytes bytes;
    check_argument(source.channels >= 3, "srgb pictures need three channels");
    if (result->width != source.width || result->height != source.height || result->channels != 3) {
        *result = Image8(source.width, source.height, 3);
    }
    for (std::size_t i = 0; i < source.pixel_count(); ++i) {
        const float* v = source.values.data() + i * static_cast<std::size_t>(source.channels);
        std::uint8_t* out = result->values.data() + 3 * i;
        if (v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f) {
            std::fill(out, out + 3, std::uint8_t{0});
            continue;
        }
        const glm::dvec3 rgb = rec709_from_source * glm::dvec3(v[0], v[1], v[2]);
        for (int c = 0; c < 3; ++c) out[c] = bytes(rgb[c]);
    }
}

/// Dark violet over red and orange to pale yellow, lightness rising evenly: its stops are Oklab
/// L = .25 .40 .55 .70 .85 .97 at hues that turn from violet to yellow.
std::array<std::uint8_t, 3> ramp(double t) {
    static const std::array<glm::dvec3, 6> stops = {glm::dvec3(0.25, 0.03, -0.10),
                                                    glm::dvec3(0.40, 0.12, -0.06),
                                                    glm::dvec3(0.55, 0.18, 0.04),
                                                    glm::dvec3(0.70, 0.12, 0.13),
                                                    glm::dvec3(0.85, 0.02, 0.15),
                                                    glm::dvec3(0.97, -0.02, 0.08)};
    const double place = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double f = place - static_cast<double>(i);
    const glm::dvec3 rgb =
        rec709_from_xyz() * xyz_from_oklab((1.0 - f) * stops[i] + f * stops[i + 1]);
    std::array<std::uint8_t, 3> bytes{};
    for (int c = 0; c < 3; ++c) {
        bytes[static_cast<std::size_t>(c)] = byte_of(srgb_encode(std::clamp(rgb[c], 0.0, 1.0)));
    }
    return bytes;
}

}  // namespace

PixelRectangle bounds_of_mask(const Image8& mask, int margin_px) {
    PixelRectangle box{mask.width, mask.height, 0, 0};
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            box = {std::min(box.left, x),
                   std::min(box.top, y),
                   std::max(box.right, x + 1),
                   std::max(box.bottom, y + 1)};
        }
    }
    if (box.right <= box.left) return {0, 0, mask.width, mask.height};
    return {std::max(0, box.left - margin_px),
            std::max(0, box.top - margin_px),
            std::min(mask.width, box.right + margin_px),
            std::min(mask.height, box.bottom + margin_px)};
}

ImageF developed(const Photograph& photograph, const glm::dmat3& xyz_from_camera) {
    ImageF xyz(photograph.image.width, photograph.image.height, 3);
    for (std::size_t i = 0; i < xyz.pixel_count(); ++i) {
        glm::dvec3 camera;
        for (int c = 0; c < 3; ++c) {
            camera[c] = linear_from_file_units(
                photograph,
                static_cast<double>(photograph.image.values[3 * i + static_cast<std::size_t>(c)]));
        }
        const glm::dvec3 value = xyz_from_camera * camera;
        for (int c = 0; c < 3; ++c) {
            xyz.values[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
        }
    }
    return xyz;
}

Image8 srgb_from_xyz(const ImageF& xyz, double white_y) {
    Image8 result;
    encode_srgb(xyz, rec709_from_xyz() * (1.0 / white_y), &result);
    return result;
}

Image8 srgb_from_working(const ImageF& working) {
    Image8 result;
    srgb_from_working_into(working, &result);
    return result;
}

void srgb_from_working_into(const ImageF& working, Image8* srgb) {
    encode_srgb(working, rec709_from_working(), srgb);
}

Image8 difference_map(const ImageF& de00, double full_scale) {
    Image8 result(de00.width, de00.height, 3, 96);
    for (std::size_t i = 0; i < de00.pixel_count(); ++i) {
        if (!std::isfinite(de00.values[i])) continue;
        const auto colour = ramp(static_cast<double>(de00.values[i]) / full_scale);
        std::copy(colour.begin(),
                  colour.end(),
                  result.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return result;
}

Image8 difference_legend(int width, int height) {
    ImageF values(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            values.at(x, y) = static_cast<float>(x) / static_cast<float>(std::max(1, width - 1));
        }
    }
    return difference_map(values, 1.0);
}

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
