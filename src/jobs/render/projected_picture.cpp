#include "jobs/render/projected_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/channels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"

namespace livery {

std::shared_ptr<const ProjectedLight> read_projected_picture(const std::filesystem::path& file,
                                                             const View& projector,
                                                             const Mesh& mesh) {
    const ImageFile picture = read_image(file);
    const ImageF& from = picture.image;
    if (from.width != projector.width || from.height != projector.height) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", from.width, from.height),
                        fmt::format("the projector's {}x{}", projector.width, projector.height));
    }
    const std::array<int, 3> colour = colour_channels(file, picture);
    ImageF light(from.width, from.height, 3);
    for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x) {
            glm::dvec3 rgb;
            for (int c = 0; c < 3; ++c) {
                const double value = from.at(x, y, colour[static_cast<std::size_t>(c)]);
                rgb[c] = picture.floating_point ? value : srgb_decode(value / picture.full_scale);
                if (!std::isfinite(rgb[c]) || rgb[c] < 0.0) {
                    throw FileError(file,
                                    fmt::format("pixel ({}, {})", x, y),
                                    fmt::format("{}", rgb[c]),
                                    "light: 0 or more");
                }
            }
            rgb = working_from_rec709() * rgb;
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) = static_cast<float>(std::max(rgb[c], 0.0));
            }
        }
    }
    const Bounds bounds = bounds_of(mesh);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double distance_mm = (projector.view_from_world * middle).z;
    if (!(distance_mm > 0.0)) {
        throw FileError(file,
                        "projector",
                        "a product behind it",
                        "--projector FILE of one that looks at the product");
    }
    return std::make_shared<const ProjectedLight>(projector, std::move(light), distance_mm);
}

View view_of_all(const Mesh& mesh, const glm::dvec3& eye_mm, int width, int height) {
    const Bounds bounds = bounds_of(mesh);
    View view = look_at(eye_mm, 0.5 * (bounds.low + bounds.high), 1.0, width, height);
    // As long a lens as has all corners in the picture
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? bounds.high.x : bounds.low.x,
                            corner & 2 ? bounds.high.y : bounds.low.y,
                            corner & 4 ? bounds.high.z : bounds.low.z);
        const glm::dvec3 in_view = view.view_from_world * at;
        const double depth = std::max(in_view.z, 1e-3 * glm::length(in_view));
        farthest = std::max({farthest,
                             std::abs(in_view.x) / depth / (0.5 * width),
                             std::abs(in_view.y) / depth / (0.5 * height)});
    }
    constexpr double kMargin = 0.95;
    if (farthest > 0.0) view.focal_px = glm::dvec2(kMargin / farthest);
    return view;
}

}  // namespace livery
