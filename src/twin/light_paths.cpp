#include "twin/light_paths.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "twin/pixel_rays.h"
#include "twin/place.h"

namespace livery {

namespace {

constexpr int kBlockPixels = 64;  ///< traced together, so that rays are coherent

/// Sums small unordered lists of terms into sorted, merged ones.
template <typename Term, typename Key, typename Value>
void append_merged(std::vector<Term>& from, std::vector<Term>& to, Key key, Value value) {
    std::sort(
        from.begin(), from.end(), [&](const Term& a, const Term& b) { return key(a) < key(b); });
    const std::size_t first = to.size();
    for (const Term& term : from) {
        if (to.size() > first && key(to.back()) == key(term)) {
            value(to.back()) += value(term);
        } else {
            to.push_back(term);
        }
    }
    from.clear();
}

/// One receiver while its sub-samples come in, then the lists of a row.
struct RowPaths {
    LightPaths paths;  ///< term_begin and cover_begin hold counts here
    std::vector<PathTerm> terms;
    std::vector<CoverTerm> covers;

    void finish(std::uint32_t receiver, const glm::dvec3& position, const glm::dvec3& normal) {
        const auto terms_before = paths.terms.size(), covers_before = paths.covers.size();
        append_merged(
            terms,
            paths.terms,
            [](const PathTerm& t) {
                return (static_cast<std::uint64_t>(t.surface) << 32u) | t.pixel;
            },
            [](auto& t) -> auto& { return t.weight; });
        append_merged(
            covers, paths.covers, [](const CoverTerm& t) { return t.surface; }, [
            ](auto& t) -> auto& { return t.share; });
        paths.receiver.push_back(receiver);
        paths.term_begin.push_back(static_cast<std::uint32_t>(paths.terms.size() - terms_before));
        paths.cover_begin.push_back(
            static_cast<std::uint32_t>(paths.covers.size() - covers_before));
        paths.position_mm.emplace_back(position);
        const double length = glm::length(normal);
        paths.normal.emplace_back(length > 1e-9 ? normal / length : glm::dvec3(0.0, 1.0, 0.0));
    }
};

/// Rows into one list; counts become offsets.
LightPaths joined(std::vector<RowPaths>& rows) {
    LightPaths all;
    const auto append = [](auto& to, auto& from) {
        to.insert(to.end(), from.begin(), from.end());
        std::decay_t<decltype(from)>().swap(from);
    };
    std::size_t receivers = 0, terms = 0, covers = 0;
    for (const RowPaths& row : rows) {
        receivers += row.paths.receiver.size();
        terms += row.paths.terms.size();
        covers += row.paths.covers.size();
    }
    all.receiver.reserve(receivers);
    all.terms.reserve(terms);
    all.covers.reserve(covers);
    all.position_mm.reserve(receivers);
    all.normal.reserve(receivers);
    all.term_begin.reserve(receivers + 1);
    all.cover_begin.reserve(receivers + 1);
    for (RowPaths& row : rows) {
        append(all.receiver, row.paths.receiver);
        append(all.terms, row.paths.terms);
        append(all.covers, row.paths.covers);
        append(all.position_mm, row.paths.position_mm);
        append(all.normal, row.paths.normal);
        append(all.term_begin, row.paths.term_begin);
        append(all.cover_begin, row.paths.cover_begin);
    }
    const auto to_offsets = [](std::vector<std::uint32_t>& counts) {
        std::uint32_t sum = 0;
        for (auto& count : counts) {
            const std::uint32_t here = count;
            count = sum;
            sum += here;
        }
        counts.push_back(sum);
    };
    to_offsets(all.term_begin);
    to_offsets(all.cover_begin);
    return all;
}

void add_terms(const SurfaceFactors& factors,
               const Illumination& light,
               double share,
               std::vector<PathTerm>& terms) {
    for (int k = 0; k < factors.count; ++k) {
        const auto& [surface, factor] = factors.list[static_cast<std::size_t>(k)];
        const auto weight = static_cast<float>(share * light.irradiance * factor);
        if (weight > 0.0f) terms.push_back({light.pixel, surface, weight});
    }
}

void add_covers(const SurfaceFactors& shares, double share, std::vector<CoverTerm>& covers) {
    for (int k = 0; k < shares.count; ++k) {
        const auto& [surface, factor] = shares.list[static_cast<std::size_t>(k)];
        covers.push_back({surface, static_cast<float>(share * factor)});
    }
}

/// Rows of `rectangle` in parallel, blocks of pixels in each; body(row, y, x0, x1, rays, hits).
template <typename Body>
std::vector<RowPaths> for_blocks(const TracedWorld& world,
                                 const PixelRays& pixel_rays,
                                 const PixelRectangle& rectangle,
                                 const Progress& progress,
                                 const Body& body) {
    std::vector<RowPaths> rows(static_cast<std::size_t>(rectangle.bottom - rectangle.top));
    parallel_for(rows.size(), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<TraceRay> rays;
        std::vector<Hit> hits;
        for (std::size_t r = begin; r < end; ++r) {
            progress.check_stop();
            const int y = rectangle.top + static_cast<int>(r);
            for (int x0 = rectangle.left; x0 < rectangle.right; x0 += kBlockPixels) {
                const int x1 = std::min(x0 + kBlockPixels, rectangle.right);
                rays.clear();
                for (int x = x0; x < x1; ++x) pixel_rays.add(x, y, rays);
                hits.assign(rays.size(), Hit{});
                world.tracer.closest(rays, hits);
                body(rows[r], y, x0, x1, rays, hits);
            }
        }
    });
    return rows;
}

}  // namespace

