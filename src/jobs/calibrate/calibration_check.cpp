#include "jobs/calibrate/calibration_check.h"

#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "compensation/compensation.h"
#include "core/colour.h"
#include "core/error.h"
#include "jobs/calibrate/calibration_versions.h"

namespace livery {

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
    check.capture_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
