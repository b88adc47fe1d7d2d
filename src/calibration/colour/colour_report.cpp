#include "calibration/colour/colour_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "calibration/colour/colour.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr double kAmbientWarning = 0.01, kAmbientStrong = 0.05;

/// Holes inside the lit mock-up, apart from what lies outside it: a lit pixel on both sides along
/// the row and along the column, within reach.
bool is_hole(const Image8& placed, int x, int y) {
    constexpr int kReach = 6;
    const auto seen = [&](int dx, int dy) {
        for (int k = 1; k <= kReach; ++k) {
            const int px = x + k * dx, py = y + k * dy;
            if (px < 0 || py < 0 || px >= placed.width || py >= placed.height) return false;
            if (placed.at(px, py)) return true;
        }
        return false;
    };
    return seen(1, 0) && seen(-1, 0) && seen(0, 1) && seen(0, -1);
}

}  // namespace

std::string percent(double fraction) {
    char text[32];
    std::snprintf(text, sizeof(text), fraction < 0.0995 ? "%.2f%%" : "%.1f%%", 100.0 * fraction);
    return text;
}

void check_shots(const std::string& role, double spread) {
    if (spread > 0.01)
        throw Refused(
            "the photographs of " + role + " differ by " + percent(spread) + " in brightness",
            "let the lamp warm up for 20 minutes, switch off automatic exposure, eco and "
            "dynamic-contrast modes, expose for whole projector frames, and repeat");
}

void refuse_not_additive(double error, double white_over_sum) {
    if (white_over_sum < 1.0)
        throw Refused(
            "white is " + percent(error) +
                " less than red + green + blue: files encoded for viewing but called linear, an "
                "over-exposed white, or a projector that boosts pure colours",
            "give the files' \"transfer\" in manifest.json or use RAW; shorten the exposure; "
            "switch "
            "colour enhancement off, or photograph the mosaics of colours too");
    throw Refused(
        "the projector is not additive: white differs from red + green + blue by " + percent(error),
        "switch the projector to its sRGB or cinema mode (no clear wheel segment, no colour "
        "enhancement), or photograph the mosaics of colours too; a lamp that changes meanwhile "
        "looks the same: photograph again and see whether the figure stays");
}

void refuse_invalid(const ColourSamples& samples, const std::vector<PixelStatus>& status) {
    const auto count = [&](PixelStatus which) {
        return static_cast<double>(std::count(status.begin(), status.end(), which)) /
               static_cast<double>(std::max<std::size_t>(samples.pixels.size(), 1));
    };
    throw Refused(
        "hardly any pixel of the mock-up can be corrected: " +
            percent(count(PixelStatus::too_dark)) + " too dark, " +
            percent(count(PixelStatus::one_channel)) + " without one channel, " +
            percent(count(PixelStatus::saturated)) + " saturated, " +
            percent(count(PixelStatus::ill_conditioned)) + " ill-conditioned, " +
            percent(count(PixelStatus::not_decoded)) + " not finite",
        "expose so that white on the mock-up reaches about 80% of full scale, photograph more "
        "shots, and darken the room");
}

void fill_planes(const ColourSamples& samples,
                 const PixelMixing& mixing,
                 const std::vector<PixelStatus>& status,
                 const ProjectorToCamera& map,
                 ColourCalibration& calibration) {
    const int width = samples.width, height = samples.height;
    calibration.unmixing = ImageF(width, height, 9);
    calibration.dark = ImageF(width, height, 3);
    calibration.span = ImageF(width, height, 3);
    calibration.status = Image8(width, height, 1);
    calibration.camera_px = map.camera_px;

    Image8 placed(width, height, 1);
    for (std::size_t p = 0; p < placed.values.size(); ++p)
        placed.values[p] = std::isfinite(map.camera_px.values[2 * p]) || map.edge.values[p];
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            PixelStatus here = PixelStatus::unlit;
            if (map.edge.at(x, y))
                here = PixelStatus::edge;
            else if (placed.at(x, y) || is_hole(placed, x, y))
                here = PixelStatus::not_decoded;  // unless it was sampled, below
            calibration.status.at(x, y) = static_cast<std::uint8_t>(here);
        }
    for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
        const std::size_t p = samples.pixels[i];
        const bool filled =
            status[i] == PixelStatus::measured && !map.filled.empty() && map.filled.values[p] != 0;
        calibration.status.values[p] =
            static_cast<std::uint8_t>(filled ? PixelStatus::filled : status[i]);
        if (!is_valid(status[i])) continue;
        for (std::size_t row = 0; row < 3; ++row) {
            const auto r = static_cast<int>(row);
            for (std::size_t column = 0; column < 3; ++column)
                calibration.unmixing.values[9 * p + 3 * row + column] =
                    mixing.unmixing[i][static_cast<int>(column)][r];
            calibration.dark.values[3 * p + row] = mixing.dark[i][r];
            calibration.span.values[3 * p + row] = mixing.span[i][r];
        }
    }
}

