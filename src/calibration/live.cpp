#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "calibration/bench_session.h"
#include "calibration/colour.h"
#include "calibration/colour_report.h"
#include "calibration/colour_samples.h"
#include "calibration/mixing.h"
#include "calibration/statistics.h"
#include "core/error.h"

namespace livery {
namespace {

constexpr int kMosaics = 6;  // with the six pictures of the method: twelve
constexpr double kFlickerWarning = 0.003, kLargestFlicker = 0.01;
constexpr const char* kSteadyLight =
    "let the lamp warm up for 20 minutes, switch off automatic exposure, eco and dynamic-contrast "
    "modes, expose for whole projector frames, and repeat";

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ImageF mean_of_channels(const ImageF& image) {
    ImageF mean(image.width, image.height, 1);
    for (std::size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] =
            (image.values[3 * i] + image.values[3 * i + 1] + image.values[3 * i + 2]) / 3.0f;
    return mean;
}

struct Geometry {
    ProjectorToCamera map;
    ImageF light;                      ///< white - black, camera pixels
    double lamp_per_photograph = 0.0;  ///< relative change of the lamp
    double flicker = 0.0;              ///< its scatter around that, of one photograph
};

/// Share of the lit pixels on which a stripe picture and its inverse do not add up to white.
double broken_share(const ImageF& stripes,
                    const ImageF& inverse,
                    const ImageF& white,
                    const ImageF& black) {
    const float brightest = [&] {
        std::vector<float> light;
        for (std::size_t i = 0; i < white.values.size(); i += 11)
            light.push_back(white.values[i] - black.values[i]);
        return quantile(std::move(light), 0.999);
    }();
    std::size_t lit = 0, broken = 0;
    for (std::size_t i = 0; i < white.values.size(); i += 7) {
        const float light = white.values[i] - black.values[i];
        if (!(light > 0.2f * brightest)) continue;
        ++lit;
        broken += std::abs(stripes.values[i] + inverse.values[i] - white.values[i] -
                           black.values[i]) > 0.25f * light;
    }
    return static_cast<double>(broken) / static_cast<double>(std::max<std::size_t>(lit, 1));
}

struct Lamp {
    double per_photograph = 0.0, flicker = 0.0;  ///< relative
};

/// How the lamp changes from photograph to photograph: each pair of stripes sums to white.
Lamp lamp_of(const std::vector<ImageF>& pictures, const GrayCodeResult& decoded) {
    const std::size_t pairs = (pictures.size() - 2) / 2;
    const ImageF& white = pictures[pictures.size() - 2];
    const ImageF& black = pictures[pictures.size() - 1];
    std::vector<double> brightness(pairs);
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        double sum = 0.0, expected = 0.0;
        for (std::size_t i = 0; i < decoded.decoded.values.size(); i += 7) {
            if (!decoded.decoded.values[i]) continue;
            sum += static_cast<double>(pictures[2 * pair].values[i] +
                                       pictures[2 * pair + 1].values[i] - 2.0f * black.values[i]);
            expected += static_cast<double>(white.values[i] - black.values[i]);
        }
        const double x = static_cast<double>(2 * pair), y = brightness[pair] = sum / expected;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto n = static_cast<double>(pairs);
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), mean = sy / n;
    double scatter = 0.0;
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        const double off =
            brightness[pair] - mean - slope * (static_cast<double>(2 * pair) - sx / n);
        scatter += off * off;
    }
    // A pair holds half the light of each of two photographs.
    return {slope / mean, std::sqrt(2.0 * scatter / std::max(n - 2.0, 1.0)) / mean};
}

