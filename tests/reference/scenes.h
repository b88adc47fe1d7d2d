// Small scenes with known answers.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "reference/path_tracer.h"

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

/// Appends a flat quad a, b, c, d, counter-clockwise seen from its outside.
inline void add_quad(Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3& p : {a, b, c, d}) {
        mesh.positions_mm.push_back(p);
        mesh.normals.push_back(n);
        mesh.tangents.emplace_back(glm::normalize(b - a), 1.0f);
        mesh.uvs.emplace_back(0.0f);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
    mesh.triangle_part.insert(mesh.triangle_part.end(), 2, 0);
    if (mesh.parts.empty()) mesh.parts.push_back({"part", "", glm::dvec3(0.5)});
}

/// A level square of half side `half_mm` at y = 0.
inline Mesh floor_mesh(float half_mm) {
    Mesh mesh;
    add_quad(mesh,
             {-half_mm, 0, half_mm},
             {half_mm, 0, half_mm},
             {half_mm, 0, -half_mm},
             {-half_mm, 0, -half_mm});
    return mesh;
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
