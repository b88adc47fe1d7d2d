#include "calibration/calibrate_live.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/bench_session.h"
#include "calibration/captures/captures.h"
#include "calibration/colour/colour.h"
#include "calibration/colour/colour_report.h"
#include "calibration/colour/colour_samples.h"
#include "calibration/colour/mixing.h"
#include "calibration/predict.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/time.h"
#include "scene/mockup_mask.h"

namespace livery {
namespace {

constexpr int kToMeet = 18;  // photographs: latency and exposure, and white and black once more

/// Pictures that are shown to find places.
std::size_t shown_for_places(const CalibrationSettings& settings) {
    return place_roles(settings.places, settings.width, settings.height).size();
}

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

/// What is known of a session so far, and what went wrong with it: the cause that the photographs
/// themselves tell comes before the one that the session ran into.
class LiveCalibration {
  public:
    LiveCalibration(BenchSession& bench, const CalibrationSettings& settings)
        : bench_(bench), settings_(settings) {}

    Captures captures;
    std::vector<std::pair<std::string, std::string>> kept;  ///< roles and files of a recording

    CaptureVerdict judge(bool with_stripes) const {
        return judge_captures(captures, settings_, with_stripes);
    }
    void add(const std::string& role, Photograph photograph) {
        for (const std::string& file : photograph.kept_as) kept.emplace_back(role, file);
        add_capture(captures, {role, std::move(photograph)});
    }
    void photograph(const Pattern& pattern, int shots = 1) {
        for (Photograph& shot : bench_.take_all(pattern.drive, pattern.role, shots))
            add(pattern.role, std::move(shot));
    }
    void photograph_geometry();
    /// White and black, which everything else is compared with.
    void photograph_ends(bool white_first);
    /// White - black in camera pixels, mean of the channels.
    ImageF light() const;
    const Photograph& white() const { return white_; }
    const Photograph& black() const { return black_; }

  private:
    void photograph_stripes(const Pattern& stripes, const Pattern& inverse);

