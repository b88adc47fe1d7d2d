#include "live/bench_picture.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/statistics.h"
#include "twin/received.h"

namespace livery {

namespace {

/// 8-bit photographs are sRGB-encoded; linear ones stay as they are.
Photograph decoded(Photograph photograph, const CameraDescription& camera) {
    if (camera.encoding != CameraEncoding::srgb8) return photograph;
    constexpr double kFullScale = 16383.0;
    for (float& value : photograph.image.values) {
        const double linear = srgb_decode(static_cast<double>(value) / 255.0);
        value = static_cast<float>(linear * (kFullScale - camera.black_level_units));
    }
    return photograph;
}

double brightest(const ImageF& xyz) {
    std::vector<float> y;
    for (std::size_t i = 0; i < xyz.pixel_count(); ++i) y.push_back(xyz.values[3 * i + 1]);
    if (y.empty()) return 1.0;
    return std::max(static_cast<double>(quantile(std::move(y), 0.999)), 1e-6);
}

}  // namespace

glm::dmat3 xyz_from_bench_camera(const BenchDescription& bench) {
    SurfaceSet white;
    white.reflectances.emplace_back();
    white.reflectances.front().fill(1.0);
    const auto xyz = fold(bench, white, observer_sensor()).direct.front();
    const auto camera = fold(bench, white, camera_sensor(bench)).direct.front();
    return glm::dmat3(xyz[0], xyz[1], xyz[2]) *
           glm::inverse(glm::dmat3(camera[0], camera[1], camera[2]));
}

Image8 srgb_from_photograph(const Photograph& photograph,
                            const BenchDescription& bench,
                            const PixelRectangle& part,
                            double white_y) {
    Photograph cropped = photograph;
    cropped.image = crop(photograph.image, part);
    const ImageF xyz =
        developed(decoded(std::move(cropped), bench.camera), xyz_from_bench_camera(bench));
    return srgb_from_xyz(xyz, white_y > 0.0 ? white_y : brightest(xyz));
}

}  // namespace livery
