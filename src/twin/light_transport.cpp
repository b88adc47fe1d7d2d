#include "twin/light_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "core/hash.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tracing/tracer.h"
#include "twin/place.h"
#include "twin/received.h"

namespace livery {

namespace {

/// The face of a cube that a normal looks through: 0 to 5.
int facing_of(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
}

std::uint64_t key_of(const glm::ivec3& cell, int facing) {
    const auto bits = [](int value) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value + (1 << 19)) & 0xfffffu);
    };
    return (bits(cell.x) << 43u) | (bits(cell.y) << 23u) | (bits(cell.z) << 3u) |
           static_cast<std::uint64_t>(facing);
}

/// Cosine-weighted direction around a normal from two numbers in [0, 1).
glm::dvec3 cosine_direction(const glm::dvec3& normal, double u, double v) {
    const double radius = std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
    const glm::dvec3 helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 side = glm::normalize(glm::cross(normal, helper));
    return radius * (std::cos(angle) * side + std::sin(angle) * glm::cross(normal, side)) +
           std::sqrt(std::max(0.0, 1.0 - u)) * normal;
}

}  // namespace

void GatherPlaces::add(const LightPaths& receivers) {
    for (std::size_t i = 0; i < receivers.receiver.size(); ++i) {
        const glm::dvec3 position(receivers.position_mm[i]), normal(receivers.normal[i]);
        const glm::ivec3 cell(glm::floor(position / cell_mm_));
        const auto [found, is_new] = index_.try_emplace(key_of(cell, facing_of(normal)),
                                                        static_cast<std::uint32_t>(places_.size()));
        if (is_new) places_.emplace_back();
        Place& place = places_[found->second];
        place.mean_mm = (place.mean_mm * place.count + position) / (place.count + 1.0);
        place.count += 1.0;
        // A mean of places on a bent surface lies off it; one of the places lies on it.
        if (is_new || glm::distance(position, place.mean_mm) <
                          glm::distance(place.position_mm, place.mean_mm)) {
            place.position_mm = position;
            place.normal = normal;
        }
    }
}

Gathers GatherPlaces::gather(const TracedWorld& world,
                             int rays_a_place,
                             const Progress& progress) const {
    const glm::dvec3 projector_mm = centre_in_world(world.bench.projector.view);
    std::vector<std::vector<PathTerm>> lists(places_.size());
    parallel_for(places_.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            progress.check_stop();
            std::vector<PathTerm> terms;
            for (int r = 0; r < rays_a_place; ++r) {
                // Strata along the first number, a rotated golden-ratio sequence along the second.
                const double turn = hash_3d(static_cast<std::uint32_t>(p), 77u, 5u) * 0x1p-32;
                const double v = turn + (r + 0.5) * (std::numbers::phi - 1.0);
                TraceRay ray;
                ray.origin =
                    offset_origin(glm::vec3(places_[p].position_mm), glm::vec3(places_[p].normal));
                ray.direction = glm::vec3(cosine_direction(
                    places_[p].normal, (r + 0.5) / rays_a_place, v - std::floor(v)));
                const Hit hit = world.tracer.closest(ray);
                if (!hit.valid()) continue;
                const MeshPlace other = mesh_place(world.mesh, hit);
                if (glm::dot(other.geometric_normal, glm::dvec3(ray.direction)) >= 0.0) continue;
                const auto light = illumination_of(
                    world.bench.projector, world.reference_mm, other.position_mm, other.normal);
                if (!light ||
                    !sees(world.tracer, other.position_mm, other.geometric_normal, projector_mm)) {
                    continue;
                }
                const auto shares = surface_shares(world.surfaces, other.part, other.position_mm);
                for (int k = 0; k < shares.count; ++k) {
                    const auto& [surface, factor] = shares.list[static_cast<std::size_t>(k)];
                    terms.push_back({light->pixel,
                                     surface,
                                     static_cast<float>(LIVERY_MUTATED(
                                         twin_bounce, light->irradiance * factor / rays_a_place))});
                }
            }
            std::sort(terms.begin(), terms.end(), [](const PathTerm& a, const PathTerm& b) {
                return std::pair(a.surface, a.pixel) < std::pair(b.surface, b.pixel);
            });
            lists[p] = std::move(terms);
        }
    });
    Gathers gathers;
    gathers.begin.push_back(0);
    for (const auto& list : lists) {
        gathers.terms.insert(gathers.terms.end(), list.begin(), list.end());
        gathers.begin.push_back(static_cast<std::uint32_t>(gathers.terms.size()));
    }
    return gathers;
}

