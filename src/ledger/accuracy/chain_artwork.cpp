#include "ledger/accuracy/chain_artwork.h"

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/pictures/picture_means.h"
#include "core/statistics.h"
#include "ledger/accuracy/chain_steps.h"
#include "radiance/artwork_inputs.h"
#include "radiance/lanes/lane_functions.h"
#include "reference/sobol.h"
#include "scene/library.h"

namespace livery {

namespace {

/// As frames find it, of each fragment of the part.
std::vector<float> covers_by_footprint(const Scene& scene,
                                       const PartArtwork& artwork,
                                       const FrameGeometry& geometry,
                                       double* ms) {
    const SurfaceMap& map = geometry.map;
    const PackedLayout layout = layout_of(map);
    Scene alone = scene;
    alone.artwork = {artwork};
    ArtworkInputs inputs(scene.product->mesh, geometry.view, map, layout, ShadingDevice::processor);
    *ms = milliseconds_of([&] { inputs.solve(alone); });
    inputs.upload();
    check_argument(inputs.covered(0) > 0, "no fragment wears the artwork " + artwork.artwork.name);
    const float* blocks = inputs.layers(0).floats(0);
    const std::size_t first = map.part_begin[artwork.part];
    std::vector<float> covers(layout.fragments(artwork.part));
    for (std::size_t k = 0; k < covers.size(); ++k) {
        const std::size_t address = layout.address(first + k, artwork.part);
        // The fourth channel of its block
        covers[k] =
            blocks[4 * kLaneBlock * (address / kLaneBlock) + 3 * kLaneBlock + address % kLaneBlock];
    }
    return covers;
}

std::vector<float> covers_by_sample(const PartArtwork& artwork,
                                    const FrameGeometry& geometry,
                                    double* ms) {
    const SurfaceMap& map = geometry.map;
    const std::size_t first = map.part_begin[artwork.part];
    std::vector<float> covers(map.part_begin[artwork.part + 1] - first);
    *ms = milliseconds_of([&] {
        parallel_for(covers.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const Fragment& f = map.fragments[first + k];
                covers[k] = static_cast<float>(
                    artwork_at(
                        artwork, glm::dvec3(f.position_mm), glm::dvec3(f.normal), glm::dvec2(0.0))
                        .cover);
            }
        });
    });
    return covers;
}

/// Cover of a part's pixels, as a picture: the cover, then how much of the pixel the part fills.
ImageF by_pixel(const SurfaceMap& map, std::size_t part, const std::vector<float>& covers) {
    ImageF picture(map.width, map.height, 2);
    const std::size_t first = map.part_begin[part];
    for (std::size_t k = 0; k < covers.size(); ++k) {
        const Fragment& f = map.fragments[first + k];
        picture.values[2 * std::size_t{f.pixel}] += f.coverage * covers[k];
        picture.values[2 * std::size_t{f.pixel} + 1] += f.coverage;
    }
    for (std::size_t i = 0; i < picture.values.size(); i += 2) {
        if (picture.values[i + 1] > 0.0f) picture.values[i] /= picture.values[i + 1];
    }
    return picture;
}

/// The same of each artwork by rays, where `worn` (of by_pixel()) has its part.
std::vector<ImageF> by_rays(std::span<const PartArtwork> artworks,
                            std::span<const ImageF> worn,
                            const FrameGeometry& geometry,
                            int rays,
                            const Progress& progress) {
    const Mesh& mesh = geometry.product->mesh;
    const auto width = static_cast<std::size_t>(geometry.view.width);
    std::vector<ImageF> pictures(artworks.size(),
                                 ImageF(geometry.view.width, geometry.view.height, 2));
    const auto one_pixel = [&](std::size_t pixel) {
        for (int k = 0; k < rays; ++k) {
            const SobolPoint point(static_cast<std::uint32_t>(k),
                                   static_cast<std::uint32_t>(pixel));
            const Ray ray =
                ray_through(geometry.view,
                            glm::dvec2(pixel % width, pixel / width) + glm::dvec2(point.pair(0)));
            const Hit hit = geometry.tracer->closest(
                {glm::vec3(ray.origin), 0.0f, glm::vec3(ray.direction), 1e30f});
            if (!hit.valid()) continue;
            const SurfacePoint at = surface_point(mesh, hit);
            for (std::size_t a = 0; a < artworks.size(); ++a) {
                if (artworks[a].part != at.part) continue;
                pictures[a].values[2 * pixel] +=
                    static_cast<float>(artwork_at(artworks[a],
                                                  glm::dvec3(at.position_mm),
                                                  glm::dvec3(at.normal),
                                                  glm::dvec2(at.uv))
                                           .cover);
                pictures[a].values[2 * pixel + 1] += 1.0f;
            }
        }
        for (ImageF& picture : pictures) {
            float* of_pixel = &picture.values[2 * pixel];
            if (of_pixel[1] > 0.0f) of_pixel[0] /= of_pixel[1];
            of_pixel[1] /= static_cast<float>(rays);
        }
    };
    for (std::size_t y = 0; y < static_cast<std::size_t>(geometry.view.height); ++y) {
        progress.check_stop();
        parallel_for(width, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t pixel = y * width + begin; pixel < y * width + end; ++pixel) {
                bool any = false;
                for (const ImageF& one : worn) any = any || one.values[2 * pixel + 1] > 0.0f;
                if (any) one_pixel(pixel);
            }
        });
    }
    return pictures;
}

