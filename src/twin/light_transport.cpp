#include "twin/light_transport.h"

#include <array>
#include <utility>

#include <glm/geometric.hpp>

#include "core/hash.h"
#include "tracing/tracer.h"
#include "twin/observer.h"

namespace livery {

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
