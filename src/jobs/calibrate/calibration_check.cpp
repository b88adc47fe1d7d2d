#include "jobs/calibrate/calibration_check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "compensation/compensation.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/time.h"
#include "core/worst_error.h"
#include "jobs/comparison.h"
#include "scene/mockup_mask.h"

namespace livery {

std::vector<std::pair<std::string, std::string>> calibration_figures(const ColourCalibration& c) {
    const auto percent = [](double fraction) { return fmt::format("{:.1f}%", 100.0 * fraction); };
    std::vector<std::pair<std::string, std::string>> figures = {
        {"Made", c.created},
        {"With", c.made_with},
        {"Mode", c.mode},
        {"Camera to XYZ", c.xyz_origin},
        {"Additivity error", percent(c.additivity_error)},
        {"Condition of the mixing, 99th percentile", fmt::format("{:.2f}", c.condition_p99)},
        {"Measured, of the lit pixels", percent(c.valid_fraction)},
        {"Predicted, of the valid pixels", percent(c.predicted_fraction)},
        {"Ambient over white", percent(c.ambient_fraction)}};
    for (const std::string& warning : c.warnings) figures.emplace_back("Warning", warning);
    return figures;
}

std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration) {
    std::vector<GradedFigure> figures;
    figures.push_back(
        graded_share("Valid pixels",
                     calibration.valid_fraction,
                     0.95,
                     0.85,
                     "Measured pixels, of all that the projector lights. The others are "
                     "predicted, follow their neighbours in small gaps, or fade to black.",
                     "Move the camera nearer to the projector, or take more photographs."));
    if (calibration.predicted_fraction > 0.0) {
        figures.push_back({"Predicted pixels",
                           fmt::format("{:.1f} %", 100.0 * calibration.predicted_fraction),
                           "",
                           "Hidden from the camera; worked out from the mesh and the pose.",
                           "",
                           Grade::good});
        figures.push_back(graded_share("Prediction error",
                                       calibration.prediction_error_median,
                                       0.02,
                                       0.10,
                                       "How well measured pixels are predicted without their "
                                       "surroundings.",
                                       "Check the pose of the mock-up and its mesh."));
    }
    figures.push_back(
        graded_share("Additivity error",
                     calibration.additivity_error,
                     0.02,
                     0.05,
                     "How far the projector's white is from the sum of its red, green and "
                     "blue.",
                     "Set the projector to its sRGB or cinema mode."));
    figures.push_back({"Condition",
                       fmt::format("{:.2f}", calibration.condition_p99),
                       "good under 3, usable under 10",
                       "How much separating the channels amplifies the camera's noise.",
                       "Try another camera or white balance, and a neutral mock-up.",
                       grade_of(calibration.condition_p99, 3.0, 10.0)});
    figures.push_back(graded_share("Room light",
                                   calibration.ambient_fraction,
                                   0.01,
                                   0.05,
                                   "The dark picture's brightness over the bright one's.",
                                   "Darken the room."));
    double violation = 0.0;
    for (const ResponseCurve& curve : calibration.response) {
        violation = worse_of(violation, curve.largest_violation);
    }
    figures.push_back(graded_share("Response fall",
                                   violation,
                                   0.01,
                                   0.03,
                                   "How far the measured response fell before it was made rising.",
                                   "Switch dynamic contrast and picture processing off."));
    return figures;
}

