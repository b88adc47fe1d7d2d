#include "twin/light_paths.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/image.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/view.h"
#include "twin/place.h"

namespace livery {

namespace {

/// What each pixel of a view lies on, collected while its rays are traced.
struct PixelGround {
    explicit PixelGround(const View& view);

    Image8 seen;   ///< 255 where at least half of the pixel lies on the mock-up
    Image8 lit;    ///< 255 where at least half of the pixel lies on lit mock-up
    Image8 mixed;  ///< 255: more than one part, or only some of the pixel is met (or lit)
    Image16 part;  ///< the mesh's part; 0xffff: none
    ImageF place;  ///< 6 channels: mean position in mm, mean unit normal
};

PixelGround::PixelGround(const View& view)
    : seen(view.width, view.height, 1),
      lit(view.width, view.height, 1),
      mixed(view.width, view.height, 1),
      part(view.width, view.height, 1, 0xffff),
      place(view.width, view.height, 6) {}

/// 255 within 2 px of a silhouette, depth or part edge: of mixed pixels, of neighbours on different
/// parts, and of lit neighbours off each other's tangent plane by more than two pixels' width.
Image8 edge_band(const PixelGround& ground, const View& view, const PixelRectangle& rectangle) {
    const glm::dvec3 view_mm = centre_in_world(view);
    const auto is_edge = [&](int x, int y, int u, int v) {
        if (ground.part.at(x, y) != ground.part.at(u, v)) return true;
        if (!ground.lit.at(x, y) || !ground.lit.at(u, v)) return false;
        const float* a = ground.place.pixel(x, y);
        const float* b = ground.place.pixel(u, v);
        const glm::dvec3 step(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        const double off_a = std::abs(step.x * a[3] + step.y * a[4] + step.z * a[5]);
        const double off_b = std::abs(step.x * b[3] + step.y * b[4] + step.z * b[5]);
        const double pixel_mm =
            glm::length(glm::dvec3(a[0], a[1], a[2]) - view_mm) / view.focal_px.x;
        return std::min(off_a, off_b) > 2.0 * pixel_mm;
    };
    constexpr int kReach = 2;
    Image8 band(view.width, view.height, 1);
    for (int y = rectangle.top; y < rectangle.bottom; ++y) {
        for (int x = rectangle.left; x < rectangle.right; ++x) {
            bool edge = ground.mixed.at(x, y) != 0;
            if (!edge && x + 1 < view.width) edge = is_edge(x, y, x + 1, y);
            if (!edge && y + 1 < view.height) edge = is_edge(x, y, x, y + 1);
            if (!edge) continue;
            for (int v = std::max(0, y - kReach); v <= std::min(view.height - 1, y + kReach); ++v) {
                for (int u = std::max(0, x - kReach); u <= std::min(view.width - 1, x + kReach);
                     ++u) {
                    band.at(u, v) = 255;
                }
            }
        }
    }
    return band;
}

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

void set_place(
    PixelGround& ground, int x, int y, const glm::dvec3& position_mm, const glm::vec3& normal) {
    for (int c = 0; c < 3; ++c) {
        ground.place.at(x, y, c) = static_cast<float>(position_mm[c]);
        ground.place.at(x, y, 3 + c) = normal[c];
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

namespace {

/// What a camera or an eye sees; `vignetting` is its lens's. `ground`, where given, is told what
/// each pixel lies on.
LightPaths trace_view(const TracedWorld& world,
                      const View& view,
                      double vignetting,
                      const PixelRectangle& rectangle,
                      PixelGround* ground,
                      const Progress& progress) {
    const glm::dvec3 camera_mm = centre_in_world(view);
    const glm::dvec3 projector_mm = centre_in_world(world.bench.projector.view);
    const int samples = world.bench.samples_a_side * world.bench.samples_a_side;
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
                const double share =
                    (1.0 - vignetting * glm::dot(off, off) / glm::dot(half, half)) / samples;
                glm::dvec3 position(0.0), normal(0.0);
                int count = 0, on_mockup = 0, lit_mockup = 0;
                std::uint16_t part = 0;
                bool differ = false;
                for (std::size_t k = first; k < first + static_cast<std::size_t>(samples); ++k) {
                    if (!hits[k].valid()) continue;
                    const MeshPlace& place = places[k];
                    differ = differ || (count > 0 && place.part != part);
                    part = place.part;
                    ++count;
                    on_mockup += place.part < world.mockup_parts;
                    position += place.position_mm;
                    normal += place.normal;
                    add_covers(surface_shares(world.surfaces, place.part, place.position_mm),
                               share,
                               row.covers);
                    if (!lights[k]) continue;
                    lit_mockup += place.part < world.mockup_parts;
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
                position /= double(count);
                row.finish(static_cast<std::uint32_t>(y * view.width + x), position, normal);
                if (!ground) continue;
                ground->part.at(x, y) = part;
                ground->seen.at(x, y) = 2 * on_mockup >= samples ? 255 : 0;
                ground->lit.at(x, y) = 2 * lit_mockup >= samples ? 255 : 0;
                ground->mixed.at(x, y) =
                    differ || count < samples || (lit_mockup > 0 && lit_mockup < count) ? 255 : 0;
                set_place(*ground, x, y, position, row.paths.normal.back());
            }
        });
    return joined(rows);
}

}  // namespace

LightPaths trace_camera(const TracedWorld& world, const Progress& progress) {
    const View& view = world.bench.camera.view;
    return trace_view(world,
                      view,
                      world.bench.camera.vignetting,
                      pixels_that_see(view, world.mesh),
                      nullptr,
                      progress);
}

ObservedPaths trace_eye(const TracedWorld& world, const View& eye, const Progress& progress) {
    const PixelRectangle rectangle = pixels_that_see(eye, world.mesh);
    PixelGround ground(eye);
    ObservedPaths result;
    result.paths = trace_view(world, eye, 0.0, rectangle, &ground, progress);
    result.edge = edge_band(ground, eye, rectangle);
    result.lit = std::move(ground.lit);
    result.seen_by_eye = std::move(ground.seen);
    return result;
}

ObservedPaths trace_projector(const TracedWorld& world, const Progress& progress) {
    const View& view = world.bench.projector.view;
    const glm::dvec3 projector_mm = centre_in_world(view);
    const glm::dvec3 eye_mm = world.bench.eye_mm;
    const int side = world.bench.samples_a_side;
    const int samples = side * side;
    const PixelRectangle rectangle = pixels_that_see(view, world.mesh);
    const PixelRays pixel_rays(view, rectangle, world.bench.samples_a_side);

    ObservedPaths result;
    result.seen_by_eye = Image8(view.width, view.height, 1);
    PixelGround ground(view);

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
                    auto& part = ground.part.at(x, y);
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
                if (hit_count > 0 && (hit_count < samples || parts_differ))
                    ground.mixed.at(x, y) = 255;
                if (lit == 0) continue;
                for (auto& term : row.terms) term.weight /= static_cast<float>(lit);
                for (auto& cover : row.covers) cover.share /= static_cast<float>(lit);
                position /= double(lit);
                if (2 * lit_mockup >= samples) ground.lit.at(x, y) = 255;
                if (looked > 0 && 2 * seen >= looked) result.seen_by_eye.at(x, y) = 255;
                row.finish(own, position, normal);
                set_place(ground, x, y, position, row.paths.normal.back());
            }
        });
    result.paths = joined(rows);

    result.edge = edge_band(ground, view, rectangle);
    result.lit = std::move(ground.lit);
    return result;
}

}  // namespace livery
