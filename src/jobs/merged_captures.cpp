#include "jobs/merged_captures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

bool MergedCaptures::all_saturated() const {
    const auto& seconds = picture.seconds.values;
    return std::none_of(seconds.begin(), seconds.end(), [](float one) { return one > 0.0f; });
}

MergedCaptures merge_captures(const std::vector<Capture>& captures,
                              const std::function<Photograph(const Capture&)>& load,
                              const Progress& progress) {
    MergedCaptures merged;
    double done = 0.0;
    for (const Capture& capture : captures) {
        progress.update(done / static_cast<double>(captures.size()),
                        "reading " + capture.file.filename().string());
        done += 1.0;
        const Photograph photograph = load(capture);
        add(photograph, merged.picture);
        merged.clipped_light = std::max(merged.clipped_light, clipped_light(photograph));
    }
    return merged;
}

Photograph load_photograph_of(const Capture& capture, const View& camera) {
    Photograph photograph = load_photograph(capture);
    const ImageF& image = photograph.image;
    if (image.width != camera.width || image.height != camera.height) {
        throw FileError(capture.file,
                        "size",
                        fmt::format("{}x{}", image.width, image.height),
                        fmt::format("the camera's {}x{}", camera.width, camera.height));
    }
    return photograph;
}

namespace {

constexpr double kMargin = 0.45;  ///< around the sphere's box, of its size
constexpr double kFewestAcross_px = 40;

}  // namespace

SphereWindow window_around(const View& camera,
                           const Sphere& sphere,
                           double most_across_px,
                           const std::filesystem::path& manifest) {
    const auto box = outline_box(camera, sphere);
    const double width = camera.width, height = camera.height;
    if (!box || box->right < 0.0 || box->bottom < 0.0 || box->left > width || box->top > height) {
        throw FileError(manifest,
                        "sphere.centre_mm",
                        box ? fmt::format("a sphere at pixel {:.0f},{:.0f}, outside of the picture",
                                          0.5 * (box->left + box->right),
                                          0.5 * (box->top + box->bottom))
                            : "a sphere that is not before the camera",
                        "one that the camera sees");
    }
    const double across = std::max(box->right - box->left, box->bottom - box->top);
    if (across < kFewestAcross_px) {
        throw FileError(manifest,
                        "sphere.diameter_mm",
                        fmt::format("a sphere of {:.0f} px in the picture", across),
                        fmt::format("{:.0f} px or more", kFewestAcross_px));
    }
    SphereWindow window;
    PictureWindow& pixels = window.pixels;
    pixels.block = static_cast<int>(std::ceil(across / most_across_px));
    const double margin = kMargin * across;
    const auto low = [&](double edge) {
        return static_cast<int>(std::max(std::floor(edge - margin), 0.0));
    };
    const auto blocks = [&](double edge, double limit, int first) {
        return (static_cast<int>(std::min(std::ceil(edge + margin), limit)) - first) / pixels.block;
    };
    pixels.left = low(box->left);
    pixels.top = low(box->top);
    pixels.width = blocks(box->right, width, pixels.left);
    pixels.height = blocks(box->bottom, height, pixels.top);
    window.view = resized(cropped(camera,
                                  pixels.left,
                                  pixels.top,
                                  pixels.block * pixels.width,
                                  pixels.block * pixels.height),
                          pixels.width,
                          pixels.height);
    return window;
}

}  // namespace livery
