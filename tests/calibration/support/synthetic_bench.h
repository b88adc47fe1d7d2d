// A projector, a surface and a camera in closed form: what calibration tests photograph.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/bench_ports.h"
#include "core/random.h"

namespace livery::testing {

struct SyntheticBench {
    int projector_width = 320, projector_height = 200;
    int camera_width = 420, camera_height = 280;

    /// Where a camera point lands in the projector; nothing: it sees nothing lit.
    std::function<std::optional<glm::dvec2>(glm::dvec2 camera_px)> projector_from_camera =
        [](glm::dvec2 c) -> std::optional<glm::dvec2> {
        return glm::dvec2(0.78 * c.x + 0.03 * c.y - 4.3, -0.02 * c.x + 0.74 * c.y - 1.7);
    };
    int sub_samples = 1;  ///< a side, over a camera pixel

    /// Column: projector channel; row: camera channel. Linear camera colour of full drive, per
    /// second, on the surface where `scale` is 1.
    glm::dmat3 mixing = glm::dmat3(0.80, 0.10, 0.02, 0.14, 0.90, 0.12, 0.03, 0.16, 0.70);
    std::function<double(glm::dvec2 projector_px)> scale = [](glm::dvec2) { return 1.0; };
    /// Reflectance in camera channels: 1 for a neutral mock-up.
    std::function<glm::dvec3(glm::dvec2 projector_px)> tint = [](glm::dvec2) {
        return glm::dvec3(1.0);
    };
    glm::dvec3 gamma{2.2, 2.0, 2.4};
    double leak = 0.0;           ///< of each channel at drive 0
    double white_segment = 0.0;  ///< light added, as a share of all three, at full min(R, G, B)
    glm::dvec3 ambient{0.0};     ///< linear camera colour per second on scale 1

    double full_scale = 16000.0;        ///< file units at clipping, above black_level
    double file_units_per_light = 0.0;  ///< 0: chosen so that full white is 80% of full scale
    double black_level = 256.0;
    double exposure_s = 0.1;
    double read_noise = 0.0;          ///< file units
    double electrons_per_unit = 0.0;  ///< shot noise where positive
    bool quantised = false;
    Random random{1};
    double lamp = 1.0;

    glm::dvec3 response(glm::dvec3 drive) const {
        glm::dvec3 light;
        for (int k = 0; k < 3; ++k)
            light[k] = leak + (1.0 - leak) * std::pow(drive[k] / 255.0, gamma[k]);
        return light;
    }
    /// Linear camera colour per second of one drive at one place, before the camera's own scale.
    glm::dvec3 light(glm::dvec3 drive, glm::dvec2 projector_px) const {
        return light_of(response(drive), projector_px);
    }
    /// The same in the camera's units: (file value - black level) / exposure.
    glm::dvec3 camera_colour(glm::dvec3 drive, glm::dvec2 projector_px) const {
        return units_per_light() * light(drive, projector_px);
    }
    glm::dvec3 light_of(glm::dvec3 p, glm::dvec2 projector_px) const {
        const double white = white_segment * std::min({p.x, p.y, p.z});
        return (lamp * (mixing * (p + glm::dvec3(white))) + ambient) * scale(projector_px) *
               tint(projector_px);
    }
    double units_per_light() const {
        if (file_units_per_light > 0.0) return file_units_per_light;
        const glm::dvec3 white = mixing * glm::dvec3(1.0 + white_segment) + ambient;
        return 0.8 * full_scale / (exposure_s * std::max({white.x, white.y, white.z}));
    }

    Photograph photograph(const Image8& drive, const std::string& name = "") {
        Photograph photo;
        photo.image = ImageF(camera_width, camera_height, 3);
        photo.exposure_s = exposure_s;
        photo.black_level = black_level;
        photo.saturates_at = black_level + full_scale;
        photo.name = name;
        const double gain = units_per_light() * exposure_s;
        std::array<glm::dvec3, 256> response_of;
        for (std::size_t i = 0; i < 256; ++i)
            response_of[i] = response(glm::dvec3(static_cast<double>(i)));
        for (int y = 0; y < camera_height; ++y)
            for (int x = 0; x < camera_width; ++x) {
                glm::dvec3 sum(0.0);
                for (int j = 0; j < sub_samples; ++j)
                    for (int i = 0; i < sub_samples; ++i) {
                        const auto p = projector_from_camera(
                            {x + (i + 0.5) / sub_samples, y + (j + 0.5) / sub_samples});
                        if (!p || p->x < 0 || p->y < 0 || p->x >= projector_width ||
                            p->y >= projector_height)
                            continue;
                        const std::uint8_t* const d =
                            drive.pixel(static_cast<int>(p->x), static_cast<int>(p->y));
                        sum += light_of(
                            {response_of[d[0]].x, response_of[d[1]].y, response_of[d[2]].z}, *p);
                    }
                sum /= sub_samples * sub_samples;
                for (int c = 0; c < 3; ++c) {
                    double value = sum[c] * gain;
                    if (electrons_per_unit > 0.0)
                        value +=
                            std::sqrt(std::max(value, 0.0) / electrons_per_unit) * random.normal();
                    value += read_noise > 0.0 ? read_noise * random.normal() : 0.0;
                    value = std::min(value, full_scale) + black_level;
                    if (quantised) value = std::round(std::max(value, 0.0));
                    photo.image.at(x, y, c) = static_cast<float>(value);
                }
            }
        return photo;
    }

    /// What the robust method calls N: light of a channel over full light, black taken off.
    double n_of(int channel, double drive) const { return std::pow(drive / 255.0, gamma[channel]); }

    std::vector<RoledPhotograph> photograph_all(const std::vector<Pattern>& patterns,
                                                int shots = 1) {
        std::vector<RoledPhotograph> captures;
        for (const Pattern& pattern : patterns)
            for (int shot = 0; shot < shots; ++shot)
                captures.push_back({pattern.role, photograph(pattern.drive, pattern.role)});
        return captures;
    }

    /// The map without measurement: inverse of an affine `projector_from_camera`.
    ProjectorToCamera exact_map() const {
        const glm::dvec2 origin = *projector_from_camera({0.0, 0.0});
        const glm::dvec2 ex = *projector_from_camera({1.0, 0.0}) - origin;
        const glm::dvec2 ey = *projector_from_camera({0.0, 1.0}) - origin;
        const double determinant = ex.x * ey.y - ex.y * ey.x;
        ProjectorToCamera map;
        map.camera_px =
            ImageF(projector_width, projector_height, 2, std::numeric_limits<float>::quiet_NaN());
        map.edge = Image8(projector_width, projector_height, 1);
        for (int y = 0; y < projector_height; ++y)
            for (int x = 0; x < projector_width; ++x) {
                const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - origin;
                const glm::dvec2 c((d.x * ey.y - d.y * ey.x) / determinant,
                                   (ex.x * d.y - ex.y * d.x) / determinant);
                if (x < 2 || y < 2 || x + 2 >= projector_width || y + 2 >= projector_height ||
                    c.x < 1 || c.y < 1 || c.x > camera_width - 1 || c.y > camera_height - 1)
                    continue;
                map.camera_px.at(x, y, 0) = static_cast<float>(c.x);
                map.camera_px.at(x, y, 1) = static_cast<float>(c.y);
            }
        return map;
    }
};

}  // namespace livery::testing
