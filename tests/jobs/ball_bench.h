// A mirror ball on the simulated stand, photographed and made a map of: the whole way of a room's
// light.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/image_io.h"
#include "core/json.h"
#include "jobs/environment/environment_measurement.h"
#include "jobs/simulated_captures.h"
#include "scene/look.h"
#include "support/temporary_folder.h"

namespace livery {

/// As the shipped bench's: 14 bit, shot and read noise.
inline CameraDescription noisy_ball_camera() {
    CameraDescription camera;
    camera.electrons_per_unit = 10.0;
    camera.read_noise_units = 4.0;
    return camera;
}

/// A room, Rec.709: pale walls that darken downward, one of them warm, a window, a strip and a
/// small bright lamp with soft edges.
inline glm::dvec3 room_rec709(const glm::dvec3& d) {
    const auto soft = [&](const glm::dvec3& toward, double radius_deg) {
        const double angle = std::acos(std::clamp(glm::dot(d, glm::normalize(toward)), -1.0, 1.0)) *
                             180.0 / std::numbers::pi;
        const double inside = std::clamp((1.1 * radius_deg - angle) / (0.2 * radius_deg), 0.0, 1.0);
        return inside * inside * (3.0 - 2.0 * inside);
    };
    glm::dvec3 light = glm::dvec3(0.30, 0.31, 0.33) * (1.0 + 0.6 * d.y);
    light += 0.2 * std::max(d.x, 0.0) * glm::dvec3(1.0, 0.5, 0.2);
    light += soft({-0.8, 0.3, 0.6}, 22.0) * glm::dvec3(5.0, 6.0, 7.5);
    light += soft({0.5, 0.9, -0.3}, 9.0) * glm::dvec3(30.0, 26.0, 20.0);
    light += soft({0.3, 0.2, -1.0}, 5.0) * glm::dvec3(60.0, 60.0, 55.0);
    return light;
}

/// The same for the stand.
inline LightFrom in_working(std::function<glm::dvec3(const glm::dvec3&)> rec709) {
    return [rec709](const glm::dvec3& d) { return working_from_rec709() * rec709(d); };
}

/// The irradiance of a surface, by a sum over 300 x 150 directions of its own hemisphere.
inline glm::dvec3 irradiance_of(const std::function<glm::dvec3(const glm::dvec3&)>& light,
                                const glm::dvec3& normal) {
    constexpr int kTurns = 300, kRings = 150;
    const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 t = glm::normalize(glm::cross(helper, normal)), b = glm::cross(normal, t);
    glm::dvec3 sum(0.0);
    for (int ring = 0; ring < kRings; ++ring) {
        // Even steps of sin^2: each sample then counts alike under the cosine.
        const double sine = std::sqrt((ring + 0.5) / kRings);
        const double cosine = std::sqrt(1.0 - sine * sine);
        for (int k = 0; k < kTurns; ++k) {
            const double turn = 2.0 * std::numbers::pi * (k + 0.5) / kTurns;
            sum += light(sine * (std::cos(turn) * t + std::sin(turn) * b) + cosine * normal);
        }
    }
    return sum * (std::numbers::pi / (kTurns * kRings));
}

/// What a map's file says of a direction, bilinear, by the convention that the documents tell.
inline std::function<glm::dvec3(const glm::dvec3&)> light_in(const ImageF& map) {
    return [&map](const glm::dvec3& d) {
        const double pi = std::numbers::pi;
        const double u = (std::atan2(d.x, -d.z) / (2.0 * pi) + 0.5) * map.width - 0.5;
        const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * map.height - 0.5;
        glm::dvec3 sum(0.0);
        for (int j = 0; j < 2; ++j) {
            for (int i = 0; i < 2; ++i) {
                const int x = static_cast<int>(std::floor(u)) + i;
                const int y = std::clamp(static_cast<int>(std::floor(v)) + j, 0, map.height - 1);
                const double weight = (i == 0 ? 1.0 - (u - std::floor(u)) : u - std::floor(u)) *
                                      (j == 0 ? 1.0 - (v - std::floor(v)) : v - std::floor(v));
                const float* value = map.pixel((x % map.width + map.width) % map.width, y);
                sum += weight * glm::dvec3(value[0], value[1], value[2]);
            }
        }
        return sum;
    };
}

/// Directions spread evenly over the sphere.
inline std::vector<glm::dvec3> even_directions(int count) {
    std::vector<glm::dvec3> directions;
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int k = 0; k < count; ++k) {
        const double y = 1.0 - (2.0 * k + 1.0) / count, r = std::sqrt(1.0 - y * y);
        directions.emplace_back(r * std::cos(golden_angle * k), y, r * std::sin(golden_angle * k));
    }
    return directions;
}

/// A folder of photographs of the ball; its manifest can be changed.
class BallBench {
  public:
    BallBench(int size_px,
              int cameras,
              const LightFrom& light_from,
              const std::function<void(SimulatedBallRequest&)>& change = {}) {
        SimulatedBallRequest request;
        request.stand = usual_mirror_ball_stand(noisy_ball_camera(), size_px, cameras);
        request.light_from = light_from;
        request.out = captures();
        request.samples_a_side = 3;
        if (change) change(request);
        stand = request.stand;
        photograph_ball(request);
        manifest = read_json_file(captures() / "manifest.json");
        manifest["fit_outline"] = false;  // unless a test is about it
        rewrite();
    }

    std::filesystem::path captures() const { return folder / "captures"; }
    std::filesystem::path out() const { return folder / "room.exr"; }
    void rewrite() const { write_json_file(captures() / "manifest.json", manifest); }
    EnvironmentRequest request(int width = 256) const {
        EnvironmentRequest request;
        request.captures = captures();
        request.out = out();
        request.width = width;
        request.scale = 1.0 / stand.units_per_s;
        return request;
    }
    EnvironmentMeasurement measure(int width = 256) const {
        return measure_environment(request(width));
    }
    ImageF map() const { return read_image(out()).image; }

    TemporaryFolder folder;
    MirrorBallStand stand;
    Json manifest;
};

}  // namespace livery