ImageF coloured(const ImageF& covers, const Material& paint, const Material& over) {
    const glm::vec3 below(working_from_rec709() * paint.diffuse);
    const glm::vec3 above(working_from_rec709() * over.diffuse);
    ImageF picture(covers.width, covers.height, 4);
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        const glm::vec3 colour = glm::mix(below, above, covers.values[2 * i]);
        for (std::size_t c = 0; c < 3; ++c) {
            picture.values[4 * i + c] = colour[static_cast<int>(c)];
        }
        picture.values[4 * i + 3] = covers.values[2 * i + 1];
    }
    return picture;
}

}  // namespace

double pixel_across_mm(const FrameGeometry& geometry, std::size_t part, const ArtworkPlace& place) {
    const glm::dvec3 across = plane_of(place).s_axis;
    std::vector<double> widths_mm;
    for (const Footprint& footprint : footprints_of(geometry.view, geometry.map, part)) {
        widths_mm.push_back(std::abs(glm::dot(across, footprint.a)) +
                            std::abs(glm::dot(across, footprint.b)));
    }
    return median(widths_mm);
}

std::vector<ArtworkPictures> artwork_pictures(const Scene& scene,
                                              const FrameGeometry& geometry,
                                              int rays,
                                              const Progress& progress) {
    check_argument(rays > 0, "an artwork is compared with one ray a pixel or more");
    std::vector<ArtworkPictures> pictures(scene.artwork.size());
    std::vector<ImageF> by_footprint, by_sample;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const PartArtwork& artwork = scene.artwork[k];
        check_argument(!reads_colours(artwork.artwork) && !artwork.artwork.place.by_uv,
                       "shares of pixels alone are compared: no colours, no texture coordinates");
        by_footprint.push_back(
            by_pixel(geometry.map,
                     artwork.part,
                     covers_by_footprint(scene, artwork, geometry, &pictures[k].footprint_ms)));
        by_sample.push_back(by_pixel(geometry.map,
                                     artwork.part,
                                     covers_by_sample(artwork, geometry, &pictures[k].sample_ms)));
    }
    const auto by_many = by_rays(scene.artwork, by_footprint, geometry, rays, progress);
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const Material& paint = scene.part_materials[scene.artwork[k].part];
        const Material& over = scene.artwork[k].material;
        pictures[k].by_footprint = coloured(by_footprint[k], paint, over);
        pictures[k].by_sample = coloured(by_sample[k], paint, over);
        pictures[k].by_many = coloured(by_many[k], paint, over);
    }
    return pictures;
}

namespace {

constexpr double kStripes_px[] = {0.3, 1.0, 3.0, 10.0};
constexpr double kPicture_px = 30.0;
constexpr const char* kPicture = "assets/patterns/roundel.png";
constexpr int kRays = 256, kQuickRays = 64;

/// White over the red car's body: stripes along it, and a picture again and again.
Scene with_artwork(const Scene& plain, const FrameGeometry& geometry) {
    const auto part = static_cast<std::size_t>(part_index(*plain.product, "body"));
    Look look = find_look("solid-red");
    Artwork artwork;
    artwork.part = "body";
    artwork.paint = "solid white";
    artwork.place.direction = {0.0, -1.0, 0.0};
    artwork.place.up = {0.0, 0.0, 1.0};
    const double pixel_mm = pixel_across_mm(geometry, part, artwork.place);
    for (const double stripe_px : kStripes_px) {
        artwork.size_mm = 2.0 * stripe_px * pixel_mm;
        look.artwork.push_back(artwork);
    }
    artwork.shape = ArtworkShape::picture;
    artwork.picture = kPicture;
    artwork.repeat = true;
    artwork.size_mm = kPicture_px * pixel_mm;
    look.artwork.push_back(artwork);
    return make_scene(plain.product, look, plain.eye_in_world_mm, plain.environment);
}

void measure(std::vector<ChainRow>& rows, int rays, const Progress& progress) {
    const AccuracyScene car = accuracy_scenes(true, progress).front();
    const FrameGeometry geometry(car.scene.product, car.view, progress);
    const auto pictures =
        artwork_pictures(with_artwork(car.scene, geometry), geometry, rays, progress);
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const ArtworkPictures& one = pictures[k];
        ChainRow &by_sample = rows.at(2 * k), &by_footprint = rows.at(2 * k + 1);
        set_errors(by_sample, colour_differences(one.by_sample, one.by_many));
        by_sample.ms = one.sample_ms;
        set_errors(by_footprint, colour_differences(one.by_footprint, one.by_many));
        by_footprint.ms = one.footprint_ms;
    }
}

}  // namespace

std::vector<ChainPart> artwork_parts(const AccuracyOptions& options) {
    const int rays = options.quick ? kQuickRays : kRays;
    ChainPart part;
    std::vector<std::string> names;
    for (const double stripe_px : kStripes_px) {
        names.push_back(fmt::format("artwork, stripes of {} px", stripe_px));
    }
    names.push_back(fmt::format("artwork, a picture of {} px", kPicture_px));
    for (const std::string& name : names) {
        for (const char* level : {"one sample a pixel", "footprint"}) {
            part.rows.push_back({name, level, fmt::format("mean of {} rays a pixel", rays)});
        }
    }
    part.inputs = [] {
        Hasher hasher;
        hasher.add(hash_of(accuracy_scenes(true).front()));
        hasher.add(read_text_file(shipped_path(kPicture)));
        return hasher.hex();
    };
    part.measure = [rays](std::vector<ChainRow>& rows, const Progress& progress) {
        measure(rows, rays, progress);
    };
    return {part};
}

}  // namespace livery
