#include "radiance/artwork_inputs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "scene/artwork_cover.h"

namespace livery {

namespace {

/// The least cosine that a footprint is stretched by.
constexpr double kLeastCosine = 1.0 / 30.0;

/// Along u and v of the triangle that the fragment's first sample met, carried on from there.
FlatFootprint on_uv(const Mesh& mesh,
                    const SurfaceSample& sample,
                    const Fragment& fragment,
                    const Footprint& footprint) {
    const glm::uvec3 corner = mesh.triangles[sample.triangle];
    const glm::dvec3 origin(mesh.positions_mm[corner.x]);
    const glm::dvec3 e1 = glm::dvec3(mesh.positions_mm[corner.y]) - origin;
    const glm::dvec3 e2 = glm::dvec3(mesh.positions_mm[corner.z]) - origin;
    const glm::dvec2 uv(mesh.uvs[corner.x]);
    const glm::dvec2 d1 = glm::dvec2(mesh.uvs[corner.y]) - uv;
    const glm::dvec2 d2 = glm::dvec2(mesh.uvs[corner.z]) - uv;
    // Weights of the edges that come closest to a vector, by the edges' inner products
    const double m11 = glm::dot(e1, e1), m12 = glm::dot(e1, e2), m22 = glm::dot(e2, e2);
    const double determinant = m11 * m22 - m12 * m12;
    const auto along = [&](const glm::dvec3& v) {
        if (!(determinant > 1e-12 * m11 * m22)) return glm::dvec2(0.0);
        const double p = glm::dot(v, e1), q = glm::dot(v, e2);
        return ((m22 * p - m12 * q) * d1 + (m11 * q - m12 * p) * d2) / determinant;
    };
    return {uv + along(glm::dvec3(fragment.position_mm) - origin),
            along(footprint.a),
            along(footprint.b)};
}

FlatFootprint on_plane(const ArtworkPlane& plane,
                       const Fragment& fragment,
                       const Footprint& footprint) {
    const auto along = [&](const glm::dvec3& v) {
        return glm::dvec2(glm::dot(plane.s_axis, v), glm::dot(plane.t_axis, v));
    };
    return {plane * glm::dvec3(fragment.position_mm), along(footprint.a), along(footprint.b)};
}

}  // namespace

Footprint footprint_of(const View& view,
                       std::uint32_t pixel,
                       const glm::dvec3& position_mm,
                       const glm::dvec3& normal) {
    const auto width = static_cast<std::uint32_t>(view.width);
    const glm::dvec2 corner(pixel % width, pixel / width);
    const auto direction = [&](double x, double y) {
        return ray_through(view, corner + glm::dvec2(x, y)).direction;
    };
    const glm::dvec3 from = position_mm - centre_in_world(view);
    const double distance = glm::length(from);
    const glm::dvec3 ray = from / distance;
    double cosine = glm::dot(ray, normal);
    cosine = std::copysign(std::max(std::abs(cosine), kLeastCosine), cosine);
    const auto on_surface = [&](const glm::dvec3& step) {
        return distance * (step - (glm::dot(step, normal) / cosine) * ray);
    };
    return {on_surface(direction(1.0, 0.5) - direction(0.0, 0.5)),
            on_surface(direction(0.5, 1.0) - direction(0.5, 0.0))};
}

std::vector<Footprint> footprints_of(const View& view, const SurfaceMap& map, std::size_t part) {
    const std::size_t first = map.part_begin[part];
    std::vector<Footprint> footprints(map.part_begin[part + 1] - first);
    parallel_for(footprints.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Fragment& f = map.fragments[first + k];
            footprints[k] =
                footprint_of(view, f.pixel, glm::dvec3(f.position_mm), glm::dvec3(f.normal));
        }
    });
    return footprints;
}

FlatFootprint flat_footprint(const Mesh& mesh,
                             const SurfaceMap& map,
                             std::size_t fragment,
                             const Footprint& footprint,
                             const PartArtwork& artwork,
                             const ArtworkPlane& plane) {
    const Fragment& f = map.fragments[fragment];
    if (!artwork.artwork.place.by_uv) return on_plane(plane, f, footprint);
    return on_uv(mesh, map.samples[fragment * kSamplesAFragment], f, footprint);
}

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

ArtworkInputs::ArtworkInputs(const Mesh& mesh,
                             const View& view,
                             const SurfaceMap& map,
                             const PackedLayout& layout,
                             ShadingDevice device)
    : mesh_(mesh),
      view_(view),
      map_(map),
      layout_(layout),
      device_(device),
      footprints_(mesh.parts.size()),
      versions_(mesh.parts.size(), 0) {}

bool ArtworkInputs::stands(const Scene& scene) const {
    return std::equal(scene.artwork.begin(),
                      scene.artwork.end(),
                      solved_.begin(),
                      solved_.end(),
                      [](const PartArtwork& a, const auto& b) { return covers_alike(a, b->of); });
}

