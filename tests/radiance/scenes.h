// Scenes that several tests draw.
#pragma once

#include <memory>
#include <numbers>

#include "scene/frame_plan.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

inline constexpr double kDegree_rad = std::numbers::pi / 180.0;

inline Material paint_of(ReflectanceModel model, double alpha) {
    Material material;
    material.model = model;
    material.diffuse = {0.55, 0.1, 0.06};
    const bool coated =
        model == ReflectanceModel::clearcoat || model == ReflectanceModel::car_paint;
    material.f0 = coated ? glm::dvec3(0.3, 0.12, 0.1) : glm::dvec3(0.04);
    material.alpha = glm::dvec2(coated ? 0.25 : alpha);
    material.flake_f0 = {0.1, 0.3, 0.5};
    material.flake_alpha = 0.1;
    material.coat_alpha = alpha;
    material.coat_transmittance = {0.95, 0.85, 0.8};
    material.exponent = glm::dvec2(2.0 / (alpha * alpha) - 2.0);
    material.specular = {0.06, 0.05, 0.04};
    material.diffuse_roughness = 0.7;
    return material;
}

inline DirectionalLight light_from(glm::dvec3 direction, double angle_rad, double radiance = 1.0) {
    DirectionalLight light;
    light.direction = direction / std::sqrt(direction.x * direction.x + direction.y * direction.y +
                                            direction.z * direction.z);
    light.radiance_rec709 = glm::dvec3(radiance);
    light.angle_rad = angle_rad;
    return light;
}

inline Scene scene_of(Mesh mesh, const Material& material) {
    auto product = std::make_shared<Product>();
    product->mesh = std::move(mesh);
    product->exchange = part_exchange(product->mesh);
    Scene scene;
    scene.part_materials.assign(product->mesh.parts.size(), material);
    scene.product = std::move(product);
    scene.eye_in_world_mm = {150.0, 250.0, 900.0};
    return scene;
}

/// A sphere of 40 mm with a smaller one that shades it.
inline Mesh two_spheres() {
    Mesh mesh = make_sphere({0, 0, 0}, 40.0, 128, "body");
    append(mesh, make_sphere({34, 40, 30}, 12.0, 64, "wheels"), "");
    return mesh;
}

inline View test_view(int width, int height) {
    return look_at({30, 60, 500}, {0, 5, 0}, 0.26, width, height);
}

}  // namespace livery
