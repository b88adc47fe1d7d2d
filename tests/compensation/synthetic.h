// A world that is known exactly: C = V p(I) + F at every pixel, and the calibration that a perfect
// measurement of it would give. Doubles throughout; shares nothing with src/compensation.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

#include "core/colour.h"
#include "core/random.h"
#include "scene/colour_calibration.h"

namespace livery::synthetic {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

/// Projector response: a power of the drive bent by an S-curve, p(0) = leak, p(255) = 1 + leak.
struct Response {
    double gamma = 2.2, bend = 0.15, leak = 0.0;
    double light(double drive) const {
        const double x = drive / 255.0;
        const double s = x - bend * std::sin(6.283185307179586 * x) / 6.283185307179586;
        return std::pow(s, gamma) + leak;
    }
};

struct World {
    int width = 0, height = 0;
    std::vector<glm::dmat3> mixing;   ///< V, columns: projector channels
    std::vector<glm::dvec3> ambient;  ///< F
    std::array<Response, 3> response;
    glm::dmat3 xyz_from_camera{1.0};
    std::vector<bool> lit;

    glm::dvec3 light(glm::dvec3 drive) const {
        return {response[0].light(drive.x), response[1].light(drive.y), response[2].light(drive.z)};
    }
    glm::dvec3 camera(std::size_t pixel, glm::dvec3 drive) const {
        return mixing[pixel] * light(drive) + ambient[pixel];
    }
    /// What has to be asked for so that `drive` is the answer.
    glm::dvec3 wanted(std::size_t pixel, glm::dvec3 drive, double white_y) const {
        return working_from_xyz() * (xyz_from_camera * camera(pixel, drive)) / white_y;
    }
};

/// A coloured surface under smooth shading: every pixel has its own mixing matrix.
inline World make_world(int width, int height, std::uint64_t seed, double ambient = 0.004) {
    World world;
    world.width = width;
    world.height = height;
    Random random(seed);
    world.response[0] = {2.1, 0.20, 0.0005};
    world.response[1] = {2.2, 0.15, 0.0005};
    world.response[2] = {2.4, 0.10, 0.0005};
    // Primaries near Rec.709 as a camera with overlapping channels sees them.
    const glm::dmat3 camera_from_709 =
        glm::transpose(glm::dmat3(0.80, 0.18, 0.04, 0.15, 0.90, 0.12, 0.03, 0.20, 0.85));
    world.xyz_from_camera =
        glm::inverse(working_from_xyz()) * working_from_rec709() * glm::inverse(camera_from_709);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const double shade = 0.35 + 0.6 * std::sin(3.1 * u) * std::sin(3.1 * v);
            glm::dmat3 v_matrix = camera_from_709 * shade;
            for (int c = 0; c < 3; ++c) {
                for (int r = 0; r < 3; ++r) v_matrix[c][r] *= 1.0 + 0.1 * (random.uniform() - 0.5);
            }
            world.mixing.push_back(v_matrix);
            world.ambient.push_back(glm::dvec3(1.0, 0.95, 0.9) * ambient);
            world.lit.push_back(true);
        }
    }
    return world;
}

inline std::vector<float> inverse_samples(const Response& response, double s, double t, int count) {
    std::vector<float> curve;
    const double low = response.light(s), high = response.light(t);
    for (int i = 0; i < count; ++i) {
        const double n = static_cast<double>(i) / (count - 1);
        double a = s, b = t;
        for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (a + b);
            ((response.light(middle) - low) / (high - low) < n ? a : b) = middle;
        }
        curve.push_back(static_cast<float>(i == 0 ? s : i == count - 1 ? t : 0.5 * (a + b)));
    }
    return curve;
}

inline ColourCalibration calibrate(const World& world,
                                   double s = 0.0,
                                   double t = 255.0,
                                   int samples = 1024) {
    ColourCalibration c;
    c.width = world.width;
    c.height = world.height;
    c.id = "synthetic";
    c.dark_drive = s;
    c.bright_drive = t;
    c.unmixing = ImageF(world.width, world.height, 9);
    c.dark = ImageF(world.width, world.height, 3);
    c.span = ImageF(world.width, world.height, 3);
    c.status = Image8(world.width, world.height, 1);
    c.xyz_from_camera = world.xyz_from_camera;
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        if (!world.lit[i]) continue;
        glm::dmat3 vn = world.mixing[i];
        for (int k = 0; k < 3; ++k) vn[k] /= world.mixing[i][k][k];
        const glm::dmat3 unmixing = glm::inverse(vn);
        const glm::dvec3 dark = unmixing * world.camera(i, glm::dvec3(s));
        const glm::dvec3 span = unmixing * world.camera(i, glm::dvec3(t)) - dark;
        for (int r = 0; r < 3; ++r) {
            const auto row = static_cast<std::size_t>(r);
            for (std::size_t k = 0; k < 3; ++k) {
                c.unmixing.values[9 * i + 3 * row + k] =
                    static_cast<float>(unmixing[static_cast<int>(k)][r]);
            }
            c.dark.values[3 * i + row] = static_cast<float>(dark[r]);
            c.span.values[3 * i + row] = static_cast<float>(span[r]);
        }
        c.status.values[i] =
            static_cast<std::uint8_t>(i % 17 == 0 ? PixelStatus::predicted : PixelStatus::measured);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        c.response[k].drive_from_n = inverse_samples(world.response[k], s, t, samples);
    }
    return c;
}

/// Calls make(pixel) for every pixel; coverage 1.
template <typename F>
ImageF picture(const World& world, F&& make) {
    ImageF image(world.width, world.height, 4, 1.0f);
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        const glm::dvec3 colour = make(i);
        for (std::size_t k = 0; k < 3; ++k) {
            image.values[4 * i + k] = static_cast<float>(colour[static_cast<int>(k)]);
        }
    }
    return image;
}

inline glm::dvec3 random_drive(Random& random, double low, double high) {
    return {low + (high - low) * random.uniform(),
            low + (high - low) * random.uniform(),
            low + (high - low) * random.uniform()};
}

}  // namespace livery::synthetic
