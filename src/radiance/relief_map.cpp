#include "radiance/relief_map.h"

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/artwork_footprint.h"
#include "scene/artwork_cover.h"
#include "scene/artwork_relief.h"

namespace livery {

namespace {

void tilt(Fragment& fragment, const ReliefFrame& frame, const ReliefTilt& by) {
    const glm::dvec3 normal = tilted(glm::dvec3(fragment.normal), frame, by.slope);
    fragment.normal = glm::vec3(normal);
    fragment.normal_variance += static_cast<float>(by.variance);
    glm::dvec3 tangent(fragment.tangent);
    tangent -= glm::dot(tangent, normal) * normal;
    const glm::vec3 unit(glm::normalize(tangent));
    fragment.tangent = {unit, fragment.tangent.w};
}

}  // namespace

SurfaceMap relieved(const SurfaceMap& map, const Scene& scene, const View& view) {
    SurfaceMap result = map;
    result.flat_normals.reserve(map.fragments.size());
    for (const Fragment& fragment : map.fragments) result.flat_normals.push_back(fragment.normal);
    for (const PartArtwork& relief : scene.relief) {
        const FilteredPicture picture(picture_layers(*relief.picture, PictureUse::relief, {}),
                                      relief.artwork.repeat);
        const ArtworkPlane plane = plane_of(relief.artwork.place);
        const PictureFrame in_picture = picture_frame(relief);
        const std::size_t first = map.part_begin[relief.part];
        const std::vector<Footprint> footprints = footprints_of(view, map, relief.part);
        parallel_for(footprints.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i) {
                Fragment& fragment = result.fragments[i];
                const glm::dvec3 normal(fragment.normal);
                const double facing =
                    facing_cover(relief.artwork.place, glm::dot(normal, plane.toward));
                if (facing <= 0.0) continue;
                const FlatFootprint flat = flat_footprint(
                    scene.product->mesh, map, i, footprints[i - first], relief, plane);
                float mean[4];
                picture.mean(in_picture.uv(flat.at),
                             in_picture.turned(flat.a),
                             in_picture.turned(flat.b),
                             mean);
                const glm::dvec4 seen = facing * glm::dvec4(mean[0], mean[1], mean[2], mean[3]);
                const ReliefFrame frame =
                    relief_frame(relief, normal, glm::dvec4(fragment.tangent));
                tilt(fragment, frame, tilt_of(relief, seen));
            }
        });
    }
    return result;
}

}  // namespace livery
