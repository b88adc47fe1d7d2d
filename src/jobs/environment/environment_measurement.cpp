#include "jobs/environment/environment_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calibration/environment/light_picture.h"
#include "calibration/environment/mirror_ball.h"
#include "calibration/settings.h"
#include "capture/stand_folders.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/merged_captures.h"

namespace livery {

namespace {

struct ViewOfEnvironment {
    EnvironmentView figures;
    RadianceMap map;  ///< in the camera's colours
    double marks_residual_rad = 0.0;
};

/// How photographs become a map, the same for all of a folder's views.
struct EnvironmentReading {
    std::filesystem::path manifest;
    glm::dvec3 reflectance{1.0};
    bool fresnel = true;
    int width = 1024;
};

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kMostBallAcross_px = 2000.0;  ///< a larger ball's pixels are averaged in blocks
constexpr double kClickedRms_px = 5.0;         ///< of points of the outline that somebody named

/// The window of a mask's picture, as photographs have it; as large as they are.
Image8 read_mask(const std::filesystem::path& file,
                 int width,
                 int height,
                 const PictureWindow& window) {
    Image8 result(window.width, window.height, 1, 0);
    if (file.empty()) return result;
    const ImageFile mask = read_image(file);
    if (mask.image.width != width || mask.image.height != height) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", mask.image.width, mask.image.height),
                        fmt::format("the photographs' {}x{}", width, height));
    }
    const auto half = static_cast<float>(0.5 * mask.full_scale);
    for (int y = 0; y < window.height * window.block; ++y) {
        for (int x = 0; x < window.width * window.block; ++x) {
            // What is no number counts as left out, too.
            if (mask.image.at(window.left + x, window.top + y) < half) continue;
            result.at(x / window.block, y / window.block) = 1;
        }
    }
    return result;
}

/// Merges photographs as those of painted spheres are.
LightPicture merged_light(const std::vector<Capture>& captures,
                          const PictureWindow& window,
                          const Progress& progress,
                          const std::function<Photograph(const Capture&)>& load) {
    const MergedCaptures merged = merge_captures(
        captures, [&](const Capture& one) { return windowed(load(one), window); }, progress);
    if (merged.all_saturated()) {
        throw Refused("every pixel is saturated in every photograph",
                      "add photographs with a shorter exposure");
    }
    return light_of(merged.picture, glm::dvec3(merged.clipped_light));
}

/// Where the manifest says that the ball stands: at its place, or by points of its outline.
Sphere start_of(const BallView& ball, const View& camera, EnvironmentView& figures) {
    if (ball.outline_px.empty()) return {*ball.centre_mm, ball.diameter_mm};
    figures.outline = fit_outline_points(camera, ball.outline_px, ball.diameter_mm, kClickedRms_px);
    return figures.outline->sphere;
}

void check_before_camera(const BallView& ball,
                         const View& camera,
                         const Sphere& sphere,
                         const std::filesystem::path& manifest) {
    const double distance = glm::distance(centre_in_world(camera), sphere.centre_mm);
    if (distance > 0.5 * sphere.diameter_mm) return;
    throw FileError(manifest,
                    ball.field + "sphere",
                    fmt::format("a camera inside the ball, {:.1f} mm from its middle", distance),
                    "a ball before the camera");
}

