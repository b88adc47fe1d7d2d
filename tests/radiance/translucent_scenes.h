// Bodies that light goes through, and what throws the edge of a shadow on them.
#pragma once

#include <utility>

#include "appearance/subsurface/translucent_material.h"
#include "radiance/scenes.h"
#include "support/small_meshes.h"

namespace livery {

inline TranslucentMaterial medium_named(const char* name) {
    return read_translucent_material(name);
}

/// A ball of 50 mm across, the disc that throws an edge of shadow on it, and a lamp.
inline Scene shadowed_ball(const Material& paint) {
    Mesh mesh = make_sphere({0, 0, 0}, 25.0, 96, "ball");
    append(mesh, make_sphere({-25.0, 130.0, 20.0}, 25.0, 48, "block"), "");
    Scene scene = scene_of(std::move(mesh), paint);
    Material black;
    black.diffuse = glm::dvec3(0.0);
    scene.part_materials[1] = black;
    scene.lights = {light_from({0.0, 1.0, 0.15}, 0.01)};
    scene.eye_in_world_mm = {60.0, 250.0, 500.0};
    return scene;
}

/// 60 by 60 mm, from y = 0 up.
inline Mesh plate_mesh(float thickness_mm) {
    Mesh mesh;
    add_box(mesh, {-30.0f, 0.0f, -30.0f}, {30.0f, thickness_mm, 30.0f});
    mesh.parts.resize(1);
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    return mesh;
}

/// The upper side of such a plate alone.
inline Mesh sheet_mesh(float height_mm) {
    Mesh mesh;
    for (const glm::vec2 corner :
         {glm::vec2(-30.0f), {-30.0f, 30.0f}, {30.0f, 30.0f}, {30.0f, -30.0f}}) {
        mesh.positions_mm.emplace_back(corner.x, height_mm, corner.y);
        mesh.uvs.emplace_back(corner);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.triangle_part = {0, 0};
    mesh.parts.resize(1);
    compute_normals(mesh);
    compute_tangents(mesh);
    return mesh;
}

/// A plate of 2 mm, or something of its size, lit from behind along its normal; something stands in
/// the light of one half.
inline Scene shadowed_plate(const Material& paint, Mesh mesh = plate_mesh(2.0f)) {
    const std::size_t own = mesh.triangles.size();
    add_box(mesh, {-60.0f, -12.0f, -60.0f}, {0.0f, -10.0f, 60.0f});
    mesh.parts.resize(2);
    mesh.triangle_part.assign(own, 0);
    mesh.triangle_part.resize(mesh.triangles.size(), 1);
    Scene scene = scene_of(std::move(mesh), paint);
    scene.part_materials[1] = Material{};
    scene.part_materials[1].diffuse = glm::dvec3(0.0);
    scene.lights = {light_from({0.0, -1.0, 0.0}, 0.05)};
    scene.eye_in_world_mm = {0.0, 400.0, 100.0};
    return scene;
}

}  // namespace livery
