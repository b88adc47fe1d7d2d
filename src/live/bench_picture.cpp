#include "live/bench_picture.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "twin/factors.h"

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
    const auto at = y.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(y.size()));
    std::nth_element(y.begin(), at, y.end());
    return std::max(static_cast<double>(*at), 1e-6);
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

PixelRectangle bounds_in_view(const Mesh& mesh, const View& view, int margin_px) {
    glm::dvec2 low(view.width, view.height), high(0.0);
    for (const glm::vec3& position : mesh.positions_mm) {
        const auto pixel = project(view, glm::dvec3(position));
        if (!pixel) continue;
        low = glm::min(low, *pixel);
        high = glm::max(high, *pixel);
    }
    const PixelRectangle box{
        std::max(0, static_cast<int>(std::floor(low.x)) - margin_px),
        std::max(0, static_cast<int>(std::floor(low.y)) - margin_px),
        std::min(view.width, static_cast<int>(std::ceil(high.x)) + margin_px),
        std::min(view.height, static_cast<int>(std::ceil(high.y)) + margin_px)};
    if (box.right <= box.left || box.bottom <= box.top) return {0, 0, view.width, view.height};
    return box;
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
