#include "radiance/surface_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

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
    glm::vec3 position_mm;
    glm::vec3 normal;
    glm::vec3 face_normal;  ///< of its triangle, unit
    glm::vec4 tangent;      ///< as interpolated: neither unit nor at right angles to the normal
    SurfaceSample place;
    std::uint16_t part = 0;
    std::uint16_t group = 0;
};

/// What one tile shows: by part, then by pixel.
struct Tile {
    std::vector<Fragment> fragments;
    std::vector<SurfaceSample> samples;  ///< kSamplesAFragment each
};

/// Fragments of one part in one row of a tile: they stay together in the map.
struct Run {
    std::uint16_t part = 0;
    std::uint32_t first_pixel = 0;
    const Tile* tile = nullptr;
    std::size_t begin = 0, end = 0;  ///< in the tile
    std::size_t place = 0;           ///< in the map
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
bool breaks_from(const Sample& a, const Sample& b, float footprint_mm) {
    if (a.part != b.part) return true;
    if (glm::dot(a.normal, b.normal) < 0.5f) return true;
    const glm::vec3 apart = b.position_mm - a.position_mm;
    const float off_plane = std::min(std::abs(glm::dot(apart, a.face_normal)),
                                     std::abs(glm::dot(apart, b.face_normal)));
    return off_plane > 2.0f * footprint_mm;
}

/// Shading takes a fragment's normals for a disc of slopes around their mean, as wide along a bend
/// as across it. What the disc may stretch across, as a mean squared slope: the lobe of polished
/// varnish is as wide. Where it stretches more, it mirrors lamps that no normal of the bend does.
constexpr float kStretchOfADisc = 0.02f * 0.02f;

/// The first sample, in order of their normals along a bend, beyond the bend's widest gap: two
/// sides of a crease, or halves of what is bent evenly. The samples' count where a disc will do.
std::size_t bend_among(std::span<Sample*> samples) {
    const glm::vec3 first = samples.front()->normal;
    const auto farthest_from = [&](const glm::vec3& from) {
        glm::vec3 farthest = from;
        float distance2 = 0.0f;
        for (const Sample* s : samples) {
            const glm::vec3 apart = s->normal - from;
            if (glm::dot(apart, apart) <= distance2) continue;
            distance2 = glm::dot(apart, apart);
            farthest = s->normal;
        }
        return farthest;
    };
    // Nothing is spread more than half of its longest extent squared
    const glm::vec3 one_end = farthest_from(first);
    const glm::vec3 extent = farthest_from(one_end) - one_end;
    if (glm::dot(extent, extent) < 8.0f * kStretchOfADisc) return samples.size();
    const glm::vec3 axis = glm::normalize(extent);

    const auto count = static_cast<float>(samples.size());
    glm::vec3 sum(0.0f);
    float squares = 0.0f, squares_along = 0.0f;
    for (const Sample* s : samples) {
        const glm::vec3 apart = s->normal - first;
        const float along = glm::dot(apart, axis);
        sum += apart;
        squares += glm::dot(apart, apart);
        squares_along += along * along;
    }
    const float sum_along = glm::dot(sum, axis);
    const float along = (squares_along - sum_along * sum_along / count) / count;
    const float both = (squares - glm::dot(sum, sum) / count) / count;
    // A disc has half of its spread across; the bend has both - along
    if (0.5f * both - (both - along) < kStretchOfADisc) return samples.size();

    std::sort(samples.begin(), samples.end(), [&](const Sample* a, const Sample* b) {
        return glm::dot(a->normal, axis) < glm::dot(b->normal, axis);
    });
    glm::vec3 below(0.0f);
    float widest = -1.0f;
    std::size_t best = samples.size();
    for (std::size_t k = 1; k < samples.size(); ++k) {
        below += samples[k - 1]->normal - first;
        const auto under = static_cast<float>(k), over = count - under;
        const glm::vec3 apart = (sum - below) / over - below / under;
        const float between = glm::dot(apart, apart) * under * over;
        if (between <= widest) continue;
        widest = between;
        best = k;
    }
    return best;
}

/// Unit normals of the triangles themselves, as their corners turn.
std::vector<glm::vec3> face_normals(const Mesh& mesh) {
    std::vector<glm::vec3> normals(mesh.triangles.size());
    parallel_for(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3 corner = mesh.triangles[i];
            const glm::vec3 a = mesh.positions_mm[corner.x];
            const glm::dvec3 across = glm::cross(glm::dvec3(mesh.positions_mm[corner.y] - a),
                                                 glm::dvec3(mesh.positions_mm[corner.z] - a));
            const double twice_area = glm::length(across);
            normals[i] = twice_area > 0.0 ? glm::vec3(across / twice_area) : glm::vec3(0.0f);
        }
    });
    return normals;
}

