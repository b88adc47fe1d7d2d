// Equation 9 folded with colour spaces and design white into twelve numbers a pixel.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <glm/glm.hpp>

#include "compensation/compensation.h"
#include "compensation/drive_table.h"
#include "compensation/gamut.h"
#include "compensation/lit_pixels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"

namespace livery {
namespace {

std::string size_text(int width, int height, int channels) {
    return std::to_string(width) + "x" + std::to_string(height) + " with " +
           std::to_string(channels) + " channels";
}

template <typename T>
void check_plane(const ColourCalibration& calibration,
                 const Image<T>& plane,
                 int channels,
                 const char* name) {
    check_argument(
        plane.width == calibration.width && plane.height == calibration.height &&
            plane.channels == channels &&
            plane.values.size() == plane.pixel_count() * static_cast<std::size_t>(channels),
        std::string("calibration plane ") + name + " is " +
            size_text(plane.width, plane.height, plane.channels) + ", expected " +
            size_text(calibration.width, calibration.height, channels));
}

/// N = from_xyz * XYZ + offset at one pixel.
struct PixelMap {
    glm::dmat3 from_xyz;
    glm::dvec3 offset;
};

class PixelMaps {
  public:
    explicit PixelMaps(const ColourCalibration& calibration) : calibration_(calibration) {
        check_argument(calibration.width > 0 && calibration.height > 0,
                       "a calibration of " + std::to_string(calibration.width) + "x" +
                           std::to_string(calibration.height) + " pixels");
        check_plane(calibration, calibration.unmixing, 9, "unmixing");
        check_plane(calibration, calibration.dark, 3, "dark");
        check_plane(calibration, calibration.span, 3, "span");
        check_plane(calibration, calibration.status, 1, "status");
        const double determinant = glm::determinant(calibration.xyz_from_camera);
        camera_from_xyz_ = glm::inverse(calibration.xyz_from_camera);
        bool usable = std::isfinite(determinant) && determinant != 0.0;
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 3; ++r) usable = usable && std::isfinite(camera_from_xyz_[c][r]);
        }
        check_argument(usable,
                       "xyz_from_camera cannot be inverted, its determinant is " +
                           std::to_string(determinant));
    }

    bool valid(std::size_t pixel) const {
        return is_valid(static_cast<PixelStatus>(calibration_.status.values[pixel]));
    }

    /// Of a pixel that is not valid: as its neighbours have it.
    PixelMap at(std::size_t pixel) const {
        const PixelCorrection own = correction_of(calibration_, pixel);
        PixelMap map;
        glm::dmat3 separated_from_camera;
        for (std::size_t row = 0; row < 3; ++row) {
            const auto r = static_cast<int>(row);
            const auto span = static_cast<double>(own.span[row]);
            for (std::size_t column = 0; column < 3; ++column) {
                separated_from_camera[static_cast<int>(column)][r] =
                    static_cast<double>(own.unmixing[3 * row + column]) / span;
            }
            map.offset[r] =
                LIVERY_MUTATED(compensation_black, -static_cast<double>(own.dark[row]) / span);
        }
        map.from_xyz = LIVERY_MUTATED(compensation_solve, separated_from_camera * camera_from_xyz_);
        return map;
    }

  private:
    const ColourCalibration& calibration_;
    glm::dmat3 camera_from_xyz_{1.0};
};

/// The largest g for which N = direction * g + offset stays in the unit cube; 0 when none does.
double brightest_in_cube(const glm::dvec3& direction, const glm::dvec3& offset) {
    double low = 0.0, high = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0.0) {
            if (offset[k] < 0.0 || offset[k] > 1.0) return 0.0;
            continue;
        }
        const double at_zero = -offset[k] / direction[k];
        const double at_one = LIVERY_MUTATED(design_white, (1.0 - offset[k]) / direction[k]);
        low = std::max(low, std::min(at_zero, at_one));
        high = std::min(high, std::max(at_zero, at_one));
    }
    return high >= low && std::isfinite(high) ? high : 0.0;
}

void check_response(const ColourCalibration& calibration) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<float>& curve = calibration.response[k].drive_from_n;
        check_argument(curve.size() >= 2,
                       "response of channel " + std::to_string(k) + " has " +
                           std::to_string(curve.size()) + " samples, expected 2 or more");
        for (std::size_t i = 0; i < curve.size(); ++i) {
            check_argument(
                curve[i] >= 0.0f && curve[i] <= 255.0f && (i == 0 || curve[i] >= curve[i - 1]),
                "response of channel " + std::to_string(k) + " is " + std::to_string(curve[i]) +
                    " at sample " + std::to_string(i) + ", expected rising drives from 0 to 255");
        }
    }
}