std::vector<Gathers::Blend> GatherPlaces::blend(const LightPaths& receivers) const {
    std::vector<Gathers::Blend> blends(receivers.receiver.size());
    parallel_for(blends.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<float, std::uint32_t>> near;
        for (std::size_t i = begin; i < end; ++i) {
            near.clear();
            const glm::dvec3 normal(receivers.normal[i]);
            // Trilinear weights between cell middles, times how alike the surfaces face.
            const glm::dvec3 p = glm::dvec3(receivers.position_mm[i]) / cell_mm_ - 0.5;
            const glm::dvec3 f = p - glm::floor(p);
            const glm::ivec3 cell(glm::floor(p));
            for (int k = 0; k < 8; ++k) {
                const glm::ivec3 step(k & 1, (k >> 1) & 1, k >> 2);
                const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(step));
                for (int axis = 0; axis < 3; ++axis) {
                    const int facing = 2 * axis + (normal[axis] < 0.0 ? 1 : 0);
                    const auto found = index_.find(key_of(cell + step, facing));
                    if (found == index_.end()) continue;
                    const double alike = glm::dot(places_[found->second].normal, normal);
                    const double weight = (w.x * w.y * w.z + 1e-6) * std::max(0.0, alike) * alike;
                    if (weight > 0.0) near.emplace_back(static_cast<float>(weight), found->second);
                }
            }
            const std::size_t kept = std::min<std::size_t>(near.size(), 8);
            std::partial_sort(near.begin(),
                              near.begin() + static_cast<std::ptrdiff_t>(kept),
                              near.end(),
                              std::greater<>());
            float sum = 0.0f;
            for (std::size_t k = 0; k < kept; ++k) sum += near[k].first;
            for (std::size_t k = 0; k < kept; ++k) {
                blends[i].place[k] = near[k].second;
                blends[i].weight[k] = near[k].first / sum;
            }
        }
    });
    return blends;
}

namespace {

constexpr double kGatherCellMm = 6.0;
constexpr int kGatherRays = 256;

double reference_distance_mm(const View& projector, const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    return glm::distance(centre_in_world(projector), 0.5 * (bounds.low + bounds.high));
}

template <typename T>
void add_values(Hasher& hasher, const std::vector<T>& values) {
    hasher.add(std::span<const T>(values));
}

void add_numbers(Hasher& hasher, std::initializer_list<double> numbers) {
    hasher.add(std::span<const double>(numbers.begin(), numbers.size()));
}

void add_view(Hasher& hasher, const View& view) {
    const glm::dvec3& t = view.view_from_world.translation;
    add_numbers(hasher,
                {static_cast<double>(view.width),
                 static_cast<double>(view.height),
                 view.focal_px.x,
                 view.focal_px.y,
                 view.principal_px.x,
                 view.principal_px.y,
                 t.x,
                 t.y,
                 t.z});
    hasher.add(std::span<const double>(view.distortion));
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3& axis = view.view_from_world.rotation[column];
        add_numbers(hasher, {axis.x, axis.y, axis.z});
    }
}

