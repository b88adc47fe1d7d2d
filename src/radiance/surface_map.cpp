#include "radiance/surface_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "radiance/ray_grid.h"

namespace livery {
namespace {

/// One sub-sample that met the product.
struct Sample {
    SurfacePoint point;
    SurfaceSample place;
    int group = 0;
};

/// A fragment before it is sorted into the map.
struct Solved {
    Fragment fragment;
    std::array<SurfaceSample, kSamplesAFragment> samples;
};

/// Places of the sub-samples in a pixel: one in each cell of a side x side grid and, at the same
/// time, one in each of side^2 columns and rows, so that straight edges get side^2 levels. Their
/// mean is the pixel's centre, x and y are not correlated: interior pixels have no sampling noise.
std::vector<glm::dvec2> sample_places(int side) {
    std::vector<glm::dvec2> rows;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            rows.emplace_back((i + (j + 0.5) / side) / side, (j + (side - i - 0.5) / side) / side);
        }
    }
    // An order in which any few that follow one another are spread over the pixel
    const int count = side * side;
    int stride = std::max(1, static_cast<int>(std::lround(0.4375 * count)));
    while (std::gcd(stride, count) != 1) ++stride;
    std::vector<glm::dvec2> places;
    for (int k = 0; k < count; ++k) {
        places.push_back(rows[static_cast<std::size_t>((1 + k * stride) % count)]);
    }
    return places;
}

/// Whether a mean over both points would be a point of neither surface: another part, normals
/// over 60 degrees apart, or apart by more than two footprints across the tangent plane.
bool breaks_from(const SurfacePoint& a, const SurfacePoint& b, float footprint_mm) {
    if (a.part != b.part) return true;
    if (glm::dot(a.normal, b.normal) < 0.5f) return true;
    const glm::vec3 apart = b.position_mm - a.position_mm;
    const float off_plane = std::min(std::abs(glm::dot(apart, a.geometric_normal)),
                                     std::abs(glm::dot(apart, b.geometric_normal)));
    return off_plane > 2.0f * footprint_mm;
}

Solved mean_of(const std::vector<Sample>& samples, int group, std::uint32_t pixel, int per_pixel) {
    Solved solved;
    Fragment& fragment = solved.fragment;
    std::size_t kept = 0;
    fragment.pixel = pixel;
    int count = 0;
    float handedness = 0.0f;
    glm::dvec3 position(0.0);
    glm::vec3 normal(0.0f), tangent(0.0f);
    for (const Sample& s : samples) {
        if (s.group != group) continue;
        fragment.part = s.point.part;
        position += glm::dvec3(s.point.position_mm);
        normal += s.point.normal;
        tangent += glm::vec3(s.point.tangent);
        handedness += s.point.tangent.w;
        if (kept < kSamplesAFragment) solved.samples[kept++] = s.place;
        ++count;
    }
    fragment.position_mm = glm::vec3(position / static_cast<double>(count));
    fragment.normal = glm::normalize(normal);
    fragment.coverage = static_cast<float>(count) / static_cast<float>(per_pixel);

    // Mean squared slope around the mean normal
    for (const Sample& s : samples) {
        if (s.group != group) continue;
        const float c = glm::dot(s.point.normal, fragment.normal);
        const glm::vec3 across = s.point.normal - c * fragment.normal;
        fragment.normal_variance += glm::dot(across, across) / (c * c);
    }
    fragment.normal_variance /= static_cast<float>(count);

    // Tangent in the plane of the mean normal; any one where the samples' tangents cancel
    tangent -= glm::dot(tangent, fragment.normal) * fragment.normal;
    if (glm::dot(tangent, tangent) < 1e-12f) {
        const glm::vec3 n = fragment.normal;
        const glm::vec3 axis = std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        tangent = glm::cross(axis, n);
    }
    fragment.tangent = glm::vec4(glm::normalize(tangent), handedness < 0.0f ? -1.0f : 1.0f);
    for (std::size_t k = kept; k < kSamplesAFragment; ++k) {
        solved.samples[k] = solved.samples[k - kept];
    }
    return solved;
}

/// Sorts a pixel's samples into groups that a mean can stand for and appends their fragments.
void append_fragments(std::vector<Sample>& samples,
                      std::uint32_t pixel,
                      int per_pixel,
                      float footprint_mm,
                      std::vector<Solved>& fragments) {
    std::vector<const Sample*> first;  // of each group
    for (Sample& s : samples) {
        const auto found = std::find_if(first.begin(), first.end(), [&](const Sample* f) {
            return !breaks_from(f->point, s.point, footprint_mm);
        });
        s.group = static_cast<int>(found - first.begin());
        if (found == first.end()) first.push_back(&s);
    }
    for (int group = 0; group < static_cast<int>(first.size()); ++group) {
        fragments.push_back(mean_of(samples, group, pixel, per_pixel));
    }
}