Geometry photograph_geometry(BenchSession& session, const LiveOptions& options) {
    const std::vector<Pattern> patterns = geometry_patterns(options.width, options.height);
    std::vector<ImageF> pictures(patterns.size());
    const auto take = [&](std::size_t i, bool compared) {
        pictures[i] =
            mean_of_channels(session.take(patterns[i].drive, patterns[i].role, compared).image);
    };

    // White and black first: they tell of each pair of stripes whether both had arrived.
    const std::size_t white = patterns.size() - 2, black = patterns.size() - 1;
    take(white, false);
    take(black, true);
    for (std::size_t i = 0; i < white; i += 2)
        for (int attempt = 0;; ++attempt) {
            take(i, false);  // a small mock-up may lie inside one stripe of two pictures in a row
            take(i + 1, true);
            if (broken_share(pictures[i], pictures[i + 1], pictures[white], pictures[black]) <= 0.2)
                break;
            if (attempt == 2)
                throw Refused(
                    patterns[i].role + " and its inverse do not add up to white",
                    "the projector's picture arrives late or changes on its own, or the lamp's "
                    "brightness does: let it warm up, wait longer after each picture, and switch "
                    "off "
                    "motion interpolation and dynamic contrast");
        }
    const GrayCodeResult decoded =
        decode_gray_code(std::span<const ImageF>(pictures), options.width, options.height);
    Geometry geometry;
    const Lamp lamp = lamp_of(pictures, decoded);
    geometry.lamp_per_photograph = lamp.per_photograph / (session.latency() + 1);
    geometry.flicker = lamp.flicker;
    if (geometry.flicker > kLargestFlicker)
        throw Refused("the photographs differ by " + percent(geometry.flicker) +
                          " in brightness from one to the next",
                      kSteadyLight);
    geometry.map = invert_map(decoded, options.width, options.height);
    geometry.light = std::move(pictures[white]);
    for (std::size_t i = 0; i < geometry.light.values.size(); ++i)
        geometry.light.values[i] -= pictures[black].values[i];
    return geometry;
}

/// A well-lit place in the middle of an even neighbourhood, for the colorimeter.
glm::dvec2 place_to_measure(const Geometry& geometry, const Image8& mockup) {
    const ImageF& place = geometry.map.camera_px;
    ImageF light(place.width, place.height, 1);
    std::vector<float> all;
    for (int y = 0; y < place.height; ++y)
        for (int x = 0; x < place.width; ++x) {
            if (!std::isfinite(place.at(x, y)) || geometry.map.edge.at(x, y)) continue;
            if (!mockup.empty() && !mockup.at(x, y)) continue;
            const int cx =
                std::clamp(static_cast<int>(place.at(x, y, 0)), 0, geometry.light.width - 1);
            const int cy =
                std::clamp(static_cast<int>(place.at(x, y, 1)), 0, geometry.light.height - 1);
            light.at(x, y) = std::max(geometry.light.at(cx, cy), 0.0f);
            all.push_back(light.at(x, y));
        }
    const float low = quantile(all, 0.6), high = quantile(all, 0.97);
    constexpr int kReach = 6;
    glm::dvec2 best(0.0);
    double best_spread = 1e9;
    for (int y = kReach; y + kReach < place.height; y += 2)
        for (int x = kReach; x + kReach < place.width; x += 2) {
            if (light.at(x, y) < low || light.at(x, y) > high) continue;
            double sum = 0.0, square = 0.0;
            bool whole = true;
            for (int dy = -kReach; dy <= kReach && whole; dy += 2)
                for (int dx = -kReach; dx <= kReach; dx += 2) {
                    const auto v = static_cast<double>(light.at(x + dx, y + dy));
                    whole &= v > 0.0;
                    sum += v;
                    square += v * v;
                }
            if (!whole) continue;
            const double count = (kReach + 1) * (kReach + 1);
            const double spread = square * count / (sum * sum);
            if (spread < best_spread) {
                best_spread = spread;
                best = {x + 0.5, y + 0.5};
            }
        }
    if (best_spread > 1e8)
        throw Refused("no even, well-lit place of 13 px on the mock-up for the colorimeter",
                      "bring the projector nearer, so that the mock-up fills more of its picture");
    return best;
}

/// Undoes a slow change of the lamp, `change` relative to the bright picture.
void scale_light(Photograph& photo, double change) {
    const auto gain = static_cast<float>(1.0 / (1.0 + change)),
               black = static_cast<float>(photo.black_level);
    for (float& value : photo.image.values) value = black + (value - black) * gain;
}

}  // namespace

