// Meshes whose triangles are wound anyhow, or stand there twice, become what they were meant to be.
#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "mesh/gltf/gltf_write.h"
#include "mesh/gltf_builder.h"
#include "mesh/mesh_checks.h"
#include "mesh/ply_write.h"
#include "scene/library.h"
#include "support/reference_data.h"
#include "support/small_meshes.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Notes = std::vector<std::string>;

/// Exchanges two corners of a random half of the triangles; normals stay.
Mesh half_reversed(Mesh mesh, std::uint64_t seed) {
    Random random(seed, 1);
    for (glm::uvec3& t : mesh.triangles) {
        if (random.uniform() < 0.5) std::swap(t.y, t.z);
    }
    return mesh;
}

/// Every triangle twice, once a side, with vertices of its own and normals on that side.
Mesh doubled(const Mesh& mesh) {
    Mesh both = mesh;
    const auto vertices = static_cast<std::uint32_t>(mesh.positions_mm.size());
    for (std::size_t v = 0; v < vertices; ++v) {
        both.positions_mm.push_back(mesh.positions_mm[v]);
        both.normals.push_back(-mesh.normals[v]);
        both.tangents.push_back(mesh.tangents[v]);
        both.uvs.push_back(mesh.uvs[v]);
    }
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const glm::uvec3 t = mesh.triangles[k];
        both.triangles.emplace_back(t.x + vertices, t.z + vertices, t.y + vertices);
        both.triangle_part.push_back(mesh.triangle_part[k]);
    }
    return both;
}

/// Which of two twins comes first is left to chance.
Mesh shuffled(Mesh mesh, std::uint64_t seed) {
    Random random(seed, 2);
    for (std::size_t k = mesh.triangles.size(); k-- > 1;) {
        const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1));
        std::swap(mesh.triangles[k], mesh.triangles[other]);
        std::swap(mesh.triangle_part[k], mesh.triangle_part[other]);
    }
    return mesh;
}

/// A triangle's corners in their order, from the lowest on: positions, normals; its part.
using Corners = std::array<float, 19>;
std::vector<Corners> corners_of(const Mesh& mesh) {
    std::vector<Corners> all;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const glm::uvec3& t = mesh.triangles[k];
        Corners lowest{};
        for (int first = 0; first < 3; ++first) {
            Corners turned{};
            std::size_t next = 0;
            for (const auto* values : {&mesh.positions_mm, &mesh.normals}) {
                for (int corner = 0; corner < 3; ++corner) {
                    const glm::vec3 value = (*values)[t[(first + corner) % 3]];
                    for (int axis = 0; axis < 3; ++axis) turned[next++] = value[axis] + 0.0f;
                }
            }
            turned[next] = mesh.triangle_part[k];
            lowest = first == 0 ? turned : std::min(lowest, turned);
        }
        all.push_back(lowest);
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::string as_gltf(const Mesh& mesh) {
    Notes notes;
    Material paint;
    paint.name = "grey";
    return gltf_bytes(
        mesh,
        std::vector<MeshLook>{{"look", std::vector<Material>(mesh.parts.size(), paint)}},
        notes);
}

class Winding : public ::testing::Test {
  protected:
    Mesh load(const std::string& name, const std::string& bytes) {
        notes_.clear();
        const bool says_unit = name.ends_with(".glb");
        return load_mesh(folder_.write(name, bytes),
                         &notes_,
                         says_unit ? std::nullopt : std::optional(LengthUnit::mm));
    }
    bool noted(const std::string& words) const {
        return std::any_of(notes_.begin(), notes_.end(), [&](const std::string& note) {
            return note.find(words) != std::string::npos;
        });
    }
    /// Reads it as glTF and as PLY, as it is and spoilt, and compares.
    void expect_settled(const Mesh& mesh, const std::string& what) {
        SCOPED_TRACE(what);
        struct Format {
            const char* name;
            std::function<std::string(const Mesh&)> bytes;
        };
        for (const Format& format : {Format{"a.glb", as_gltf}, Format{"a.ply", ply_bytes}}) {
            SCOPED_TRACE(format.name);
            const Mesh clean = load(format.name, format.bytes(mesh));
            EXPECT_FALSE(noted("turned") || noted("on top of others"));
            const std::vector<Corners> expected = corners_of(clean);
            const auto expect_same = [&](const Mesh& spoilt, const char* how) {
                const Mesh loaded = load(format.name, format.bytes(spoilt));
                EXPECT_EQ(corners_of(loaded), expected) << how;
                EXPECT_EQ(std::count(loaded.two_sided.begin(), loaded.two_sided.end(), true),
                          std::count(clean.two_sided.begin(), clean.two_sided.end(), true))
                    << how;
            };
            expect_same(half_reversed(mesh, 3), "half reversed");
            EXPECT_TRUE(noted("turned"));
            expect_same(doubled(mesh), "doubled");
            EXPECT_TRUE(
                noted(fmt::format("{} triangles on top of others dropped", mesh.triangles.size())));
            expect_same(half_reversed(doubled(mesh), 4), "doubled, half reversed");
        }
    }
    TemporaryFolder folder_;
    Notes notes_;
};

Mesh upper_half(Mesh mesh) {
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        return mesh.positions_mm[t.x].y + mesh.positions_mm[t.y].y + mesh.positions_mm[t.z].y <
               0.0f;
    });
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    return mesh;
}

