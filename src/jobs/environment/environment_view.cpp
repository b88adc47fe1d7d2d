#include "jobs/environment/environment_view.h"

#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calibration/environment/ball_outline.h"
#include "calibration/environment/mirror_ball.h"
#include "calibration/environment/panorama.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/merged_captures.h"
#include "jobs/sphere_window.h"

namespace livery {

namespace {

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

}  // namespace

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

}  // namespace livery