LiveResult calibrate_live(const BenchPorts& ports,
                          const LiveOptions& options,
                          const Progress& progress) {
    check_argument(options.shots >= 1 && options.shots <= 1000,
                   "shots " + std::to_string(options.shots) + " is outside 1..1000");
    check_argument(options.mockup.empty() ||
                       (options.mockup.width == options.width &&
                        options.mockup.height == options.height && options.mockup.channels == 1),
                   "the mock-up's mask is not one channel of the projector's size");
    const ColourOptions& colour = options.colour;
    LiveResult result;
    result.patterns =
        colour_patterns(options.width, options.height, colour.dark_drive, colour.bright_drive);

    const auto start = std::chrono::steady_clock::now();
    const int geometry_count =
        2 * (gray_code_bits(options.width) + gray_code_bits(options.height)) + 2;
    Progress capturing = progress;
    if (progress.report)
        capturing.report = [&](double fraction, std::string_view stage) {
            progress.report(0.9 * fraction, stage);
        };
    BenchSession session(ports, capturing, geometry_count + 6 * options.shots + 15);
    session.meet(options.width, options.height);
    const Geometry geometry = photograph_geometry(session, options);
    result.map = geometry.map;
    result.latency_photographs = session.latency();

    // The six pictures; the colorimeter reads each while it is known to be shown
    ColourOptions with_xyz = colour;
    const bool measures = static_cast<bool>(ports.measure_xyz) &&
                          !colour.camera_to_xyz.has_primaries &&
                          colour.camera_to_xyz.origin.empty();
    const bool full_range = colour.dark_drive == 0 && colour.bright_drive == 255;
    CameraToXyz& xyz = with_xyz.camera_to_xyz;
    if (measures) {
        xyz.has_primaries = true;
        xyz.measured_at_px = place_to_measure(geometry, options.mockup);
    }
    const auto measure = [&](const std::string& role) {
        if (!measures) return;
        const auto value_into = [&]() -> glm::dvec3 {
            return ports.measure_xyz(*xyz.measured_at_px);
        };
        if (role == "dark-gray") xyz.black_xyz = value_into();
        if (role == "bright-gray") xyz.white_xyz = value_into();
        if (role == "red") xyz.primaries_xyz[0] = value_into();
        if (role == "green") xyz.primaries_xyz[1] = value_into();
        if (role == "blue") xyz.primaries_xyz[2] = value_into();
    };
    int bright_at = 0;
    const auto photograph = [&](const Pattern& pattern) {
        RoledPhotograph capture{pattern.role,
                                session.take_mean(pattern.drive, pattern.role, options.shots)};
        result.colour_photographs += options.shots;
        if (pattern.role == "bright-gray") bright_at = session.photographs();
        const double change = geometry.lamp_per_photograph * (session.photographs() - bright_at);
        if (pattern.role != "dark-gray") {
            if (std::abs(change) > 0.01)
                throw Refused("the lamp changes by " + percent(std::abs(change)) +
                                  " while the colours are photographed",
                              "let the lamp warm up for 20 minutes and repeat");
            scale_light(capture.photograph, change);
        }
        result.captures.push_back(std::move(capture));
        if (full_range) measure(pattern.role);
    };
    for (const Pattern& pattern : result.patterns) photograph(pattern);

    // Is white the sum of the channels? If not, mosaics of colours
    const double additivity =
        pool_mixing(sample_colours(result.captures, result.map)).additivity_error;
    if (additivity > kAdditivityWarning && colour.mode == ColourMode::robust) {
        for (Pattern& pattern : mosaic_patterns(options.width, options.height, kMosaics)) {
            photograph(pattern);
            result.patterns.push_back(std::move(pattern));
        }
    }
    if (measures && !full_range)
        for (const Pattern& pattern : colour_patterns(options.width, options.height, 0, 255)) {
            if (pattern.role == "gray-levels") break;
            session.take(
                pattern.drive, pattern.role + " for the colorimeter", pattern.role != "dark-gray");
            measure(pattern.role);
        }
    if (additivity <= kAdditivityWarning) xyz.white_xyz.reset();  // it would only add its noise
    ports.show(Image8(options.width, options.height, 3));
    result.capture_seconds = seconds_since(start);

    const auto solve_start = std::chrono::steady_clock::now();
    Progress solving = progress;
    if (progress.report)
        solving.report = [&](double fraction, std::string_view stage) {
            progress.report(0.9 + 0.1 * fraction, stage);
        };
    result.calibration =
        calibrate_colour(result.captures, result.patterns, result.map, with_xyz, solving);
    if (geometry.flicker > kFlickerWarning) {
        result.calibration.warnings.push_back(
            "the photographs differ by " + percent(geometry.flicker) +
            " in brightness from one to the next; " + kSteadyLight);
        seal(result.calibration);
    }
    if (session.latency() > 0) {
        result.calibration.warnings.push_back(
            "the projector's picture reaches the camera " + std::to_string(session.latency()) +
            " photographs late; each was awaited; a game mode shortens it");
        seal(result.calibration);
    }
    result.solve_seconds = seconds_since(solve_start);
    return result;
}

}  // namespace livery
