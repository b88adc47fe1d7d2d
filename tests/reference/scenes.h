// Small scenes with known answers.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "reference/path_tracer.h"
#include "support/small_meshes.h"

namespace livery {

inline Material white_diffuse(double albedo) {
    Material material;
    material.name = "white";
    material.diffuse = glm::dvec3(albedo);
    return material;
}

inline std::shared_ptr<const Environment> uniform_environment(float radiance) {
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(32, 16, 3, radiance);
    return environment;
}

inline Scene scene_of(Mesh mesh, Material material, glm::dvec3 eye_mm) {
    auto product = std::make_shared<Product>();
    product->mesh = std::move(mesh);
    Scene scene;
    scene.part_materials.assign(product->mesh.parts.size(), std::move(material));
    scene.product = std::move(product);
    scene.eye_in_world_mm = eye_mm;
    return scene;
}

inline DirectionalLight light_toward(glm::dvec3 direction, double angle_rad) {
    DirectionalLight light;
    light.direction = glm::normalize(direction);
    light.angle_rad = angle_rad;
    return light;
}

/// Mean over the pixels covered by more than half, and the standard error of its luminance.
struct PictureMean {
    glm::dvec3 colour{0.0};
    double standard_error = 0.0;
    int pixels = 0;
};
inline PictureMean mean_of(const ReferenceResult& result) {
    PictureMean mean;
    double variance = 0.0;
    const ImageF& image = result.radiance_working;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.pixel(x, y);
            if (p[3] < 0.5f) continue;
            mean.colour += glm::dvec3(p[0], p[1], p[2]);
            const double e = static_cast<double>(result.standard_error.at(x, y));
            variance += e * e;
            ++mean.pixels;
        }
    }
    mean.colour /= mean.pixels;
    mean.standard_error = std::sqrt(variance) / mean.pixels;
    return mean;
}

}  // namespace livery