/// Of a ball. Throws FileError, Refused, Cancelled.
ViewOfEnvironment view_of_ball(const BallView& ball,
                               const EnvironmentReading& reading,
                               const Progress& progress) {
    const View camera = parse_camera(ball.camera, ball.camera_origin);
    ViewOfEnvironment result;
    EnvironmentView& figures = result.figures;
    figures.photographs = ball.captures.size();
    Sphere sphere = start_of(ball, camera, figures);
    check_before_camera(ball, camera, sphere, reading.manifest);

    const SphereWindow window = window_around(camera, sphere, kMostBallAcross_px, reading.manifest);
    LightPicture picture = merged_light(
        ball.captures, window.pixels, progress.part(0.0, 0.5), [&](const Capture& one) {
            return load_photograph_of(one, camera);
        });
    if (ball.fit_outline) {
        figures.outline = find_ball_outline(window.view, picture, sphere);
        sphere = figures.outline->sphere;
    }
    picture.left_out = read_mask(ball.mask, camera.width, camera.height, window.pixels);
    if (figures.outline && ball.centre_mm) {
        figures.correction_mm = glm::distance(sphere.centre_mm, *ball.centre_mm);
    }
    figures.ball = sphere;
    figures.hidden_rad = hidden_behind_rad(window.view, sphere);

    const MirrorBall mirror{
        sphere, reading.reflectance, reading.fresnel, kRadians * ball.camera_deg};
    progress.update(0.5, "looking around in the ball");
    result.map = gather(picture, seen_in_ball(window.view, mirror), false, reading.width, progress);
    figures.coverage = coverage_of(result.map);
    return result;
}

/// Of a panorama. Throws FileError, Refused, Cancelled.
ViewOfEnvironment view_of_panorama(const PanoramaPictures& panorama,
                                   const EnvironmentReading& reading,
                                   const Progress& progress) {
    PictureWindow window;
    const auto load = [&](const Capture& capture) {
        Photograph photograph = load_photograph(capture);
        const ImageF& image = photograph.image;
        if (window.width == 0) {
            window.width = image.width;
            window.height = image.height;
        }
        if (image.width != 2 * image.height || image.width != window.width) {
            throw FileError(
                capture.file,
                "size",
                fmt::format("{}x{}", image.width, image.height),
                image.width == 2 * image.height
                    ? fmt::format("the first panorama's {}x{}", window.width, window.height)
                    : "twice as wide as high (latitude-longitude)");
        }
        return photograph;
    };
    ViewOfEnvironment result;
    result.figures.photographs = panorama.captures.size();
    LightPicture picture = merged_light(panorama.captures, window, progress.part(0.0, 0.5), load);
    const int width = picture.light.width, height = picture.light.height;
    picture.left_out = read_mask(panorama.mask, width, height, window);

    glm::dmat3 turn = world_from_panorama(
        kRadians * panorama.yaw_deg, kRadians * panorama.pitch_deg, kRadians * panorama.roll_deg);
    if (panorama.marks) {
        const auto& [first, second] = *panorama.marks;
        const PanoramaOrientation found = orientation_of(
            {first.pixel, first.direction}, {second.pixel, second.direction}, width, height);
        turn = found.world_from_panorama;
        result.marks_residual_rad = found.residual_rad;
    }
    progress.update(0.5, "turning the panorama");
    result.map =
        gather(picture, seen_in_panorama(turn, width, height), true, reading.width, progress);
    result.figures.coverage = coverage_of(result.map);
    return result;
}

constexpr double kPi = std::numbers::pi;
constexpr int kNarrowest = 16, kWidest = 8192;
constexpr double kNotedMapCorrection = 0.02, kNotedFill = 0.1, kNotedCut = 0.01;
constexpr double kNotedResidual_rad = kPi / 180.0;

void check_name(const std::string& option, const std::filesystem::path& file) {
    if (file.extension() == ".exr") return;
    throw std::invalid_argument(
        fmt::format("{}: found \"{}\", expected a name that ends in .exr", option, file.string()));
}

void check_request(const EnvironmentRequest& request) {
    check_name("--out", request.out);
    if (!request.mask.empty()) check_name("--mask", request.mask);
    if (request.width < kNarrowest || request.width > kWidest || request.width % 2 != 0) {
        throw std::invalid_argument(
            fmt::format("--width: found {}, expected an even number from "
                        "{} to {}",
                        request.width,
                        kNarrowest,
                        kWidest));
    }
    if (request.scale && !(*request.scale > 0.0 && *request.scale <= 1e9)) {
        throw std::invalid_argument(
            fmt::format("--scale: found {}, expected a number above 0", *request.scale));
    }
    if (!request.reflectance) return;
    for (int c = 0; c < 3; ++c) {
        const double share = (*request.reflectance)[c];
        if (!(share >= 0.02 && share <= 1.0)) {
            throw std::invalid_argument(
                fmt::format("--ball-reflectance: found {}, expected shares from 0.02 to 1", share));
        }
    }
}