/// surface_point() less what a mean over many samples makes up for.
Sample sample_of(const Mesh& mesh,
                 const std::vector<glm::vec3>& faces,
                 const Hit& hit,
                 const glm::vec3& direction) {
    const glm::uvec3 corner = mesh.triangles[hit.triangle];
    const float v = hit.barycentric.x, w = hit.barycentric.y, u = 1.0f - v - w;
    const auto blend = [&](const auto& values) {
        return u * values[corner.x] + v * values[corner.y] + w * values[corner.z];
    };
    Sample sample;
    sample.part = mesh.triangle_part[hit.triangle];
    sample.place = {hit.triangle, hit.barycentric};
    sample.face_normal = faces[hit.triangle];
    // From a corner and two edges: exact on the plane of a far-away triangle to its own size.
    const glm::vec3 a = mesh.positions_mm[corner.x];
    sample.position_mm =
        a + v * (mesh.positions_mm[corner.y] - a) + w * (mesh.positions_mm[corner.z] - a);
    // Opposite vertex normals cancel halfway: the triangle's own normal is the answer there.
    const glm::vec3 normal = blend(mesh.normals);
    const float length = glm::length(normal);
    sample.normal = length > 1e-6f ? normal / length : sample.face_normal;
    sample.tangent = blend(mesh.tangents);
    // An open surface shows its inside: the side that is lit is the side that is shaded
    if (glm::dot(sample.face_normal, direction) > 0.0f) {
        sample.face_normal = -sample.face_normal;
        sample.normal = -sample.normal;
    }
    return sample;
}

void append_mean(std::span<const Sample> samples,
                 std::size_t group,
                 std::uint32_t pixel,
                 std::size_t per_pixel,
                 Tile& tile) {
    Fragment fragment;
    fragment.pixel = pixel;
    std::size_t count = 0;
    const Sample* first = nullptr;
    glm::vec3 apart(0.0f), normal(0.0f);
    glm::vec4 tangents(0.0f);
    const std::size_t kept_from = tile.samples.size();
    for (const Sample& s : samples) {
        if (s.group != group) continue;
        if (!first) first = &s;
        apart += s.position_mm - first->position_mm;
        normal += s.normal;
        tangents += s.tangent;
        if (count < kSamplesAFragment) tile.samples.push_back(s.place);
        ++count;
    }
    fragment.part = first->part;
    fragment.position_mm = first->position_mm + apart / static_cast<float>(count);
    fragment.normal = glm::normalize(normal);
    fragment.coverage = static_cast<float>(count) / static_cast<float>(per_pixel);

    // Mean squared slope around the mean normal
    for (const Sample& s : samples) {
        if (s.group != group) continue;
        const float c = glm::dot(s.normal, fragment.normal);
        const glm::vec3 across = s.normal - c * fragment.normal;
        fragment.normal_variance += glm::dot(across, across) / (c * c);
    }
    fragment.normal_variance /= static_cast<float>(count);

    // Tangent in the plane of the mean normal; any one where the samples' tangents cancel
    glm::vec3 tangent(tangents);
    tangent -= glm::dot(tangent, fragment.normal) * fragment.normal;
    if (glm::dot(tangent, tangent) < 1e-12f) {
        const glm::vec3 n = fragment.normal;
        const glm::vec3 axis = std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        tangent = glm::cross(axis, n);
    }
    fragment.tangent = glm::vec4(glm::normalize(tangent), tangents.w < 0.0f ? -1.0f : 1.0f);
    for (std::size_t k = count; k < kSamplesAFragment; ++k) {
        tile.samples.push_back(tile.samples[kept_from + k - count]);
    }
    tile.fragments.push_back(fragment);
}

