// docs/images/sphere-captures.png: a sphere on the simulated stand under some of its lamps, with a
// long and a short exposure, and the white one. Takes the picture's name.

#include <algorithm>
#include <cstdio>
#include <exception>

#include <glm/matrix.hpp>

#include "appearance/material_library.h"
#include "core/colour.h"
#include "core/image_io.h"
#include "jobs/picture_tool.h"
#include "twin/sensor.h"
#include "twin/sphere_stand.h"

namespace livery {
namespace {

constexpr int kSize = 132;
constexpr double kLong_s = 0.7, kShort_s = 0.05;  ///< at the stand's light

/// As a photograph shows it, developed with the camera's matrix.
void place(
    const SphereStand& stand, const ImageF& light, double exposure_s, int x0, int y0, Image8& out) {
    static std::uint32_t photograph = 0;
    const ImageF raw = develop(stand.camera, light, exposure_s, 1, photograph++);
    const double black = black_level(stand.camera), range = saturates_at(stand.camera) - black;
    const glm::dmat3 rec709_from_camera =
        rec709_from_working() * glm::inverse(stand.camera_from_working);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const float* value = raw.pixel(x, y);
            const glm::dvec3 camera = (glm::dvec3(value[0], value[1], value[2]) - black) / range;
            const glm::dvec3 rgb = rec709_from_camera * camera;
            for (int c = 0; c < 3; ++c) {
                const double shown = srgb_encode(std::clamp(rgb[c], 0.0, 1.0));
                out.at(x0 + x, y0 + y, c) = static_cast<std::uint8_t>(255.0 * shown + 0.5);
            }
        }
    }
}

int draw(const char* file) {
    // Without noise, which would triple the file.
    const SphereStand stand = usual_sphere_stand({}, kSize, kSize);
    const Material red = find_material("solid red");
    Material white;
    white.model = ReflectanceModel::lambert;
    white.diffuse = glm::dvec3(0.95);
    Image8 picture(8 * kSize, 2 * kSize, 3);
    for (int k = 0; k < 7; ++k) {
        const ImageF light =
            sphere_light(stand, red, stand.lamps_mm[static_cast<std::size_t>(4 * k)]);
        place(stand, light, kLong_s, k * kSize, 0, picture);
        place(stand, light, kShort_s, k * kSize, kSize, picture);
    }
    const ImageF light = sphere_light(stand, white, stand.lamps_mm[5]);
    place(stand, light, 0.8 * kLong_s, 7 * kSize, 0, picture);
    place(stand, light, kShort_s, 7 * kSize, kSize, picture);
    write_png(file, picture);
    return 0;
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) { return livery::draw_named_picture(argc, argv, livery::draw); }