/// Light is not negative: what noise and the matrix leave below 0 goes. Gives its share.
double to_rec709(const glm::dmat3& rec709_from_camera, ImageF& radiance) {
    double cut = 0.0, kept = 0.0;
    for (int y = 0; y < radiance.height; ++y) {
        const double sr = texel_sr(radiance, y);
        for (int x = 0; x < radiance.width; ++x) {
            float* value = radiance.pixel(x, y);
            const glm::dvec3 rec709 = rec709_from_camera * glm::dvec3(value[0], value[1], value[2]);
            for (int c = 0; c < 3; ++c) {
                (rec709[c] < 0.0 ? cut : kept) += sr * std::abs(rec709[c]);
                value[c] = static_cast<float>(std::max(rec709[c], 0.0));
            }
        }
    }
    return kept > 0.0 ? cut / kept : 0.0;
}

double mean_luminance(const ImageF& radiance) {
    const glm::dmat3& xyz = xyz_from_rec709();
    double sum = 0.0;
    for (int y = 0; y < radiance.height; ++y) {
        const double share = texel_sr(radiance, y) / (4.0 * kPi);
        for (int x = 0; x < radiance.width; ++x) {
            const float* value = radiance.pixel(x, y);
            for (int c = 0; c < 3; ++c) sum += share * xyz[c].y * static_cast<double>(value[c]);
        }
    }
    return sum;
}

/// "azimuth 30, 45 up": from the map's middle column (-z) to the right.
std::string words_of(const glm::dvec3& direction) {
    const double azimuth = 180.0 / kPi * std::atan2(direction.x, -direction.z);
    const double up = 180.0 / kPi * std::asin(std::clamp(direction.y, -1.0, 1.0));
    return fmt::format(
        "azimuth {:.0f}, {:.0f} degrees {}", azimuth, std::abs(up), up < 0.0 ? "down" : "up");
}

void tell_views(EnvironmentMeasurement& report) {
    for (std::size_t k = 0; k < report.views.size(); ++k) {
        const EnvironmentView& view = report.views[k];
        if (view.photographs == 1) {
            report.notes.push_back(fmt::format(
                "view {} has one exposure: what is dark is noisy in it, what is bright is clipped",
                k + 1));
        }
        if (view.ball && view.correction_mm &&
            *view.correction_mm > kNotedMapCorrection * view.ball->diameter_mm) {
            report.notes.push_back(
                fmt::format("view {}: the outline puts the ball {:.1f} mm from the manifest's "
                            "place, and was taken",
                            k + 1,
                            *view.correction_mm));
        }
    }
    if (report.marks_residual_rad > kNotedResidual_rad) {
        report.notes.push_back(fmt::format(
            "the marks lie {:.1f} degrees nearer or farther from one another than their directions",
            180.0 / kPi * report.marks_residual_rad));
    }
}

void tell_doubts(double cut, EnvironmentMeasurement& report) {
    tell_views(report);
    constexpr std::size_t kNamed = 5;
    for (std::size_t k = 0; k < std::min(report.clipped.size(), kNamed); ++k) {
        const ClippedLamp& lamp = report.clipped[k];
        report.notes.push_back(fmt::format(
            "the light at {} is clipped in the shortest exposure: it is brighter than the map "
            "says, and a surface that faces it gets {:.1f}% more light for each time that it is as "
            "bright again",
            words_of(lamp.direction),
            100.0 * lamp.irradiance_share));
    }
    if (report.clipped.size() > kNamed) {
        report.notes.push_back(
            fmt::format("{} more lights are clipped", report.clipped.size() - kNamed));
    }
    if (report.filled > kNotedFill) {
        report.notes.push_back(
            fmt::format("{:.0f}% of all directions are filled from their surroundings: photograph "
                        "the ball from another side too",
                        100.0 * report.filled));
    }
    if (cut > kNotedCut) {
        report.notes.push_back(
            fmt::format("{:.1f}% of the light is negative in Rec.709 and was left out: check the "
                        "black level and the camera's matrix",
                        100.0 * cut));
    }
}