/// What grouping a pixel's samples needs room for.
struct Grouping {
    std::vector<const Sample*> first;  ///< of each group
    std::vector<Sample*> of_one;
};

/// Parts the group at its bends; returns how many groups there are then.
std::size_t split_at_bends(std::span<Sample> samples,
                           std::size_t group,
                           std::size_t groups,
                           std::vector<Sample*>& of_one) {
    of_one.clear();
    for (Sample& s : samples) {
        if (s.group == group) of_one.push_back(&s);
    }
    const std::size_t bend = bend_among(of_one);
    if (bend == of_one.size()) return groups;
    for (std::size_t k = bend; k < of_one.size(); ++k) {
        of_one[k]->group = static_cast<std::uint16_t>(groups);
    }
    const std::size_t with_new = split_at_bends(samples, groups, groups + 1, of_one);
    return split_at_bends(samples, group, with_new, of_one);
}

/// Sorts a pixel's samples into groups that a mean can stand for and appends their fragments.
void append_fragments(std::span<Sample> samples,
                      std::uint32_t pixel,
                      std::size_t per_pixel,
                      float footprint_mm,
                      Grouping& grouping,
                      Tile& tile) {
    std::vector<const Sample*>& first = grouping.first;
    first.clear();
    for (Sample& s : samples) {
        const auto found = std::find_if(first.begin(), first.end(), [&](const Sample* f) {
            return !breaks_from(*f, s, footprint_mm);
        });
        s.group = static_cast<std::uint16_t>(found - first.begin());
        if (found == first.end()) first.push_back(&s);
    }
    std::size_t groups = first.size();
    for (std::size_t group = 0; group < first.size(); ++group) {
        groups = split_at_bends(samples, group, groups, grouping.of_one);
    }
    for (std::size_t group = 0; group < groups; ++group) {
        append_mean(samples, group, pixel, per_pixel, tile);
    }
}

/// From pixel by pixel to part by part.
void sort_by_part(Tile& tile) {
    const auto by_part = [](const Fragment& a, const Fragment& b) { return a.part < b.part; };
    if (std::is_sorted(tile.fragments.begin(), tile.fragments.end(), by_part)) return;
    std::vector<std::size_t> order(tile.fragments.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return by_part(tile.fragments[a], tile.fragments[b]);
    });
    Tile sorted;
    for (const std::size_t i : order) {
        sorted.fragments.push_back(tile.fragments[i]);
        const auto kept = tile.samples.begin() + static_cast<std::ptrdiff_t>(i * kSamplesAFragment);
        sorted.samples.insert(sorted.samples.end(), kept, kept + kSamplesAFragment);
    }
    tile = std::move(sorted);
}

class TileSolver {
  public:
    TileSolver(const Mesh& mesh, const Tracer& tracer, const View& view, int side)
        : mesh_(mesh),
          tracer_(tracer),
          view_(view),
          origin_(centre_in_world(view)),
          places_(sample_places(side)),
          faces_(face_normals(mesh)) {}

    Tile solve(glm::ivec2 tile) const;

  private:
    void aim(const TileRays& lens, int x_begin, int x_end, int y, std::span<glm::vec3> to) const;

    const Mesh& mesh_;
    const Tracer& tracer_;
    const View& view_;
    const glm::vec3 origin_;
    const std::vector<glm::dvec2> places_;
    const std::vector<glm::vec3> faces_;
};

/// Directions through the samples of a row of pixels; of no length where the lens model reaches
/// none.
void TileSolver::aim(
    const TileRays& lens, int x_begin, int x_end, int y, std::span<glm::vec3> to) const {
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const glm::dvec2 place = places_[k];
        const auto row = lens.row(y + place.y);
        std::size_t at = k;
        for (int x = x_begin; x < x_end; ++x, at += places_.size()) {
            if (row) {
                to[at] = row->direction((x - x_begin + place.x) / kTile_px);
            } else {
                to[at] = lens.direction(glm::dvec2(x, y) + place).value_or(glm::vec3(0.0f));
            }
        }
    }
}