namespace {

/// N for a drive, of a curve equally spaced in N; in the middle of where it does not rise.
double n_of_drive(const std::vector<float>& drive_from_n, double drive) {
    const auto value = static_cast<float>(drive);
    const auto last = static_cast<double>(drive_from_n.size() - 1);
    const auto [low, high] = std::equal_range(drive_from_n.begin(), drive_from_n.end(), value);
    const auto index = [&](auto place) {
        return static_cast<double>(std::distance(drive_from_n.begin(), place));
    };
    if (low != high) return 0.5 * (index(low) + index(high - 1)) / last;
    if (low == drive_from_n.begin()) return 0.0;
    if (low == drive_from_n.end()) return 1.0;
    const auto before = static_cast<double>(*(low - 1)), after = static_cast<double>(*low);
    return (index(low) - 1.0 + (drive - before) / (after - before)) / last;
}

/// What a drive shows by a calibration's table, in the working space.
class Shown {
  public:
    explicit Shown(const CompensationTable& table)
        : table_(table),
          index_(static_cast<std::size_t>(table.width) * static_cast<std::size_t>(table.height),
                 -1) {
        for (std::size_t k = 0; k < table.pixels.size(); ++k)
            index_[table.pixels[k]] = static_cast<std::int64_t>(k);
    }
    bool knows(std::size_t pixel) const { return index_[pixel] >= 0; }
    glm::dvec3 operator()(std::size_t pixel, const std::uint8_t* drive) const {
        const auto k = static_cast<std::size_t>(index_[pixel]);
        const auto plane = [&](std::size_t number) {
            return static_cast<double>(table_.coefficients[number * table_.pixels.size() + k]);
        };
        glm::dmat3 n_from_rgb;
        glm::dvec3 offset, n;
        for (int row = 0; row < 3; ++row) {
            const auto r = static_cast<std::size_t>(row);
            for (int column = 0; column < 3; ++column)
                n_from_rgb[column][row] = plane(3 * r + static_cast<std::size_t>(column));
            offset[row] = plane(9 + r);
            n[row] = n_of_drive(table_.drive_from_n[r], drive[row]);
        }
        return glm::inverse(n_from_rgb) * (n - offset);
    }

  private:
    const CompensationTable& table_;
    std::vector<std::int64_t> index_;
};

double valid_share(const ColourCalibration& calibration, const Image8& mockup) {
    std::size_t valid = 0, all = 0;
    for (std::size_t i = 0; i < mockup.values.size(); ++i) {
        all += mockup.values[i] != 0;
        valid +=
            mockup.values[i] && is_valid(static_cast<PixelStatus>(calibration.status.values[i]));
    }
    return static_cast<double>(valid) / static_cast<double>(std::max<std::size_t>(all, 1));
}

ErrorStatistics colours_apart(const CompensationTable& then,
                              const CompensationTable& now,
                              const ColourCalibration& measured_then,
                              const ColourCalibration& measured_now,
                              const Image8& mockup) {
    const Shown shown(now);
    const double white_y = now.design_white_y;
    const glm::dvec3 white_xyz = white_y * (xyz_from_working() * glm::dvec3(1.0));
    const auto measured = static_cast<std::uint8_t>(PixelStatus::measured);
    std::vector<float> errors;
    for (const MutedColour& colour : kMutedColours) {
        const Image8 drive = compensate(then, uniform_picture(colour, mockup));
        const glm::dvec3 wanted =
            lab_from_xyz(white_y * (xyz_from_working() * colour.working), white_xyz);
        for (std::size_t i = 0; i < mockup.values.size(); ++i) {
            if (!mockup.values[i] || !shown.knows(i)) continue;
            if (measured_then.status.values[i] != measured ||
                measured_now.status.values[i] != measured)
                continue;
            const glm::dvec3 xyz = white_y * (xyz_from_working() * shown(i, &drive.values[3 * i]));
            errors.push_back(static_cast<float>(ciede2000(wanted, lab_from_xyz(xyz, white_xyz))));
        }
    }
    return statistics_of(std::move(errors));
}

}  // namespace

ImageF uniform_picture(const MutedColour& colour, const Image8& mockup) {
    ImageF wanted(mockup.width, mockup.height, 4);
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        for (int c = 0; c < 3; ++c)
            wanted.values[4 * i + static_cast<std::size_t>(c)] =
                static_cast<float>(colour.working[c]);
        wanted.values[4 * i + 3] = mockup.values[i] ? 1.0f : 0.0f;
    }
    return wanted;
}

CalibrationDifference compare_calibrations(const ColourCalibration& then,
                                           const View& projector_then,
                                           const ColourCalibration& now,
                                           const View& projector_now,
                                           const Mesh& mesh) {
    check_argument(then.width == now.width && then.height == now.height,
                   fmt::format("calibrations of {}x{} and of {}x{} pixels: expected one projector",
                               then.width,
                               then.height,
                               now.width,
                               now.height));
    const Image8 mockup_then = mockup_mask(mesh, projector_then),
                 mockup = mockup_mask(mesh, projector_now);
    CalibrationDifference difference;
    difference.valid_then = valid_share(then, mockup_then);
    difference.valid_now = valid_share(now, mockup);
    const double white_then = design_white_luminance(then, kOutOfReach_percent, mockup_then),
                 white_now = design_white_luminance(now, kOutOfReach_percent, mockup);
    difference.brightness = white_now / white_then;
    difference.moved_px = picture_offset(projector_now, mesh, projector_then, mesh, mockup);
    if (then.table.grid == 0 && now.table.grid == 0) {
        const double white_y = std::min(white_then, white_now);
        difference.de00 = colours_apart(bake(then, white_y), bake(now, white_y), then, now, mockup);
    }
    return difference;
}

