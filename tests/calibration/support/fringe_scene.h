// A flat mock-up under patterns of one axis each, in closed form: blur, light from elsewhere,
// noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/random.h"

namespace livery::testing {

struct FringeScene {
    int projector_width = 240, projector_height = 176;
    int camera_width = 300, camera_height = 220;
    std::function<glm::dvec2(glm::dvec2)> projector_from_camera = [](glm::dvec2 c) {
        return glm::dvec2(0.77 * c.x + 0.031 * c.y + 1.7, -0.023 * c.x + 0.74 * c.y + 8.3);
    };
    double gamma = 2.2;
    double blur_px = 0.7;  ///< standard deviation, projector pixels: a lens in focus
    /// Light straight from the projector, and what other parts send under full white.
    std::function<double(glm::dvec2 camera_px)> direct = [](glm::dvec2) { return 1.0; };
    std::function<double(glm::dvec2 camera_px)> global = [](glm::dvec2) { return 0.0; };
    double white_level = 12000.0, black_level = 256.0;  ///< file units, of direct light 1
    double saturates_at = 16383.0;
    double read_noise = 0.0, electrons_per_unit = 0.0;
    Random random{11};

    /// A pattern of one axis as linear light along it, blurred; a uniform one along x.
    std::vector<double> light_along(const Pattern& pattern, bool rows) const {
        const int count = rows ? projector_height : projector_width;
        const auto light_at = [&](int k) {
            const int at = std::clamp(k, 0, count - 1);
            const std::uint8_t drive = *pattern.drive.pixel(rows ? 0 : at, rows ? at : 0);
            return std::pow(drive / 255.0, gamma);
        };
        // A projector pixel is a square; values every quarter of one.
        std::vector<double> light(static_cast<std::size_t>(4 * count));
        const int reach = static_cast<int>(std::ceil(4.0 * blur_px)) + 1;
        for (int k = 0; k < 4 * count; ++k) {
            const double place = (k + 0.5) / 4.0;
            const int middle = static_cast<int>(place);
            double sum = 0.0;
            for (int j = middle - reach; j <= middle + reach; ++j) {
                const auto edge = [&](double at) {
                    return 0.5 * std::erf((at - place) / (std::sqrt(2.0) * blur_px));
                };
                sum += light_at(j) * (edge(j + 1.0) - edge(j));
            }
            light[static_cast<std::size_t>(k)] = sum;
        }
        return light;
    }

    Photograph photograph(const Pattern& pattern) {
        const bool rows = pattern.role.find("-row-") != std::string::npos;
        const std::vector<double> light = light_along(pattern, rows);
        double mean = 0.0;
        for (const double one : light) mean += one / static_cast<double>(light.size());
        Photograph photo;
        photo.image = ImageF(camera_width, camera_height, 1);
        photo.exposure_s = 0.1;
        photo.black_level = black_level;
        photo.saturates_at = saturates_at;
        photo.name = pattern.role;
        for (int y = 0; y < camera_height; ++y)
            for (int x = 0; x < camera_width; ++x) {
                const glm::dvec2 camera(x + 0.5, y + 0.5);
                const glm::dvec2 place = projector_from_camera(camera);
                double seen = 0.0;
                if (place.x > 0 && place.y > 0 && place.x < projector_width &&
                    place.y < projector_height) {
                    const double at = 4.0 * (rows ? place.y : place.x) - 0.5;
                    const auto last = static_cast<double>(light.size() - 1);
                    const double within = std::clamp(at, 0.0, last - 1e-9);
                    const auto k = static_cast<std::size_t>(within);
                    const double part = within - static_cast<double>(k);
                    seen = direct(camera) * (light[k] + part * (light[k + 1] - light[k])) +
                           global(camera) * mean;
                }
                double value = white_level * seen;
                if (electrons_per_unit > 0.0)
                    value += std::sqrt(std::max(value, 0.0) / electrons_per_unit) * random.normal();
                if (read_noise > 0.0) value += read_noise * random.normal();
                photo.image.at(x, y) =
                    static_cast<float>(std::min(value + black_level, saturates_at));
            }
        return photo;
    }

    std::vector<RoledPhotograph> photographs(PlaceCode code) {
        std::vector<RoledPhotograph> all;
        const auto roles = place_roles(code, projector_width, projector_height);
        for (std::size_t k = 0; k < roles.size(); ++k)
            all.push_back(
                {roles[k], photograph(place_pattern(code, projector_width, projector_height, k))});
        return all;
    }
};

}  // namespace livery::testing