Mesh turned_over(Mesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (glm::vec3& normal : mesh.normals) normal = -normal;
    return mesh;
}

TEST_F(Winding, IsThatOfTheNormalsWhateverTheFileHas) {
    const Mesh ball = make_sphere({0, 0, 0}, 100.0, 12, "ball");
    expect_settled(ball, "closed");
    expect_settled(upper_half(ball), "open");
    expect_settled(turned_over(upper_half(ball)), "a bowl");
    Mesh hollow = ball;
    append(hollow, turned_over(make_sphere({0, 0, 0}, 60.0, 9, "hollow")), "");
    expect_settled(hollow, "hollow");
    Mesh box;
    add_box(box, {-50, -50, -50}, {50, 50, 50});
    append(box, floor_mesh(300.0f), "floor ");
    expect_settled(box, "a box with sharp edges through a floor");
    expect_settled(find_product("player")->mesh, "player");
}

TEST_F(Winding, OfOthersTrucksIsTheirNormals) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const char* name : {"vehicle-truck-green.glb", "vehicle-truck-red.glb"}) {
        expect_settled(load_mesh(data / "meshes" / name), name);
    }
}

TEST_F(Winding, NightlyOfTheCarIsItsNormals) { expect_settled(find_product("car")->mesh, "car"); }

TEST_F(Winding, OfTwinsInAnyOrderIsOne) {
    // Each of the kept ones may be the one whose normals are on the wrong side.
    for (const Mesh& mesh : {make_sphere({0, 0, 0}, 100.0, 12, "ball"),
                             upper_half(make_sphere({0, 0, 0}, 100.0, 12, "ball"))}) {
        const Mesh loaded = load("a.glb", as_gltf(shuffled(half_reversed(doubled(mesh), 5), 6)));
        EXPECT_EQ(loaded.triangles.size(), mesh.triangles.size());
        EXPECT_EQ(corners_of(loaded), corners_of(load("a.glb", as_gltf(mesh))));
        expect_consistent(loaded);
    }
}

TEST_F(Winding, WithoutNormalsIsOneWithTheOutsideOut) {
    const Mesh ball = half_reversed(make_sphere({0, 0, 0}, 0.1, 12, "ball"), 7);  // in metres
    GltfBuilder gltf;
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (const glm::vec3& p : ball.positions_mm) positions.insert(positions.end(), &p.x, &p.x + 3);
    for (const glm::uvec3& t : ball.triangles) indices.insert(indices.end(), &t.x, &t.x + 3);
    gltf.attributes()["POSITION"] = gltf.add(positions, "VEC3", 5126, ball.positions_mm.size());
    gltf.primitive()["indices"] = gltf.add(indices, "SCALAR", 5123, indices.size());
    const Mesh loaded = load("a.glb", gltf.glb());
    EXPECT_TRUE(noted("triangles wound against their neighbours turned over"));
    expect_consistent(loaded);
    EXPECT_NEAR(signed_volume(loaded) / signed_volume(make_sphere({0, 0, 0}, 100.0, 12, "ball")),
                1.0,
                1e-5);
}

TEST_F(Winding, AClosedSurfaceInsideOutIsTurned) {
    const Mesh loaded =
        load("a.glb", as_gltf(turned_over(make_sphere({0, 0, 0}, 100.0, 12, "ball"))));
    EXPECT_TRUE(noted("1 surface facing inward turned outside out (528 triangles)"));
    EXPECT_TRUE(noted("normals pointing into the surface turned out of it"));
    EXPECT_GT(signed_volume(loaded), 0.0);
    expect_consistent(loaded);
}

TEST_F(Winding, OpenSurfacesHaveTwoSides) {
    Mesh mesh = make_sphere({0, 0, 0}, 100.0, 12, "ball");
    const std::size_t of_ball = mesh.triangles.size();
    append(mesh, floor_mesh(300.0f), "floor ");
    for (const auto& [name, bytes] : {std::pair<std::string, std::string>("a.glb", as_gltf(mesh)),
                                      {"a.ply", ply_bytes(mesh)}}) {
        const Mesh loaded = load(name, bytes);
        ASSERT_EQ(loaded.two_sided.size(), of_ball + 2) << name;
        for (std::uint32_t t = 0; t < loaded.triangles.size(); ++t) {
            EXPECT_EQ(has_two_sides(loaded, t), t >= of_ball) << name;
        }
    }
}

TEST_F(Winding, APartThatLiesOnAnotherIsDroppedWithANote) {
    Mesh mesh = floor_mesh(100.0f);
    append(mesh, floor_mesh(100.0f), "second ");
    append(mesh, make_sphere({0, 300, 0}, 100.0, 6, "ball"), "");
    const Mesh loaded = load("a.glb", as_gltf(mesh));
    ASSERT_EQ(loaded.parts.size(), 2u);
    EXPECT_EQ(loaded.parts[1].name, "ball");
    EXPECT_TRUE(noted("part \"second part\": nothing to show; dropped"));
    EXPECT_EQ(loaded.triangle_part.back(), 1);
    std::vector<bool> used(loaded.positions_mm.size(), false);
    for (const glm::uvec3& t : loaded.triangles) used[t.x] = used[t.y] = used[t.z] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

}  // namespace
}  // namespace livery