TracedObserver observer_of(ObservedPaths seen, std::vector<Gathers::Blend> blends) {
    TracedObserver observer;
    observer.receivers = {
        seen.lit.width, seen.lit.height, std::move(seen.paths), std::move(blends)};
    observer.lit = std::move(seen.lit);
    observer.edge = std::move(seen.edge);
    observer.seen_by_eye = std::move(seen.seen_by_eye);
    return observer;
}

}  // namespace

std::string key_of_transport(const BenchDescription& description,
                             const Product& product,
                             EyePicture eye_picture) {
    const Mesh mesh = with_surroundings(product.mesh, description);
    const SurfaceSet surfaces = make_surfaces(description, mesh);
    Hasher hasher;
    add_view(hasher, description.projector.view);
    add_view(hasher, description.camera.view);
    add_numbers(hasher,
                {description.projector.vignetting,
                 description.camera.vignetting,
                 description.eye_mm.x,
                 description.eye_mm.y,
                 description.eye_mm.z,
                 static_cast<double>(description.samples_a_side),
                 description.mockup.interreflection ? 1.0 : 0.0,
                 eye_picture == EyePicture::traced ? 1.0 : 0.0,
                 static_cast<double>(product.mesh.parts.size()),
                 surfaces.diffuse_sigma_rad,
                 surfaces.sheen_f0,
                 surfaces.sheen_alpha,
                 static_cast<double>(surfaces.sheen)});
    for (const SurfaceSet::PartSurface& part : surfaces.parts) {
        add_numbers(hasher,
                    {static_cast<double>(part.first),
                     static_cast<double>(part.second),
                     part.second_share,
                     part.pattern_mm});
    }
    add_values(hasher, mesh.positions_mm);
    add_values(hasher, mesh.normals);
    add_values(hasher, mesh.triangles);
    add_values(hasher, mesh.triangle_part);
    return hasher.hex();
}

std::shared_ptr<const LightTransport> trace_light(const BenchDescription& description,
                                                  const Product& product,
                                                  EyePicture eye_picture,
                                                  const Progress& progress) {
    const Mesh mesh = with_surroundings(product.mesh, description);
    const SurfaceSet surfaces = make_surfaces(description, mesh);
    const Tracer tracer(mesh);
    const View& projector = description.projector.view;
    const TracedWorld world{mesh,
                            product.mesh.parts.size(),
                            tracer,
                            surfaces,
                            description,
                            reference_distance_mm(projector, product.mesh)};
    auto light = std::make_shared<LightTransport>();
    light->made_of = key_of_transport(description, product, eye_picture);
    progress.update(0.0, "tracing the bench's camera");
    light->camera.paths = trace_camera(world, progress);
    light->camera.width = description.camera.view.width;
    light->camera.height = description.camera.view.height;
    progress.update(0.4, "tracing the bench's projector");
    ObservedPaths seen = trace_projector(world, progress);

    // Light between parts. The eye's picture takes no part in choosing the places, so that the
    // photographs are the same with it and without.
    GatherPlaces places(kGatherCellMm);
    const auto blend = [&](const LightPaths& paths) {
        return description.mockup.interreflection ? places.blend(paths)
                                                  : std::vector<Gathers::Blend>();
    };
    if (description.mockup.interreflection) {
        progress.update(0.7, "tracing light between parts");
        places.add(light->camera.paths);
        places.add(seen.paths);
        light->gathers = places.gather(world, kGatherRays, progress);
        light->camera.blends = blend(light->camera.paths);
    }
    auto blends = blend(seen.paths);
    light->projector = observer_of(std::move(seen), std::move(blends));
    if (eye_picture == EyePicture::traced) {
        progress.update(0.9, "tracing the eye's picture");
        light->eye_view = eye_view(description.eye_mm, projector, product.mesh);
        ObservedPaths paths = trace_eye(world, *light->eye_view, progress);
        blends = blend(paths.paths);
        light->eye = observer_of(std::move(paths), std::move(blends));
    }
    progress.update(1.0, "tracing done");
    return light;
}

}  // namespace livery