/// What was seen of each texel, how finely, and what of it is clipped.
void write_mask(const std::filesystem::path& file, const RadianceMap& map) {
    ImageF mask(map.seen.width, map.seen.height, 3);
    for (std::size_t k = 0; k < map.seen.values.size(); ++k) {
        const float widest = map.widest_rad.values[k];
        mask.values[3 * k] = map.seen.values[k];
        mask.values[3 * k + 1] = widest > 0.0f ? static_cast<float>(180.0 / kPi) * widest
                                               : std::numeric_limits<float>::quiet_NaN();
        mask.values[3 * k + 2] = map.saturated.values[k];
    }
    write_exr(file, mask, {"mask.seen", "mask.pixel_deg", "mask.saturated"});
}

}  // namespace

EnvironmentMeasurement measure_environment(const EnvironmentRequest& request,
                                           const Progress& progress) {
    check_request(request);
    const EnvironmentFolder folder = read_environment_folder(request.captures);
    const CameraToXyz camera =
        camera_matrix(request.camera_to_xyz.empty() ? folder.camera_to_xyz : request.camera_to_xyz);
    if (request.reflectance && folder.views.empty()) {
        throw std::invalid_argument(
            "--ball-reflectance: found with a panorama, expected a ball's photographs");
    }
    EnvironmentReading reading;
    reading.manifest = folder.manifest;
    reading.reflectance = request.reflectance.value_or(folder.reflectance);
    reading.fresnel = folder.fresnel;
    reading.width = request.width;

    EnvironmentMeasurement report;
    report.camera_colours = camera.origin;
    report.reflectance = reading.reflectance;
    std::vector<RadianceMap> maps;
    const auto keep = [&](ViewOfEnvironment view) {
        report.views.push_back(view.figures);
        report.marks_residual_rad = view.marks_residual_rad;
        maps.push_back(std::move(view.map));
    };
    for (std::size_t k = 0; k < folder.views.size(); ++k) {
        const auto views = static_cast<double>(folder.views.size());
        keep(view_of_ball(folder.views[k],
                          reading,
                          progress.part(0.9 * static_cast<double>(k) / views,
                                        0.9 * static_cast<double>(k + 1) / views)));
    }
    if (folder.views.empty()) {
        keep(view_of_panorama(folder.panorama, reading, progress.part(0.0, 0.9)));
    }
    report.map = merge(maps);
    RadianceMap& map = report.map;
    const auto seen = std::count_if(
        map.seen.values.begin(), map.seen.values.end(), [](float one) { return one > 0.0f; });
    report.saturated_texels = static_cast<std::size_t>(
        std::count_if(map.saturated.values.begin(), map.saturated.values.end(), [](float one) {
            return one > 0.0f;
        }));
    if (seen > 0 && report.saturated_texels == static_cast<std::size_t>(seen)) {
        throw Refused("every direction's light is saturated in every photograph",
                      "add photographs with a shorter exposure");
    }
    progress.update(0.9, "filling what no photograph shows");
    report.coverage = coverage_of(map);
    const double cut = to_rec709(rec709_from_xyz() * camera.xyz_from_camera, map.radiance);
    report.filled = fill_unseen(map);

    const double white = brightest_white(map.radiance);
    if (!(white > 0.0)) {
        throw Refused("the photographs show no light",
                      "check their exposures and black_level in manifest.json");
    }
    report.scale = request.scale.value_or(1.0 / white);
    for (float& value : map.radiance.values) {
        value = static_cast<float>(static_cast<double>(value) * report.scale);
    }
    report.clipped = clipped_lamps(map);
    report.dynamic_range_stops = dynamic_range_stops(map);
    report.mean_luminance = mean_luminance(map.radiance);
    tell_doubts(cut, report);

    progress.check_stop();
    write_exr(request.out, map.radiance);
    if (!request.mask.empty()) write_mask(request.mask, map);
    return report;
}

}  // namespace livery