std::vector<GradedFigure> grade_figures(const CalibrationDifference& difference) {
    std::vector<GradedFigure> figures;
    if (difference.de00.pixels > 0)
        figures.push_back(
            {"Colours apart",
             fmt::format("{:.2f} / {:.2f}", difference.de00.median, difference.de00.p95),
             "CIEDE2000, median / 95 %; good under 1, usable under 2",
             "What the older one shows if the newer one is right, against what is wanted.",
             "If nothing was changed on the bench, one of the two was spoiled: look at their "
             "figures, and check the one in use.",
             grade_of(difference.de00.median, 1.0, 2.0)});
    figures.push_back(
        {"Pictures apart",
         fmt::format("{:.2f} / {:.2f} px", difference.moved_px.median, difference.moved_px.p95),
         "projector pixels, median / 95 %; good under 0.5, usable under 2",
         "How far the two draw the mock-up from one another.",
         "The mock-up or the projector has moved between the two: use the newer.",
         grade_of(difference.moved_px.median, 0.5, 2.0)});
    figures.push_back({"Design white",
                       fmt::format("{:+.1f} %", 100.0 * (difference.brightness - 1.0)),
                       "",
                       "The newer one's brightest neutral against the older one's.",
                       "",
                       Grade::good});
    figures.push_back(
        {"Corrected pixels",
         fmt::format(
             "{:.1f} % to {:.1f} %", 100.0 * difference.valid_then, 100.0 * difference.valid_now),
         "",
         "Of the mock-up's pixels, the older one's and the newer one's.",
         "",
         Grade::good});
    return figures;
}

namespace {

constexpr int kBlock_px = 4;
constexpr std::size_t kLeastBlocks = 50;

/// Linear camera colour between four pixels; nothing where one of them is full or outside.
std::optional<glm::dvec3> colour_at(const Photograph& photograph, double x, double y) {
    const ImageF& image = photograph.image;
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    if (!(left >= 0.0 && top >= 0.0 && left + 1.0 < image.width && top + 1.0 < image.height))
        return std::nullopt;
    const double right_share = x - 0.5 - left, lower_share = y - 0.5 - top;
    glm::dvec3 colour(0.0);
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column) {
            const double share = (column ? right_share : 1.0 - right_share) *
                                 (row ? lower_share : 1.0 - lower_share);
            for (int c = 0; c < 3; ++c) {
                const auto value = static_cast<double>(
                    image.at(static_cast<int>(left) + column, static_cast<int>(top) + row, c));
                if (value >= 0.98 * photograph.saturates_at) return std::nullopt;
                colour[c] += share * linear_from_file_units(photograph, value);
            }
        }
    return colour;
}

/// The colour seen at a projector pixel that was measured, apart from edges.
std::optional<glm::dvec3> seen_at(const ColourCalibration& calibration,
                                  const ProjectorToCamera& map,
                                  const Photograph& seen,
                                  std::size_t pixel) {
    const bool measured =
        calibration.status.values[pixel] == static_cast<std::uint8_t>(PixelStatus::measured);
    if (!measured || map.edge.values[pixel]) return std::nullopt;
    const auto x = static_cast<double>(map.camera_px.values[2 * pixel]),
               y = static_cast<double>(map.camera_px.values[2 * pixel + 1]);
    if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
    return colour_at(seen, x, y);
}