Tile TileSolver::solve(glm::ivec2 tile) const {
    const TileRays lens(view_, tile);
    const int x_begin = tile.x * kTile_px;
    const int x_end = std::min(x_begin + kTile_px, view_.width);
    const int y_end = std::min((tile.y + 1) * kTile_px, view_.height);
    const auto focal_px = static_cast<float>(std::min(view_.focal_px.x, view_.focal_px.y));
    const std::size_t per_pixel = places_.size();

    // Rays of one row of the tile at a time stay in the cache
    std::vector<glm::vec3> directions(static_cast<std::size_t>(x_end - x_begin) * per_pixel);
    std::vector<Hit> hits(directions.size());
    std::vector<Sample> samples(per_pixel);
    Grouping groups;
    Tile result;
    for (int y = tile.y * kTile_px; y < y_end; ++y) {
        aim(lens, x_begin, x_end, y, directions);
        tracer_.closest_from(origin_, directions, hits);
        for (int x = x_begin; x < x_end; ++x) {
            const std::size_t begin = static_cast<std::size_t>(x - x_begin) * per_pixel;
            std::size_t count = 0;
            float farthest = 0.0f;
            for (std::size_t i = begin; i < begin + per_pixel; ++i) {
                if (!hits[i].valid()) continue;
                farthest = std::max(farthest, hits[i].t);
                samples[count++] = sample_of(mesh_, faces_, hits[i], directions[i]);
            }
            if (count == 0) continue;
            append_fragments(std::span(samples).first(count),
                             static_cast<std::uint32_t>(y * view_.width + x),
                             per_pixel,
                             farthest * glm::length(directions[begin]) / focal_px,
                             groups,
                             result);
        }
    }
    sort_by_part(result);
    return result;
}

/// All tiles' runs in the order of the map.
std::vector<Run> runs_of(const std::vector<Tile>& tiles, int width) {
    const auto row_width = static_cast<std::uint32_t>(width);
    std::vector<Run> runs;
    for (const Tile& tile : tiles) {
        const std::vector<Fragment>& all = tile.fragments;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i == 0 || all[i].part != all[i - 1].part ||
                all[i].pixel / row_width != all[i - 1].pixel / row_width) {
                runs.push_back({all[i].part, all[i].pixel, &tile, i, i, 0});
            }
            runs.back().end = i + 1;
        }
    }
    std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
        return a.part != b.part ? a.part < b.part : a.first_pixel < b.first_pixel;
    });
    std::size_t place = 0;
    for (Run& run : runs) {
        run.place = place;
        place += run.end - run.begin;
    }
    return runs;
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

    const TileSolver solver(mesh, tracer, view, side);
    const std::vector<glm::ivec2> tiles = tiles_that_see(mesh, view);
    std::vector<Tile> solved(tiles.size());
    parallel_for(tiles.size(), 8, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) solved[i] = solver.solve(tiles[i]);
    });
    progress.update(0.9, "seeing the product");

    const std::vector<Run> runs = runs_of(solved, view.width);
    const std::size_t count =
        runs.empty() ? 0 : runs.back().place + runs.back().end - runs.back().begin;
    SurfaceMap map;
    map.width = view.width;
    map.height = view.height;
    map.samples_per_pixel = samples_per_pixel;
    map.coverage = ImageF(view.width, view.height, 1);
    map.part_begin.assign(mesh.parts.size() + 1, 0);
    for (const Run& run : runs) {
        map.part_begin[run.part + 1u] += static_cast<std::uint32_t>(run.end - run.begin);
        for (std::size_t i = run.begin; i < run.end; ++i) {
            const Fragment& f = run.tile->fragments[i];
            float& covered = map.coverage.values[f.pixel];
            if (covered == 0.0f) ++map.covered_pixels;
            covered += f.coverage;
        }
    }
    for (std::size_t p = 1; p < map.part_begin.size(); ++p) {
        map.part_begin[p] += map.part_begin[p - 1];
    }
    map.fragments.resize(count);
    map.samples.resize(count * kSamplesAFragment);
    parallel_for(runs.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            const Run& run = runs[r];
            std::copy(run.tile->fragments.data() + run.begin,
                      run.tile->fragments.data() + run.end,
                      map.fragments.data() + run.place);
            std::copy(run.tile->samples.data() + run.begin * kSamplesAFragment,
                      run.tile->samples.data() + run.end * kSamplesAFragment,
                      map.samples.data() + run.place * kSamplesAFragment);
        }
    });
    progress.update(1.0, "seeing the product");
    return map;
}

}  // namespace livery
