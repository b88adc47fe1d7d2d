#include "twin/mishaps.h"

#include <algorithm>
#include <cmath>

#include "twin/sensor.h"

namespace livery {

namespace {

bool holds(const MishapDescription& mishap, std::uint32_t photograph) {
    const auto number = static_cast<int>(photograph);
    return number >= mishap.from && number <= mishap.to;
}

/// A soft shadow a quarter of the picture wide, a little left of its middle.
void shade(ImageF& light, double depth) {
    for (int y = 0; y < light.height; ++y) {
        for (int x = 0; x < light.width; ++x) {
            const double dx = ((x + 0.5) / light.width - 0.45) / 0.13,
                         dy = ((y + 0.5) / light.height - 0.5) / 0.3;
            const double inside = 1.0 / (1.0 + std::exp((std::hypot(dx, dy) - 1.0) * 12.0));
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) *= static_cast<float>(1.0 - depth * inside);
            }
        }
    }
}

}  // namespace

bool has_room_light(const std::vector<MishapDescription>& mishaps) {
    return std::any_of(mishaps.begin(), mishaps.end(), [](const MishapDescription& mishap) {
        return mishap.kind == MishapKind::room_light;
    });
}

ImageF with_mishaps(ImageF units_per_s,
                    const ImageF& room_light,
                    const std::vector<MishapDescription>& mishaps,
                    std::uint32_t photograph) {
    for (const MishapDescription& mishap : mishaps) {
        if (!holds(mishap, photograph)) continue;
        if (mishap.kind == MishapKind::shadow) shade(units_per_s, mishap.size);
        if (mishap.kind == MishapKind::camera_moved) {
            units_per_s = moved(units_per_s, 0.8 * mishap.size, 0.6 * mishap.size);
        }
        if (mishap.kind == MishapKind::room_light) {
            for (std::size_t k = 0; k < room_light.values.size(); ++k) {
                units_per_s.values[k] += static_cast<float>(mishap.size) * room_light.values[k];
            }
        }
    }
    return units_per_s;
}

double true_exposure_s(double exposure_s,
                       const CameraDescription& camera,
                       const ImageF& units_per_s,
                       const std::vector<MishapDescription>& mishaps,
                       std::uint32_t photograph) {
    for (const MishapDescription& mishap : mishaps) {
        if (!holds(mishap, photograph)) continue;
        if (mishap.kind == MishapKind::exposure) exposure_s *= mishap.size;
        if (mishap.kind == MishapKind::automatic_exposure) {
            double sum = 0.0;
            for (const float value : units_per_s.values) sum += static_cast<double>(value);
            const double mean = sum / static_cast<double>(units_per_s.values.size());
            const double wanted = mishap.size * (saturates_at(camera) - black_level(camera));
            // No camera opens for longer than a minute of darkness.
            exposure_s = std::min(wanted / std::max(mean, 1e-9), 60.0);
        }
    }
    return exposure_s;
}

}  // namespace livery