    BenchSession& bench_;
    const CalibrationSettings& settings_;
    Photograph white_, black_;
    std::string broken_;  ///< the first pair of stripes that does not add up to white
};

/// Both again where a picture had not arrived, or somebody stood before it. After the first pair
/// that fails for good the others are taken once: all together tell what is wrong.
void LiveCalibration::photograph_stripes(const Pattern& stripes, const Pattern& inverse) {
    constexpr int kAttempts = 3;
    for (int attempt = 1;; ++attempt) {
        // A small mock-up may lie inside one stripe of two pictures in a row.
        Photograph first = bench_.take(stripes.drive, stripes.role, false);
        Photograph second = bench_.take(inverse.drive, inverse.role, true);
        const bool broken =
            broken_share(first.image, second.image, white_.image, black_.image) > 0.2;
        if (broken && attempt < kAttempts && broken_.empty()) continue;
        if (broken && broken_.empty()) broken_ = stripes.role;
        add(stripes.role, std::move(first));
        add(inverse.role, std::move(second));
        return;
    }
}

/// White and black first: they tell of each pair of stripes whether both had arrived. What was
/// photographed before is judged once all of it is there.
void LiveCalibration::photograph_geometry() {
    const auto pattern = [&](std::size_t number) {
        return place_pattern(settings_.places, settings_.width, settings_.height, number);
    };
    const std::size_t count = geometry_roles(settings_.width, settings_.height).size();
    const std::size_t with_fringes = shown_for_places(settings_);
    if (bench_.fixed()) {
        for (std::size_t k = 0; k < with_fringes; ++k) photograph(pattern(k));
        return;
    }
    photograph_ends(true);
    for (std::size_t k = 0; k + 2 < count; k += 2) photograph_stripes(pattern(k), pattern(k + 1));
    for (std::size_t k = count; k < with_fringes; ++k) photograph(pattern(k));
    judge(true);
    if (!broken_.empty())
        throw Refused(broken_ + " and its inverse do not add up to white",
                      "the projector's picture arrives late or changes on its own, or the lamp's "
                      "brightness does: let it warm up, wait longer after each picture, and switch "
                      "off motion interpolation and dynamic contrast");
}

void LiveCalibration::photograph_ends(bool white_first) {
    for (const bool white : {white_first, !white_first}) {
        const std::string role = white ? "white" : "black";
        const Image8 drive(settings_.width, settings_.height, 3, white ? 255 : 0);
        (white ? white_ : black_) = bench_.take(drive, role, white != white_first);
        add(role, white ? white_ : black_);
    }
}

ImageF LiveCalibration::light() const {
    ImageF light = mean_of_channels(white_.image);
    const ImageF black = mean_of_channels(black_.image);
    for (std::size_t i = 0; i < light.values.size(); ++i) light.values[i] -= black.values[i];
    return light;
}

/// A well-lit place in the middle of an even neighbourhood, for the colorimeter.
glm::dvec2 place_to_measure(const ProjectorToCamera& map,
                            const ImageF& seen,
                            const Image8& mockup) {
    const ImageF& place = map.camera_px;
    ImageF light(place.width, place.height, 1);
    std::vector<float> all;
    for (int y = 0; y < place.height; ++y)
        for (int x = 0; x < place.width; ++x) {
            if (!std::isfinite(place.at(x, y)) || map.edge.at(x, y)) continue;
            if (!mockup.empty() && !mockup.at(x, y)) continue;
            const int cx = std::clamp(static_cast<int>(place.at(x, y, 0)), 0, seen.width - 1);
            const int cy = std::clamp(static_cast<int>(place.at(x, y, 1)), 0, seen.height - 1);
            light.at(x, y) = std::max(seen.at(cx, cy), 0.0f);
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

/// A map that was photographed while everything was lit, for pictures that light the mock-up alone.
void leave_out_unlit(const Image8& mockup, ProjectorToCamera& map) {
    for (std::size_t i = 0; i < mockup.values.size(); ++i) {
        if (mockup.values[i]) continue;
        map.camera_px.values[2 * i] = std::numeric_limits<float>::quiet_NaN();
        map.camera_px.values[2 * i + 1] = std::numeric_limits<float>::quiet_NaN();
    }
}

}  // namespace

Image8 mockup_of(const CalibrationSettings& settings) {
    if (!settings.mockup.empty() || !settings.projector || !settings.product)
        return settings.mockup;
    return mockup_mask(settings.product->mesh, *settings.projector);
}

CaptureSeconds CalibrationResult::all_captured() const {
    if (!room) return captured;
    const CaptureSeconds& first = room->seen.captured;
    return {first.all + captured.all,
            first.camera + captured.camera,
            first.projector + captured.projector};
}

double CalibrationResult::all_solve_seconds() const {
    return solve_seconds + predict_seconds + (room ? room->solve_seconds : 0.0);
}

CalibrationResult calibrate_live(const BenchPorts& bench,
                                 CalibrationSettings settings,
                                 const Progress& progress) {
    check_argument(settings.shots >= 1 && settings.shots <= 1000,
                   "shots " + std::to_string(settings.shots) + " is outside 1..1000");
    // Photographs that were taken before are of what was lit then.
    const Image8 mockup = bench.turn_to ? Image8() : mockup_of(settings);
    check_argument(mockup.empty() || (mockup.width == settings.width &&
                                      mockup.height == settings.height && mockup.channels == 1),
                   "the mock-up's mask is not one channel of the projector's size");
    check_argument(!bench.turn_to || !bench.measure_xyz,
                   "a colorimeter reads what is shown now, these photographs were taken before");
    BenchPorts ports = bench;
    if (!mockup.empty() && ports.show) ports.show = shown_on(mockup, bench.show);
    CalibrationResult result;
    result.patterns =
        !settings.patterns.empty()
            ? settings.patterns
            : colour_patterns(
                  settings.width, settings.height, settings.dark_drive, settings.bright_drive);

    const auto start = std::chrono::steady_clock::now();
    const auto expected =
        (settings.map ? (bench.turn_to ? 0 : 2) : static_cast<int>(shown_for_places(settings))) +
        (bench.turn_to ? 0 : kToMeet) + static_cast<int>(result.patterns.size()) * settings.shots;
    Progress capturing = progress;
    if (progress.report)
        capturing.report = [&](double fraction, std::string_view stage) {
            progress.report(0.9 * fraction, stage);
        };
    BenchSession session(ports, capturing, expected);
    const bool fixed = session.fixed();
    if (!fixed) session.meet(settings.width, settings.height);
    LiveCalibration live(session, settings);
    std::vector<std::string> odd_map;
    const auto find_map = [&] {
        return map_of_captures(live.captures, settings.width, settings.height, odd_map);
    };
    if (!settings.map) {
        live.photograph_geometry();
    } else if (!fixed) {
        live.photograph_ends(false);  // the first colour picture is dark
    }
    if (!fixed) {  // it aims the colorimeter
        result.map = settings.map ? *settings.map : find_map();
        if (settings.map && !mockup.empty()) leave_out_unlit(mockup, result.map);
    }
    result.latency_photographs = session.latency();

    // The six pictures; the colorimeter reads each while it is known to be shown
    const bool measures = static_cast<bool>(ports.measure_xyz) &&
                          !settings.camera_to_xyz.has_primaries &&
                          settings.camera_to_xyz.origin.empty();
    const bool full_range = settings.dark_drive == 0 && settings.bright_drive == 255;
    CameraToXyz& xyz = settings.camera_to_xyz;
    if (measures) {
        xyz.has_primaries = true;
        xyz.measured_at_px = place_to_measure(result.map, live.light(), mockup);
    }
    const auto measure = [&](const std::string& role) {
        if (!measures) return;
        const auto value = [&] { return ports.measure_xyz(*xyz.measured_at_px); };
        if (role == "dark-gray") xyz.black_xyz = value();
        if (role == "bright-gray") xyz.white_xyz = value();
        if (role == "red") xyz.primaries_xyz[0] = value();
        if (role == "green") xyz.primaries_xyz[1] = value();
        if (role == "blue") xyz.primaries_xyz[2] = value();
    };
    const auto photograph = [&](const Pattern& pattern) {
        live.photograph(pattern, settings.shots);
        result.colour_photographs += settings.shots;
        if (full_range) measure(pattern.role);
    };
    for (const Pattern& pattern : result.patterns) photograph(pattern);

    if (measures && !full_range)
        for (const Pattern& pattern : colour_patterns(settings.width, settings.height, 0, 255)) {
            if (pattern.role == "gray-levels") break;
            session.take(
                pattern.drive, pattern.role + " for the colorimeter", pattern.role != "dark-gray");
            measure(pattern.role);
        }
    // Again at the end: what moved or changed on the way
    if (!fixed)
        for (const std::uint8_t drive : {std::uint8_t{255}, std::uint8_t{0}}) {
            const std::string role = drive ? "white" : "black";
            Photograph& end = drive ? result.white : result.black;
            end = session.take(Image8(settings.width, settings.height, 3, drive), role);
            live.add(role, end);
        }
    const auto judge_start = std::chrono::steady_clock::now();
    // Before anything is solved: the projector must not be blamed for a shadow.
    CaptureVerdict verdict = live.judge(fixed && !settings.map);
    if (fixed) result.map = settings.map ? *settings.map : find_map();
    verdict.warnings.insert(verdict.warnings.end(), odd_map.begin(), odd_map.end());
    const double judge_seconds = seconds_since(judge_start);

    // Is white the sum of the channels? If not, mosaics of colours
    if (settings.patterns.empty()) {
        const double additivity =
            pool_mixing(sample_colours(live.captures.colours, result.map)).additivity_error;
        if (additivity > kAdditivityWarning && settings.mode == ColourMode::robust)
            for (Pattern& pattern : mosaic_patterns(settings.width, settings.height, kMosaics)) {
                photograph(pattern);
                result.patterns.push_back(std::move(pattern));
            }
        if (additivity <= kAdditivityWarning) xyz.white_xyz.reset();  // only its noise
    }
    ports.show(Image8(settings.width, settings.height, 3));
    result.captured.all = seconds_since(start) - judge_seconds;

    const auto solve_start = std::chrono::steady_clock::now();
    Progress solving = progress;
    if (progress.report)
        solving.report = [&](double fraction, std::string_view stage) {
            progress.report(0.9 + 0.1 * fraction, stage);
        };
    result.calibration =
        calibrate_judged(live.captures, verdict, result.patterns, result.map, settings, solving);
    result.captures = std::move(live.captures.colours);
    result.kept = std::move(live.kept);
    if (fixed) result.colour_photographs = static_cast<int>(result.captures.size());
    if (session.latency() > 0) {
        result.calibration.warnings.push_back(
            "the projector's picture reaches the camera " + std::to_string(session.latency()) +
            (session.latency() == 1 ? " photograph" : " photographs") +
            " late; each was awaited; a game mode shortens it");
    }
    auto& warnings = result.calibration.warnings;
    warnings.insert(warnings.end(), settings.warnings.begin(), settings.warnings.end());
    result.solve_seconds = judge_seconds + seconds_since(solve_start);

    const auto predict_start = std::chrono::steady_clock::now();
    if (!settings.irradiance.empty())
        result.calibration = predict_hidden(std::move(result.calibration), settings.irradiance);
    result.predict_seconds = seconds_since(predict_start);
    seal(result.calibration);
    result.projector = std::move(settings.projector);
    result.irradiance = std::move(settings.irradiance);
    return result;
}

LiveMap photograph_map(const BenchPorts& bench,
                       const CalibrationSettings& settings,
                       const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const int expected = kToMeet + static_cast<int>(shown_for_places(settings));
    BenchSession session(bench, progress, expected);
    if (!session.fixed()) session.meet(settings.width, settings.height);
    LiveCalibration live(session, settings);
    live.photograph_geometry();
    if (session.fixed()) live.judge(true);
    bench.show(Image8(settings.width, settings.height, 3));
    LiveMap result;
    result.map = map_of_captures(live.captures, settings.width, settings.height, result.warnings);
    result.white = live.white();
    result.black = live.black();
    result.kept = std::move(live.kept);
    result.camera_width = live.captures.width;
    result.camera_height = live.captures.geometry.front().photograph.image.height;
    result.captured.all = seconds_since(start);
    return result;
}

}  // namespace livery