/// N is linear in the light that the projector sends.
void fade(CompensationTable& table) {
    const std::size_t count = table.pixels.size();
    for (std::size_t plane = 0; plane < 12; ++plane) {
        float* const values = table.coefficients.data() + plane * count;
        for (std::size_t i = 0; i < count; ++i) values[i] *= table.light[i];
    }
}

NonAdditive non_additive_of(const ColourCalibration& calibration) {
    return calibration.table.grid == 0 ? NonAdditive{}
                                       : make_non_additive(calibration.table, calibration.response);
}

}  // namespace

double design_white_luminance(const ColourCalibration& calibration,
                              double percentile,
                              const Image8& mockup) {
    check_argument(percentile >= 0.0 && percentile <= 100.0,
                   "percentile " + std::to_string(percentile) + ", expected 0 to 100");
    if (!mockup.empty()) check_plane(calibration, mockup, 1, "mock-up mask");
    const PixelMaps maps(calibration);
    const NonAdditive non_additive = non_additive_of(calibration);
    std::vector<std::uint32_t> counted;
    for (std::size_t i = 0; i < calibration.status.values.size(); ++i) {
        if (maps.valid(i) && (mockup.empty() || mockup.values[i] != 0)) {
            counted.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (counted.empty()) {
        throw Refused("no pixel of the mock-up has a valid correction",
                      "look at the calibration's status picture, check that the projector lights "
                      "the mock-up where the product stands in the projector's view and that the "
                      "camera sees it, and calibrate again");
    }
    std::vector<double> brightest(counted.size());
    parallel_for(counted.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PixelMap map = maps.at(counted[i]);
            const glm::dvec3 direction = map.from_xyz * d65_xyz();
            brightest[i] = brightest_in_cube(direction, map.offset);
            if (non_additive.grid > 0) {
                brightest[i] =
                    brightest_reachable(non_additive, direction, map.offset, brightest[i]);
            }
        }
    });
    // That share of the pixels may be darker: a rank of its own, not the nearest value.
    const auto rank =
        std::min(static_cast<std::size_t>(percentile / 100.0 * static_cast<double>(counted.size())),
                 counted.size() - 1);
    std::nth_element(
        brightest.begin(), brightest.begin() + static_cast<std::ptrdiff_t>(rank), brightest.end());
    return brightest[rank];
}

CompensationTable bake(const ColourCalibration& calibration,
                       double design_white_y,
                       GamutMapping gamut) {
    check_argument(
        std::isfinite(design_white_y) && design_white_y > 0.0,
        "design white of " + std::to_string(design_white_y) + ", expected a positive luminance");
    const PixelMaps maps(calibration);
    CompensationTable table;
    table.width = calibration.width;
    table.height = calibration.height;
    table.design_white_y = design_white_y;
    table.calibration_id = calibration.id;
    table.non_additive = non_additive_of(calibration);
    if (table.non_additive.grid == 0) {
        check_response(calibration);
        for (std::size_t k = 0; k < 3; ++k) {
            table.drive_from_n[k] = calibration.response[k].drive_from_n;
        }
    }
    LitPixels lit = lit_pixels(calibration.status);
    table.pixels = std::move(lit.pixels);
    table.light = std::move(lit.light);
    const std::size_t count = table.pixels.size();
    table.coefficients.resize(12 * count);
    const glm::dmat3 xyz_from_wanted = xyz_from_working() * design_white_y;
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PixelMap map = maps.at(table.pixels[i]);
            const glm::dmat3 a = map.from_xyz * xyz_from_wanted;
            for (std::size_t row = 0; row < 3; ++row) {
                const auto r = static_cast<int>(row);
                for (std::size_t column = 0; column < 3; ++column) {
                    table.coefficients[(3 * row + column) * count + i] =
                        static_cast<float>(a[static_cast<int>(column)][r]);
                }
                table.coefficients[(9 + row) * count + i] = static_cast<float>(map.offset[r]);
            }
        }
    });
    // What a pixel could show does not depend on how much of it is sent.
    if (gamut == GamutMapping::preserve) table.gamut = make_gamut_boundary(table);
    fade(table);
    return table;
}

}  // namespace livery