LightPaths trace_camera(const TracedWorld& world, const Progress& progress) {
    const View& view = world.bench.camera.view;
    const glm::dvec3 camera_mm = centre_in_world(view);
    const glm::dvec3 projector_mm = centre_in_world(world.bench.projector.view);
    const int samples = world.bench.samples_a_side * world.bench.samples_a_side;
    const PixelRectangle rectangle = pixels_that_see(view, world.mesh);
    const PixelRays pixel_rays(view, rectangle, world.bench.samples_a_side);

    auto rows = for_blocks(
        world,
        pixel_rays,
        rectangle,
        progress,
        [&](RowPaths& row,
            int y,
            int x0,
            int x1,
            const std::vector<TraceRay>&,
            const std::vector<Hit>& hits) {
            // Light that would reach each sub-sample, then whether something stands in its way.
            std::vector<MeshPlace> places(hits.size());
            std::vector<std::optional<Illumination>> lights(hits.size());
            std::vector<TraceRay> shadow_rays;
            std::vector<std::size_t> shadow_of;
            for (std::size_t k = 0; k < hits.size(); ++k) {
                if (!hits[k].valid()) continue;
                const MeshPlace place = places[k] = mesh_place(world.mesh, hits[k]);
                if (glm::dot(place.geometric_normal, projector_mm - place.position_mm) <= 0.0)
                    continue;
                if (glm::dot(place.geometric_normal, camera_mm - place.position_mm) <= 0.0)
                    continue;
                lights[k] = illumination_of(
                    world.bench.projector, world.reference_mm, place.position_mm, place.normal);
                if (!lights[k]) continue;
                shadow_rays.push_back(
                    shadow_ray(place.position_mm, place.geometric_normal, projector_mm));
                shadow_of.push_back(k);
            }
            std::vector<std::uint8_t> blocked(shadow_rays.size());
            world.tracer.occluded(shadow_rays, blocked);
            for (std::size_t s = 0; s < blocked.size(); ++s) {
                if (blocked[s]) lights[shadow_of[s]].reset();
            }

            // Shares of each camera pixel.
            const glm::dvec2 half(0.5 * view.width, 0.5 * view.height);
            for (int x = x0; x < x1; ++x) {
                const auto first = static_cast<std::size_t>((x - x0) * samples);
                const glm::dvec2 off = glm::dvec2(x + 0.5, y + 0.5) - half;
                const double share = (1.0 - world.bench.camera.vignetting * glm::dot(off, off) /
                                                glm::dot(half, half)) /
                                     samples;
                glm::dvec3 position(0.0), normal(0.0);
                int count = 0;
                for (std::size_t k = first; k < first + static_cast<std::size_t>(samples); ++k) {
                    if (!hits[k].valid()) continue;
                    const MeshPlace& place = places[k];
                    ++count;
                    position += place.position_mm;
                    normal += place.normal;
                    add_covers(surface_shares(world.surfaces, place.part, place.position_mm),
                               share,
                               row.covers);
                    if (!lights[k]) continue;
                    add_terms(surface_factors(world.surfaces,
                                              place.part,
                                              place.position_mm,
                                              place.normal,
                                              glm::normalize(projector_mm - place.position_mm),
                                              glm::normalize(camera_mm - place.position_mm)),
                              *lights[k],
                              share,
                              row.terms);
                }
                if (count == 0) continue;
                row.finish(static_cast<std::uint32_t>(y * view.width + x),
                           position / double(count),
                           normal);
            }
        });
    return joined(rows);
}