void report(const PixelMixing& mixing,
            const std::vector<PixelStatus>& status,
            const PooledMixing& pooled,
            double response_error,
            bool with_table,
            ColourCalibration& calibration) {
    auto& warnings = calibration.warnings;
    const auto lit = static_cast<double>(std::count_if(calibration.status.values.begin(),
                                                       calibration.status.values.end(),
                                                       [](std::uint8_t s) { return s != 0; }));
    const auto share = [&](PixelStatus which) {
        return static_cast<double>(std::count(calibration.status.values.begin(),
                                              calibration.status.values.end(),
                                              static_cast<std::uint8_t>(which))) /
               std::max(lit, 1.0);
    };
    calibration.valid_fraction = share(PixelStatus::measured) + share(PixelStatus::filled);

    // Condition and ambient light over the valid pixels
    std::vector<float> conditions, ambient;
    for (std::size_t i = 0; i < status.size(); ++i) {
        if (!is_valid(status[i])) continue;
        conditions.push_back(mixing.condition[i]);
        const glm::vec3 dark = mixing.dark[i], bright = mixing.dark[i] + mixing.span[i];
        ambient.push_back(std::max(dark.x + dark.y + dark.z, 0.0f) /
                          (bright.x + bright.y + bright.z));
    }
    calibration.condition_p99 = static_cast<double>(quantile(std::move(conditions), 0.99));
    calibration.ambient_fraction = static_cast<double>(median(std::move(ambient)));

    if (!with_table && pooled.additivity_error > kAdditivityWarning)
        warnings.push_back(
            "white differs from red + green + blue by " + percent(pooled.additivity_error) +
            ": a clear wheel segment, colour enhancement, or a lamp that drifted; switch the "
            "projector to its sRGB or cinema mode");
    if (with_table)
        warnings.push_back(
            "the projector is not additive (white differs by " + percent(pooled.additivity_error) +
            "): a table of mosaic colours is used, rms error " + percent(response_error) +
            "; its sRGB or cinema mode would be more exact");
    if (calibration.ambient_fraction > kAmbientStrong)
        warnings.push_back(
            "STRONG: the dark picture has " + percent(calibration.ambient_fraction) +
            " of the bright one: room light or a projector with little contrast; many paints "
            "cannot be shown; switch the lights off and close the blinds");
    else if (calibration.ambient_fraction > kAmbientWarning)
        warnings.push_back(
            "the dark picture has " + percent(calibration.ambient_fraction) +
            " of the bright one: room light or a projector with little contrast; darken the room");
    if (calibration.condition_p99 > 5.0)
        warnings.push_back(
            "the camera's channels hardly separate the projector's (condition number " +
            std::to_string(calibration.condition_p99).substr(0, 4) +
            "): noise is amplified; more shots help, another camera or a neutral white balance "
            "more");
    if (share(PixelStatus::saturated) > 0.001)
        warnings.push_back(
            percent(share(PixelStatus::saturated)) +
            " of the lit pixels saturate the camera and stay black; shorten the exposure");
    if (share(PixelStatus::too_dark) + share(PixelStatus::one_channel) > 0.05)
        warnings.push_back(percent(share(PixelStatus::too_dark) + share(PixelStatus::one_channel)) +
                           " of the lit pixels are too dark and stay black: shadow, grazing light, "
                           "noise or too short an "
                           "exposure; more shots, or move the projector");
    if (!with_table && !(response_error <= 0.01))
        warnings.push_back("the grey levels' white blocks lie " + percent(response_error) +
                           " from bright-gray, more than scattered light explains: the lamp "
                           "changed, or the projector's focus is soft; warm up the lamp, focus");
    double violation = 0.0;
    for (const ResponseCurve& curve : calibration.response)
        violation = worse_of(violation, curve.largest_violation);
    if (violation > 0.01)
        warnings.push_back("the response falls by up to " + percent(violation) +
                           " between neighbouring grey levels before it is made monotone: noise, "
                           "or a projector that "
                           "processes its picture; more shots, or switch processing off");
}

}  // namespace livery
