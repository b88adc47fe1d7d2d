#include "calibration/colour/colour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "calibration/colour/camera_xyz.h"
#include "calibration/colour/colour_report.h"
#include "calibration/colour/colour_samples.h"
#include "calibration/colour/drive_table.h"
#include "calibration/colour/levels_check.h"
#include "calibration/colour/mixing.h"
#include "calibration/colour/response.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "core/time.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr double kSigmas = 20.0;          // of T - S over its noise
constexpr double kShareOfPeak = 0.005;    // of T - S over the mock-up's largest
constexpr int kFarthestFromBorder = 5;    // projector pixels
constexpr std::uint32_t kBlock_px = 16;   // the largest blocks of gray-levels
constexpr float kUnknownScatter = 0.01f;  // of the scattered light's square: 10%

const Pattern& pattern_of(const std::vector<Pattern>& patterns,
                          std::string_view role,
                          const ColourSamples& samples) {
    const auto found = std::find_if(
        patterns.begin(), patterns.end(), [&](const Pattern& p) { return p.role == role; });
    check_argument(found != patterns.end(),
                   fmt::format("no pattern given for the photograph of {}", role));
    check_argument(found->drive.channels == 3 && found->drive.width == samples.width &&
                       found->drive.height == samples.height,
                   fmt::format("the pattern {} is {}x{}, the map is {}x{}",
                               role,
                               found->drive.width,
                               found->drive.height,
                               samples.width,
                               samples.height));
    return *found;
}

/// Centres of a pattern's blocks, as far from the border as their size allows.
std::vector<std::uint8_t> centres_of(const Pattern& pattern) {
    const auto share = [](const std::vector<std::uint8_t>& centre) {
        return static_cast<double>(std::accumulate(centre.begin(), centre.end(), std::size_t{0})) /
               static_cast<double>(centre.size());
    };
    auto centre = block_centres(pattern.drive, kFarthestFromBorder);
    for (int reach = kFarthestFromBorder - 1; reach >= 2 && share(centre) < 0.14; --reach)
        centre = block_centres(pattern.drive, reach);
    check_argument(share(centre) > 0.0,
                   "the pattern " + pattern.role + " has no uniform blocks of 5 px or more");
    return centre;
}

glm::vec3 invariant(const PixelMixing& mixing, std::size_t i, glm::vec3 colour) {
    return (mixing.unmixing[i] * colour - mixing.dark[i]) / mixing.span[i];
}

std::vector<PixelStatus> judge(const ColourSamples& samples, const PixelMixing& mixing) {
    const std::size_t count = samples.pixels.size();
    glm::vec3 peak(0.0f);
    for (int k = 0; k < 3; ++k) {
        std::vector<float> spans;
        for (std::size_t i = 0; i < count; ++i)
            if (samples.finite[i] && !samples.saturated[i] && std::isfinite(mixing.span[i][k]))
                spans.push_back(mixing.span[i][k]);
        peak[k] = quantile(std::move(spans), 0.999);
    }
    std::vector<PixelStatus> status(count, PixelStatus::measured);
    for (std::size_t i = 0; i < count; ++i) {
        if (!samples.finite[i]) {
            status[i] = PixelStatus::not_decoded;
            continue;
        }
        if (samples.saturated[i]) {
            status[i] = PixelStatus::saturated;
            continue;
        }
        int passing = 0;
        for (int k = 0; k < 3; ++k)
            passing +=
                mixing.span[i][k] > std::max(static_cast<float>(kSigmas) * mixing.span_sigma[i][k],
                                             static_cast<float>(kShareOfPeak) * peak[k]);
        if (passing == 0)
            status[i] = PixelStatus::too_dark;
        else if (passing < 3)
            status[i] = PixelStatus::one_channel;
        else if (!(mixing.condition[i] <= kMixingConditionLimit))
            status[i] = PixelStatus::ill_conditioned;
    }
    return status;
}