ProjectorPaths trace_projector(const TracedWorld& world, const Progress& progress) {
    const View& view = world.bench.projector.view;
    const glm::dvec3 projector_mm = centre_in_world(view);
    const glm::dvec3 eye_mm = world.bench.eye_mm;
    const int side = world.bench.samples_a_side;
    const int samples = side * side;
    const PixelRectangle rectangle = pixels_that_see(view, world.mesh);
    const PixelRays pixel_rays(view, rectangle, world.bench.samples_a_side);

    ProjectorPaths result;
    result.lit = Image8(view.width, view.height, 1);
    result.seen_by_eye = result.lit;
    result.edge = result.lit;
    Image8 mixed = result.lit;  // more than one part, or part of the pixel misses
    Image16 part_of(view.width, view.height, 1, 0xffff);
    ImageF place_of_pixel(view.width, view.height, 6);  // mean position and normal

    auto rows = for_blocks(
        world,
        pixel_rays,
        rectangle,
        progress,
        [&](RowPaths& row,
            int y,
            int x0,
            int x1,
            const std::vector<TraceRay>&,
            const std::vector<Hit>& hits) {
            for (int x = x0; x < x1; ++x) {
                const auto first = static_cast<std::size_t>((x - x0) * samples);
                const auto own = static_cast<std::uint32_t>(y * view.width + x);
                glm::dvec3 position(0.0), normal(0.0);
                int lit = 0, lit_mockup = 0, hit_count = 0, looked = 0, seen = 0;
                bool parts_differ = false;
                for (std::size_t k = first; k < first + static_cast<std::size_t>(samples); ++k) {
                    if (!hits[k].valid()) continue;
                    const MeshPlace place = mesh_place(world.mesh, hits[k]);
                    ++hit_count;
                    auto& part = part_of.at(x, y);
                    if (part != 0xffff && part != place.part) parts_differ = true;
                    part = place.part;
                    if (glm::dot(place.geometric_normal, projector_mm - place.position_mm) <= 0.0)
                        continue;
                    auto light = illumination_of(
                        world.bench.projector, world.reference_mm, place.position_mm, place.normal);
                    if (!light) continue;
                    light->pixel = own;  // rounding must not hand the patch to a neighbour
                    ++lit;
                    lit_mockup += place.part < world.mockup_parts;
                    position += place.position_mm;
                    normal += place.normal;
                    // Half of a pixel is not worth sixteen rays: the grid's diagonal is asked.
                    if ((k - first) % static_cast<std::size_t>(side + 1) == 0) {
                        ++looked;
                        seen +=
                            sees(world.tracer, place.position_mm, place.geometric_normal, eye_mm);
                    }
                    add_covers(surface_shares(world.surfaces, place.part, place.position_mm),
                               1.0,
                               row.covers);
                    add_terms(surface_factors(world.surfaces,
                                              place.part,
                                              place.position_mm,
                                              place.normal,
                                              glm::normalize(projector_mm - place.position_mm),
                                              glm::normalize(eye_mm - place.position_mm)),
                              *light,
                              1.0,
                              row.terms);
                }
                if (hit_count > 0 && (hit_count < samples || parts_differ)) mixed.at(x, y) = 255;
                if (lit == 0) continue;
                for (auto& term : row.terms) term.weight /= static_cast<float>(lit);
                for (auto& cover : row.covers) cover.share /= static_cast<float>(lit);
                position /= double(lit);
                if (2 * lit_mockup >= samples) result.lit.at(x, y) = 255;
                if (looked > 0 && 2 * seen >= looked) result.seen_by_eye.at(x, y) = 255;
                row.finish(own, position, normal);
                const glm::vec3 mean = row.paths.normal.back();
                for (int c = 0; c < 3; ++c) {
                    place_of_pixel.at(x, y, c) = static_cast<float>(position[c]);
                    place_of_pixel.at(x, y, 3 + c) = mean[c];
                }
            }
        });
    result.paths = joined(rows);

    // Edges: mixed pixels, neighbours of another part, and neighbours off each other's tangent
    // plane.
    const auto is_edge = [&](int x, int y, int u, int v) {
        if (part_of.at(x, y) != part_of.at(u, v)) return true;
        if (!result.lit.at(x, y) || !result.lit.at(u, v)) return false;
        const float* a = place_of_pixel.pixel(x, y);
        const float* b = place_of_pixel.pixel(u, v);
        const glm::dvec3 step(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        const double off_a = std::abs(step.x * a[3] + step.y * a[4] + step.z * a[5]);
        const double off_b = std::abs(step.x * b[3] + step.y * b[4] + step.z * b[5]);
        const double pixel_mm =
            glm::length(glm::dvec3(a[0], a[1], a[2]) - projector_mm) / view.focal_px.x;
        return std::min(off_a, off_b) > 2.0 * pixel_mm;
    };
    constexpr int kReach = 2;
    for (int y = rectangle.top; y < rectangle.bottom; ++y) {
        for (int x = rectangle.left; x < rectangle.right; ++x) {
            bool edge = mixed.at(x, y) != 0;
            if (!edge && x + 1 < view.width) edge = is_edge(x, y, x + 1, y);
            if (!edge && y + 1 < view.height) edge = is_edge(x, y, x, y + 1);
            if (!edge) continue;
            for (int v = std::max(0, y - kReach); v <= std::min(view.height - 1, y + kReach); ++v) {
                for (int u = std::max(0, x - kReach); u <= std::min(view.width - 1, x + kReach);
                     ++u) {
                    result.edge.at(u, v) = 255;
                }
            }
        }
    }
    return result;
}

}  // namespace livery