/// CIEDE2000 of each block of pixels of which half or more were seen: a camera's noise from pixel
/// to pixel is no error of the calibration.
std::vector<float> differences(const ColourCalibration& calibration,
                               const ProjectorToCamera& map,
                               const Image8& mockup,
                               const Photograph& seen,
                               const glm::dvec3& wanted_xyz,
                               const glm::dvec3& white_xyz) {
    const glm::dvec3 wanted = lab_from_xyz(wanted_xyz, white_xyz);
    std::vector<float> errors;
    for (int top = 0; top + kBlock_px <= mockup.height; top += kBlock_px)
        for (int left = 0; left + kBlock_px <= mockup.width; left += kBlock_px) {
            glm::dvec3 sum(0.0);
            int count = 0;
            for (int y = top; y < top + kBlock_px; ++y)
                for (int x = left; x < left + kBlock_px; ++x) {
                    if (!mockup.at(x, y)) continue;
                    const auto pixel =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(mockup.width) +
                        static_cast<std::size_t>(x);
                    const auto colour = seen_at(calibration, map, seen, pixel);
                    if (!colour) continue;
                    sum += *colour;
                    ++count;
                }
            if (2 * count < kBlock_px * kBlock_px) continue;
            const glm::dvec3 xyz = calibration.xyz_from_camera * (sum / static_cast<double>(count));
            errors.push_back(static_cast<float>(ciede2000(wanted, lab_from_xyz(xyz, white_xyz))));
        }
    return errors;
}

}  // namespace

CalibrationCheck check_calibration(const BenchPorts& ports,
                                   const ColourCalibration& calibration,
                                   const ProjectorToCamera& map,
                                   const Image8& mockup,
                                   const Photograph& white,
                                   int late,
                                   const Progress& progress) {
    check_argument(mockup.width == calibration.width && mockup.height == calibration.height,
                   "the mock-up's mask is not of the calibration's size");
    const auto start = std::chrono::steady_clock::now();
    const double white_y = design_white_luminance(calibration, kOutOfReach_percent, mockup);
    const CompensationTable table = bake(calibration, white_y);
    const glm::dvec3 white_xyz = white_y * (xyz_from_working() * glm::dvec3(1.0));

    CalibrationCheck check;
    std::vector<float> all;
    for (std::size_t k = 0; k < std::size(kMutedColours); ++k) {
        const MutedColour& colour = kMutedColours[k];
        progress.update(static_cast<double>(k) / std::size(kMutedColours),
                        fmt::format("showing a corrected {}", colour.name));
        CheckedColour checked;
        checked.role = fmt::format("verify-{}", k);
        checked.name = colour.name;
        checked.drive = compensate(table, uniform_picture(colour, mockup));
        if (ports.announce) ports.announce(checked.role);
        ports.show(checked.drive);
        checked.photograph = ports.photograph(white.exposure_s);
        for (int waited = 0; waited < late; ++waited)
            checked.photograph = ports.photograph(white.exposure_s);
        const glm::dvec3 wanted_xyz = white_y * (xyz_from_working() * colour.working);
        std::vector<float> errors =
            differences(calibration, map, mockup, checked.photograph, wanted_xyz, white_xyz);
        if (errors.size() < kLeastBlocks)
            throw Refused(fmt::format("only {} places of {} pixels on the mock-up can be compared",
                                      errors.size(),
                                      kBlock_px * kBlock_px),
                          "photograph the colours again: hardly any of the mock-up was measured");
        all.insert(all.end(), errors.begin(), errors.end());
        checked.de00 = statistics_of(std::move(errors));
        check.colours.push_back(std::move(checked));
    }
    ports.show(Image8(calibration.width, calibration.height, 3));
    check.de00 = statistics_of(std::move(all));
    check.capture_seconds = seconds_since(start);
    return check;
}

std::vector<GradedFigure> grade_figures(const CalibrationCheck& check) {
    const char* const fix =
        "Look whether something has moved or the lamp's brightness has changed, and photograph the "
        "colours again.";
    std::vector<GradedFigure> figures;
    figures.push_back({"Colours shown",
                       fmt::format("{:.2f}", check.de00.median),
                       "CIEDE2000, median; good under 1, usable under 2",
                       "How far corrected colours are from those wanted, as the camera sees them.",
                       fix,
                       grade_of(check.de00.median, 1.0, 2.0)});
    figures.push_back({"The worst of them",
                       fmt::format("{:.2f}", check.de00.p95),
                       "CIEDE2000, 95th percentile; good under 3, usable under 6",
                       "The same, exceeded by one pixel in twenty.",
                       fix,
                       grade_of(check.de00.p95, 3.0, 6.0)});
    return figures;
}

}  // namespace livery