std::vector<ResponseSample> response_samples(const LevelsSamples& seen,
                                             const ScatteredLight& scattered,
                                             int channel) {
    const auto& [samples, mixing, usable, levels, centre] = seen;
    std::vector<ResponseSample> found;
    const SampledPicture& picture = samples.pictures[kLevels];
    double span2 = 0.0, count = 0.0;
    for (std::size_t i = 0; i < usable.size(); ++i) {
        if (!usable[i]) continue;
        span2 += static_cast<double>(mixing.span[i][channel]) * mixing.span[i][channel];
        count += 1.0;
    }
    // A camera without noise still rounds.
    const auto noise = static_cast<float>(
        std::max(samples.noise.read[channel] / picture.shots, 1e-8 * span2 / std::max(count, 1.0)));
    for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
        if (!usable[i] || !centre[samples.pixels[i]]) continue;
        const float span = mixing.span[i][channel], taken_off = scattered.separated[i][channel];
        const float n = invariant(mixing, i, picture.colour[i])[channel] - taken_off / span;
        // N's noise grows as the span falls, and so does what is not known of the scattered light.
        const auto p = samples.pixels[i];
        const auto x = p % static_cast<std::uint32_t>(samples.width),
                   y = p / static_cast<std::uint32_t>(samples.width);
        found.push_back(
            {n,
             span * span /
                 (noise + scattered.variance[i][channel] + kUnknownScatter * taken_off * taken_off),
             levels.drive.values[3 * std::size_t{p} + static_cast<std::size_t>(channel)],
             1 + (y / kBlock_px << 16u | x / kBlock_px)});
    }
    return found;
}

/// Mean N of each drive that the mosaics show, and what the uniform pictures add.
std::vector<TableSample> table_samples(const ColourSamples& samples,
                                       const PixelMixing& mixing,
                                       const std::vector<PixelStatus>& status,
                                       const std::vector<Pattern>& patterns) {
    std::vector<TableSample> found;
    const auto add_picture = [&](const SampledPicture& picture,
                                 const Pattern& pattern,
                                 const std::vector<std::uint8_t>& centre) {
        std::vector<std::pair<std::uint32_t, std::size_t>> order;  // drive, sample
        for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
            if (status[i] != PixelStatus::measured ||
                (!centre.empty() && !centre[samples.pixels[i]]))
                continue;
            const std::uint8_t* const d =
                pattern.drive.values.data() + 3 * static_cast<std::size_t>(samples.pixels[i]);
            order.emplace_back(static_cast<std::uint32_t>(d[0]) |
                                   static_cast<std::uint32_t>(d[1]) << 8u |
                                   static_cast<std::uint32_t>(d[2]) << 16u,
                               i);
        }
        std::sort(order.begin(), order.end());
        for (std::size_t begin = 0; begin < order.size();) {
            std::size_t end = begin;
            std::array<std::vector<float>, 3> n;
            for (; end < order.size() && order[end].first == order[begin].first; ++end) {
                const std::size_t i = order[end].second;
                const glm::vec3 value = invariant(mixing, i, picture.colour[i]);
                for (int k = 0; k < 3; ++k) n[static_cast<std::size_t>(k)].push_back(value[k]);
            }
            const std::uint32_t code = order[begin].first;
            begin = end;
            // Weighted by the bright pixels' precision through a trimmed mean
            TableSample sample{{static_cast<std::uint8_t>(code),
                                static_cast<std::uint8_t>(code >> 8u),
                                static_cast<std::uint8_t>(code >> 16u)},
                               glm::dvec3(0.0),
                               0.0};
            for (std::size_t k = 0; k < 3; ++k) {
                const float centre_n = median(n[k]);
                std::vector<float> distance;
                for (const float v : n[k]) distance.push_back(std::abs(v - centre_n));
                const double spread = 1.4826 * static_cast<double>(median(distance));
                double sum = 0.0, used = 0.0;
                for (const float v : n[k])
                    if (std::abs(static_cast<double>(v - centre_n)) <= 3.0 * spread + 1e-7) {
                        sum += static_cast<double>(v);
                        used += 1.0;
                    }
                sample.n[static_cast<int>(k)] = sum / used;
                sample.variance += spread * spread / used / 3.0;
            }
            if (n[0].size() < 4) sample.variance += 1e-4;  // scatter of so few tells nothing
            found.push_back(sample);
        }
    };
    for (const SampledPicture& picture : samples.mosaics) {
        const Pattern& pattern = pattern_of(patterns, picture.role, samples);
        add_picture(picture, pattern, centres_of(pattern));
    }
    const Pattern& levels = pattern_of(patterns, "gray-levels", samples);
    add_picture(samples.pictures[kLevels], levels, centres_of(levels));
    return found;
}