bool ArtworkInputs::solve(const Scene& scene) {
    if (stands(scene)) return false;
    // Every part whose list is no longer the same; what stood elsewhere in the list still stands
    std::vector<std::shared_ptr<Solved>> next;
    for (const PartArtwork& artwork : scene.artwork) {
        const auto found = std::find_if(solved_.begin(), solved_.end(), [&](const auto& solved) {
            return solved && covers_alike(artwork, solved->of);
        });
        if (found != solved_.end()) {
            next.push_back(*found);
            continue;
        }
        auto solved = std::make_shared<Solved>();
        solved->of = artwork;
        if (artwork.picture) solved->filtered = filtered_of(artwork);
        solve_one(*solved);
        next.push_back(std::move(solved));
    }
    const auto mark_against = [&](const auto& these, const auto& those) {
        for (const auto& solved : these) {
            if (std::find(those.begin(), those.end(), solved) == those.end()) {
                ++versions_[solved->of.part];
            }
        }
    };
    mark_against(next, solved_);
    mark_against(solved_, next);
    for (std::size_t k = 0; k < std::min(next.size(), solved_.size()); ++k) {
        if (next[k] != solved_[k]) ++versions_[next[k]->of.part];
    }
    solved_ = std::move(next);
    std::erase_if(pictures_, [&](const Picture& picture) {
        return std::none_of(solved_.begin(), solved_.end(), [&](const auto& solved) {
            return solved->filtered == picture.filtered;
        });
    });
    return true;
}

std::shared_ptr<const FilteredPicture> ArtworkInputs::filtered_of(const PartArtwork& artwork) {
    const PictureUse use = artwork.artwork.use;
    const bool repeat = artwork.artwork.repeat;
    for (const Picture& known : pictures_) {
        if (known.of == artwork.picture && known.use == use && known.repeat == repeat &&
            known.pigment_response == artwork.pigment_response) {
            return known.filtered;
        }
    }
    auto filtered = std::make_shared<const FilteredPicture>(
        picture_layers(*artwork.picture, use, artwork.pigment_response), repeat);
    pictures_.push_back({artwork.picture, use, repeat, artwork.pigment_response, filtered});
    return filtered;
}

void ArtworkInputs::solve_one(Solved& solved) {
    const PartArtwork& artwork = solved.of;
    std::vector<Footprint>& footprints = footprints_[artwork.part];
    if (footprints.empty()) footprints = footprints_of(view_, map_, artwork.part);
    const ArtworkPlane plane = plane_of(artwork.artwork.place);
    const std::size_t layers =
        solved.filtered ? static_cast<std::size_t>(solved.filtered->channels()) / 4 : 1;
    const std::size_t texels = static_cast<std::size_t>(layout_.rows) * kPackedWidth * 4;
    solved.texels.assign(layers, std::vector<float>(texels, 0.0f));
    const std::size_t first = map_.part_begin[artwork.part];
    const PictureFrame frame = artwork.picture ? picture_frame(artwork) : PictureFrame();
    std::atomic<std::size_t> covered = 0;
    parallel_for(layout_.fragments(artwork.part), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<float> values(4 * layers);
        for (std::size_t i = first + begin; i < first + end; ++i) {
            const Fragment& fragment = map_.fragments[i];
            const glm::dvec3 normal(fragment.normal);
            const double facing =
                facing_cover(artwork.artwork.place, glm::dot(normal, plane.toward));
            if (facing <= 0.0) continue;
            const FlatFootprint flat =
                flat_footprint(mesh_, map_, i, footprints[i - first], artwork, plane);
            if (solved.filtered) {
                solved.filtered->mean(
                    frame.uv(flat.at), frame.turned(flat.a), frame.turned(flat.b), values.data());
            } else {
                std::fill(
                    values.begin(),
                    values.end(),
                    static_cast<float>(shape_cover(artwork.artwork, flat.at, flat.a, flat.b)));
            }
            const std::size_t address = 4 * layout_.address(i, artwork.part);
            for (std::size_t k = 0; k < layers; ++k) {
                for (std::size_t c = 0; c < 4; ++c) {
                    solved.texels[k][address + c] = static_cast<float>(facing) * values[4 * k + c];
                }
            }
            if (values[3] > 0.0f) ++covered;
        }
    });
    solved.covered = covered;
}

void ArtworkInputs::upload() {
    for (const auto& solved : solved_) {
        if (solved->texels.empty()) continue;
        if (solved->covered > 0) {
            const auto layers = static_cast<int>(solved->texels.size());
            if (solved->layers.make(device_, layout_.rows, layers, InputLayers::Precision::full)) {
                ++layers_made_;
            }
            for (int k = 0; k < layers; ++k) {
                solved->layers.upload(solved->texels[static_cast<std::size_t>(k)], k);
            }
        }
        solved->texels.clear();
        solved->texels.shrink_to_fit();
    }
}

}  // namespace livery
