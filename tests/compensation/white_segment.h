// A projector whose colour wheel has a clear segment: greys get light that no primary gives.
#pragma once

#include <algorithm>
#include <vector>

#include "compensation/synthetic.h"

namespace livery::synthetic {

/// The segment's light on top of the primaries', in units of theirs; 56% of white in the worst
/// channel, as much as has been measured on a real one.
inline const glm::dvec3 kSegment{0.9, 1.0, 1.25};

inline glm::dvec3 segment_light(const World& world, glm::dvec3 drive) {
    const glm::dvec3 p = world.light(drive);
    return p + kSegment * std::min({p.x, p.y, p.z});
}

inline glm::dvec3 segment_camera(const World& world, std::size_t pixel, glm::dvec3 drive) {
    return world.mixing[pixel] * segment_light(world, drive) + world.ambient[pixel];
}

inline ColourCalibration calibrate_segment(const World& world, int grid = 9) {
    ColourCalibration c = calibrate(world);
    const glm::dvec3 low = segment_light(world, glm::dvec3(0.0));
    const glm::dvec3 high = segment_light(world, glm::dvec3(255.0));
    for (std::size_t i = 0; i < world.mixing.size(); ++i) {
        if (!world.lit[i]) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const int j = static_cast<int>(k);
            const double scale = world.mixing[i][j][j];
            const glm::dmat3 vn = [&] {
                glm::dmat3 m = world.mixing[i];
                for (int column = 0; column < 3; ++column)
                    m[column] /= world.mixing[i][column][column];
                return m;
            }();
            c.span.values[3 * i + k] = static_cast<float>(scale * (high[j] - low[j]));
            c.dark.values[3 * i + k] =
                static_cast<float>(scale * low[j] + (glm::inverse(vn) * world.ambient[i])[j]);
        }
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const int j = static_cast<int>(k);
        std::vector<float>& curve = c.response[k].drive_from_n;
        for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
            const double n = static_cast<double>(i) / static_cast<double>(curve.size() - 1);
            double a = 0.0, b = 255.0;
            for (int step = 0; step < 50; ++step) {
                const double middle = 0.5 * (a + b);
                const double there =
                    (segment_light(world, glm::dvec3(middle))[j] - low[j]) / (high[j] - low[j]);
                (there < n ? a : b) = middle;
            }
            curve[i] = static_cast<float>(0.5 * (a + b));
        }
    }
    c.table.grid = grid;
    for (int b = 0; b < grid; ++b) {
        for (int g = 0; g < grid; ++g) {
            for (int r = 0; r < grid; ++r) {
                const glm::dvec3 drive = glm::dvec3(r, g, b) * (255.0 / (grid - 1));
                c.table.n_from_drive.push_back(
                    glm::vec3((segment_light(world, drive) - low) / (high - low)));
            }
        }
    }
    return c;
}

}  // namespace livery::synthetic
