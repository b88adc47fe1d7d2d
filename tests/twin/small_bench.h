// Small benches in memory: a mock-up of a few triangles, a projector and a camera in front of it.
#pragma once

#include <memory>
#include <numbers>

#include "scene/product.h"
#include "twin/bench.h"

namespace livery::testing {

/// A rectangle with one corner and two sides, facing side_a x side_b.
inline Mesh make_rectangle(glm::vec3 corner, glm::vec3 side_a, glm::vec3 side_b, const char* name) {
    Mesh mesh;
    mesh.positions_mm = {corner, corner + side_a, corner + side_a + side_b, corner + side_b};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.triangle_part = {0, 0};
    mesh.uvs.assign(4, glm::vec2(0.0f));
    mesh.parts = {Part{}};
    mesh.parts[0].name = name;
    compute_normals(mesh);
    compute_tangents(mesh);
    return mesh;
}

/// A 360 x 280 mm wall in the plane z = 0, facing +z.
inline Mesh make_wall() {
    return make_rectangle({-180, -140, 0}, {360, 0, 0}, {0, 280, 0}, "wall");
}

inline std::shared_ptr<const Product> product_of(Mesh mesh) {
    auto product = std::make_shared<Product>();
    product->name = "test";
    product->mesh = std::move(mesh);
    return product;
}

inline Spectrum flat(double value) {
    Spectrum spectrum;
    spectrum.fill(value);
    return spectrum;
}

/// Looks down -z from 500 mm at the wall; a camera at its side. No nuisance, no noise.
inline BenchDescription wall_bench() {
    BenchDescription bench;
    bench.name = "wall";
    bench.projector.view = look_at({0, 0, 500}, {0, 0, 0}, 0.4, 160, 120);
    bench.camera.view = look_at({120, 40, 480}, {0, 0, 0}, 0.4, 240, 180);
    // Smooth, overlapping curves: any camera will do.
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < bench.camera.sensitivities[c].size(); ++k) {
            const double nm = kSpectrumFirst_nm + kSpectrumStep_nm * static_cast<double>(k);
            const double z = (nm - (600.0 - 70.0 * static_cast<double>(c))) / 45.0;
            bench.camera.sensitivities[c][k] = std::exp(-0.5 * z * z);
        }
    }
    bench.mockup.surfaces["*"].reflectance = flat(0.5);
    bench.eye_mm = {-200, 100, 450};
    return bench;
}

inline Image8 filled(const BenchDescription& bench, int red, int green, int blue) {
    const View& view = bench.projector.view;
    Image8 picture(view.width, view.height, 3);
    for (std::size_t k = 0; k < picture.values.size(); k += 3) {
        picture.values[k] = static_cast<std::uint8_t>(red);
        picture.values[k + 1] = static_cast<std::uint8_t>(green);
        picture.values[k + 2] = static_cast<std::uint8_t>(blue);
    }
    return picture;
}

}  // namespace livery::testing