/// Traces one tile; fragments come pixel by pixel.
std::vector<Solved> solve_tile(const Mesh& mesh,
                               const Tracer& tracer,
                               const View& view,
                               glm::ivec2 tile,
                               const std::vector<glm::dvec2>& places) {
    const TileRays lens(view, tile);
    const glm::vec3 origin(centre_in_world(view));
    const int x_end = std::min((tile.x + 1) * kTile_px, view.width);
    const int y_end = std::min((tile.y + 1) * kTile_px, view.height);
    const int per_pixel = static_cast<int>(places.size());

    std::vector<TraceRay> rays;
    std::vector<Hit> hits;
    std::vector<Sample> samples;
    std::vector<Solved> fragments;
    for (int y = tile.y * kTile_px; y < y_end; ++y) {
        // Rays of one row of the tile at a time stay in the cache
        rays.clear();
        for (int x = tile.x * kTile_px; x < x_end; ++x) {
            for (const glm::dvec2& place : places) {
                const auto direction = lens.direction(glm::dvec2(x, y) + place);
                TraceRay ray;
                ray.origin = origin;
                // A ray of no length where the lens model reaches no direction
                if (direction) {
                    ray.direction = *direction;
                } else {
                    ray.t_max = 0.0f;
                }
                rays.push_back(ray);
            }
        }
        hits.assign(rays.size(), Hit{});
        tracer.closest(rays, hits);

        for (int x = tile.x * kTile_px; x < x_end; ++x) {
            const auto begin = static_cast<std::size_t>((x - tile.x * kTile_px) * per_pixel);
            samples.clear();
            float farthest = 0.0f;
            for (std::size_t i = begin; i < begin + static_cast<std::size_t>(per_pixel); ++i) {
                if (!hits[i].valid()) continue;
                Sample sample;
                sample.point = surface_point(mesh, hits[i]);
                sample.place = {hits[i].triangle, hits[i].barycentric};
                farthest = std::max(farthest, hits[i].t);
                // An open surface shows its inside: the side that is lit is the side that is shaded
                if (glm::dot(sample.point.geometric_normal, rays[i].direction) > 0.0f) {
                    sample.point.geometric_normal = -sample.point.geometric_normal;
                    sample.point.normal = -sample.point.normal;
                }
                samples.push_back(sample);
            }
            if (samples.empty()) continue;
            const auto footprint =
                farthest / static_cast<float>(std::min(view.focal_px.x, view.focal_px.y));
            append_fragments(samples,
                             static_cast<std::uint32_t>(y * view.width + x),
                             per_pixel,
                             footprint,
                             fragments);
        }
    }
    return fragments;
}

}  // namespace

SurfaceMap build_surface_map(const Mesh& mesh,
                             const Tracer& tracer,
                             const View& view,
                             int samples_per_pixel,
                             const Progress& progress) {
    const int side = static_cast<int>(std::lround(std::sqrt(std::max(samples_per_pixel, 0))));
    check_argument(side >= 1 && side * side == samples_per_pixel,
                   fmt::format("samples_per_pixel is {}, not a square number", samples_per_pixel));
    check_argument(view.width > 0 && view.height > 0,
                   fmt::format("view is {} x {} pixels", view.width, view.height));
    progress.update(0.0, "seeing the product");

    const std::vector<glm::dvec2> places = sample_places(side);
    const std::vector<glm::ivec2> tiles = tiles_that_see(mesh, view);
    std::vector<std::vector<Solved>> solved(tiles.size());
    parallel_for(tiles.size(), 8, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) {
            solved[i] = solve_tile(mesh, tracer, view, tiles[i], places);
        }
    });
    progress.update(0.9, "seeing the product");

    // Order by part, then by pixel; fragments of one pixel and part keep their order
    struct Key {
        std::uint64_t part_and_pixel;
        const Solved* solved;
    };
    std::vector<Key> keys;
    for (const auto& tile : solved) {
        for (const Solved& s : tile) {
            keys.push_back(
                {(static_cast<std::uint64_t>(s.fragment.part) << 32u) | s.fragment.pixel, &s});
        }
    }
    std::stable_sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.part_and_pixel < b.part_and_pixel;
    });

    SurfaceMap map;
    map.width = view.width;
    map.height = view.height;
    map.samples_per_pixel = samples_per_pixel;
    map.coverage = ImageF(view.width, view.height, 1);
    map.part_begin.assign(mesh.parts.size() + 1, 0);
    map.fragments.reserve(keys.size());
    map.samples.reserve(keys.size() * kSamplesAFragment);
    for (const Key& key : keys) {
        const Fragment& f = key.solved->fragment;
        map.fragments.push_back(f);
        map.samples.insert(
            map.samples.end(), key.solved->samples.begin(), key.solved->samples.end());
        map.part_begin[f.part + 1u] += 1;
        float& covered = map.coverage.values[f.pixel];
        if (covered == 0.0f) ++map.covered_pixels;
        covered += f.coverage;
    }
    for (std::size_t p = 1; p < map.part_begin.size(); ++p) {
        map.part_begin[p] += map.part_begin[p - 1];
    }
    progress.update(1.0, "seeing the product");
    return map;
}

}  // namespace livery