void check_settings(const CalibrationSettings& settings) {
    check_argument(settings.dark_drive >= 0 && settings.dark_drive < settings.bright_drive &&
                       settings.bright_drive <= 255,
                   "drives s = " + std::to_string(settings.dark_drive) + ", t = " +
                       std::to_string(settings.bright_drive) + " are not 0 <= s < t <= 255");
    check_argument(
        settings.kernel_bandwidth > 0.0 && settings.kernel_bandwidth < 1.0,
        "kernel bandwidth " + std::to_string(settings.kernel_bandwidth) + " is not in 0..1");
    check_argument(settings.mode == ColourMode::paper ||
                       (settings.dark_drive == 0 && settings.bright_drive == 255),
                   "robust mode needs s = 0 and t = 255, found " +
                       std::to_string(settings.dark_drive) + " and " +
                       std::to_string(settings.bright_drive));
    const CameraToXyz& xyz = settings.camera_to_xyz;
    if (!xyz.has_primaries && !xyz.origin.empty())
        check_argument(std::isfinite(condition_number(xyz.xyz_from_camera)) &&
                           condition_number(xyz.xyz_from_camera) < 1e6,
                       "xyz_from_camera is singular or not finite");
}

}  // namespace

ColourCalibration calibrate_colour(const std::vector<RoledPhotograph>& captures,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const CalibrationSettings& settings,
                                   const Progress& progress) {
    check_settings(settings);
    progress.update(0.0, "reading the photographs through the map");
    const ColourSamples samples = sample_colours(captures, map);
    const Pattern& levels = pattern_of(patterns, "gray-levels", samples);
    if (samples.pixels.size() < 64)
        throw Refused("only " + std::to_string(samples.pixels.size()) +
                          " projector pixels have a place in the camera's picture",
                      "repeat the geometry photographs; check focus and that the camera sees the "
                      "lit mock-up");
    for (const SampledPicture& picture : samples.pictures)
        // Dark pictures hold too little light to tell the lamp's brightness.
        if (picture.role != "dark-gray") check_shots(picture.role, picture.shot_spread);

    progress.update(0.3, "separating the channels");
    const PooledMixing pooled = pool_mixing(samples);
    ColourCalibration calibration;
    calibration.additivity_error = pooled.additivity_error;
    calibration.mixing_spread = pooled.spread;
    const bool additive = pooled.additivity_error <= kAdditivityWarning ||
                          (pooled.additivity_error <= kAdditivityLimit && samples.mosaics.empty());
    if (!additive && samples.mosaics.empty()) {
        const auto total = [](glm::dvec3 v) { return v.x + v.y + v.z; };
        refuse_not_additive(pooled.additivity_error,
                            total(pooled.bright) / total(pooled.red + pooled.green + pooled.blue));
    }
    if (!additive && settings.mode == ColourMode::paper)
        throw Refused("the projector is not additive (" + percent(pooled.additivity_error) +
                          ") and the published method has no model for that",
                      "use --mode robust, which fits the mosaics of colours, or switch the "
                      "projector to its sRGB or cinema mode");
    PixelMixing mixing = settings.mode == ColourMode::paper
                             ? mix_by_pixel(samples)
                             : mix_robustly(samples, pooled, additive);
    const std::vector<PixelStatus> status = judge(samples, mixing);
    const auto valid =
        static_cast<std::size_t>(std::count(status.begin(), status.end(), PixelStatus::measured));
    if (valid < 64) refuse_invalid(samples, status);

    progress.update(0.6, "fitting the response");
    const auto centre = centres_of(levels);
    glm::dvec3 share_of_channel(1.0);
    double response_error = 0.0;
    if (additive) {
        ScatteredLight scattered{
            std::vector<glm::vec3>(status.size()), std::vector<glm::vec3>(status.size()), {}};
        std::vector<std::uint8_t> usable;
        for (const PixelStatus s : status) usable.push_back(s == PixelStatus::measured);
        std::array<LevelCurve, 3> curves;
        const LevelsSamples seen{samples, mixing, usable, levels, centre};
        if (settings.mode == ColourMode::robust) scattered = scattered_light(seen);
        for (int k = 0; k < 3; ++k) {
            const auto channel = response_samples(seen, scattered, k);
            if (channel.size() < 256)
                throw Refused(
                    "only " + std::to_string(channel.size()) +
                        " valid pixels lie in the middle of a grey block",
                    "bring the projector nearer, so that the mock-up fills more of its picture");
            const LevelCurve measured = level_means(channel);
            const LevelCurve smooth = smooth_levels(measured);
            curves[static_cast<std::size_t>(k)] = smooth;
            if (settings.mode == ColourMode::robust) continue;
            // N runs from drive 0 to 255, of which S and T are only two: N' = (N - first) / range
            const bool whole = settings.dark_drive == 0 && settings.bright_drive == 255;
            const double first = whole ? 0.0 : smooth.n[0], last = whole ? 1.0 : smooth.n[255];
            calibration.response[static_cast<std::size_t>(k)] =
                kernel_response(channel, settings.kernel_bandwidth, first, last);
            for (std::size_t i = 0; i < status.size(); ++i) {
                mixing.dark[i][k] += static_cast<float>(first) * mixing.span[i][k];
                mixing.span[i][k] *= static_cast<float>(last - first);
            }
        }
        if (settings.mode == ColourMode::robust) {
            const LevelsVerdict verdict = check_levels(seen, scattered, curves);
            calibration.warnings = verdict.warnings;
            response_error = verdict.unexplained;
            for (std::size_t k = 0; k < 3; ++k) {
                const double of_span = scattered.of_span[static_cast<int>(k)];
                const double off = worse_of(std::abs(curves[k].n[0] + of_span),
                                            std::abs(curves[k].n[255] + of_span - 1.0));
                if (off > 0.2)
                    throw Refused("black and white blocks of gray-levels lie " + percent(off) +
                                      " from the dark and the bright picture",
                                  "check that the gray-levels photograph shows the gray-levels "
                                  "picture at the same exposure, and that the lamp is warm");
                calibration.response[k] = invert_levels(curves[k], 0, 255);
            }
        }
    } else {
        const std::vector<TableSample> found = [&] {
            auto all = table_samples(samples, mixing, status, patterns);
            const glm::dmat3 inverse = glm::inverse(pooled.vn);
            const glm::dvec3 bright = inverse * pooled.bright;
            const glm::dvec3 red = inverse * pooled.red / bright,
                             green = inverse * pooled.green / bright,
                             blue = inverse * pooled.blue / bright;
            share_of_channel = {red.x, green.y, blue.z};
            all.push_back({{0, 0, 0}, glm::dvec3(0.0), 1e-9});
            all.push_back({{255, 255, 255}, glm::dvec3(1.0), 1e-9});
            all.push_back({{255, 0, 0}, red, 1e-9});
            all.push_back({{0, 255, 0}, green, 1e-9});
            all.push_back({{0, 0, 255}, blue, 1e-9});
            return all;
        }();
        TableFit fit = fit_drive_table(found);
        calibration.table = std::move(fit.table);
        calibration.response = std::move(fit.response);
        response_error = fit.rms_error;
    }

    progress.update(0.8, "relating the camera to XYZ");
    const CameraToXyz& xyz = settings.camera_to_xyz;
    if (xyz.has_primaries) {
        const CameraPrimaries camera =
            primaries_at(samples, mixing, status, share_of_channel, xyz.measured_at_px);
        calibration.xyz_from_camera = xyz_from_primaries(xyz, camera);
        if (xyz.measured_at_px) match_black(xyz, camera, calibration.xyz_from_camera, mixing);
        calibration.xyz_origin = "primaries";
    } else {
        calibration.xyz_from_camera = xyz.origin.empty() ? xyz_from_rec709() : xyz.xyz_from_camera;
        calibration.xyz_origin = xyz.origin.empty() ? "assumed Rec.709" : xyz.origin;
    }

    progress.update(0.9, "writing the planes");
    calibration.width = samples.width;
    calibration.height = samples.height;
    calibration.created = utc_now();
    calibration.mode = settings.mode == ColourMode::paper ? "paper" : "robust";
    calibration.made_with = settings.made_with;
    calibration.dark_drive = settings.dark_drive;
    calibration.bright_drive = settings.bright_drive;
    fill_planes(samples, mixing, status, map, calibration);
    report(mixing, status, pooled, response_error, !additive, calibration);
    progress.update(1.0, "colour calibration done");
    return calibration;
}

}  // namespace livery
