#include "jobs/projector_irradiance.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress) {
    constexpr int kSamplesPerPixel = 16;
    const Tracer tracer(mesh);
    const SurfaceMap map = build_surface_map(mesh, tracer, projector, kSamplesPerPixel, progress);
    const glm::dvec3 lamp = centre_in_world(projector);

    ImageF irradiance(projector.width, projector.height, 1);
    for (const Fragment& fragment : map.fragments) {
        const glm::dvec3 to_lamp = lamp - glm::dvec3(fragment.position_mm);
        const double distance2 = glm::dot(to_lamp, to_lamp);
        // The mean of the normals is shorter than the unit mean normal by their scatter.
        const double shorter = 1.0 / std::sqrt(1.0 + static_cast<double>(fragment.normal_variance));
        const double cosine =
            shorter * glm::dot(glm::dvec3(fragment.normal), to_lamp) / std::sqrt(distance2);
        irradiance.values[fragment.pixel] += static_cast<float>(
            static_cast<double>(fragment.coverage) * std::max(0.0, cosine) / distance2);
    }
    for (std::size_t i = 0; i < irradiance.values.size(); ++i) {
        const float coverage = map.coverage.values[i];
        irradiance.values[i] = coverage < 0.5f ? 0.0f : irradiance.values[i] / coverage;
    }
    return irradiance;
}

}  // namespace livery
