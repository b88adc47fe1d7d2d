// Scans as they come: soups, inside out, with normals of all kinds or none.
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/random.h"
#include "mesh/mesh_checks.h"
#include "mesh/scan_writer.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Notes = std::vector<std::string>;

const char* const kNoNormals =
    "no normals; computed, with edges sharper than 50 degrees kept sharp";

class RepairedScan : public ::testing::Test {
  protected:
    Mesh load(const ScanWriter& scan) {
        notes_.clear();
        const auto file = folder_.write("a.ply", scan.ascii_ply());
        Mesh mesh = load_mesh(file, &notes_, LengthUnit::mm);
        std::erase_if(notes_, [](const std::string& note) { return note.ends_with(" welded"); });
        return mesh;
    }
    TemporaryFolder folder_;
    Notes notes_;
};

ScanWriter joined(ScanWriter a, const ScanWriter& b, const glm::vec3& offset = {}) {
    const int first = static_cast<int>(a.positions.size());
    for (const auto& p : b.positions) a.positions.push_back(p + offset);
    a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
    for (auto face : b.faces) {
        for (int& corner : face) corner += first;
        a.faces.push_back(face);
    }
    return a;
}

ScanWriter turned_over(ScanWriter scan) {
    for (auto& face : scan.faces) std::swap(face[1], face.back());
    return scan;
}

/// The half of a closed scan above y = 0, wound as it is.
ScanWriter upper_half(ScanWriter scan) {
    std::erase_if(scan.faces, [&](const std::vector<int>& face) {
        float y = 0.0f;
        for (const int corner : face) y += scan.positions[static_cast<std::size_t>(corner)].y;
        return y < 0.0f;
    });
    return scan;
}

void expect_faces_out(const Mesh& mesh) {
    for (const auto& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions_mm[t.x], b = mesh.positions_mm[t.y],
                        c = mesh.positions_mm[t.z];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0f);
    }
}

TEST_F(RepairedScan, ASoupOfTrianglesBecomesASurface) {
    const ScanWriter whole = sphere_scan(12);
    ScanWriter soup;
    for (const auto& face : whole.faces) {
        soup.faces.push_back({});
        for (const int corner : face) {
            soup.faces.back().push_back(static_cast<int>(soup.positions.size()));
            soup.positions.push_back(whole.positions[static_cast<std::size_t>(corner)]);
        }
    }
    const Mesh mesh = load(soup);
    EXPECT_EQ(notes_, Notes{kNoNormals});
    EXPECT_EQ(mesh.positions_mm.size(), 2u + 11u * 24u);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        EXPECT_GT(glm::dot(mesh.normals[v], mesh.positions_mm[v]) / 100.0f, 0.995f);
    }
    expect_consistent(mesh);
}

TEST_F(RepairedScan, EdgesStaySharpWhereTheFileHasNoNormals) {
    const Mesh box = load(box_scan({10, 20, 30}));
    EXPECT_EQ(box.positions_mm.size(), 24u);
    for (const auto& normal : box.normals) {
        EXPECT_EQ(std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z), 1.0f);
    }
    EXPECT_EQ(notes_, Notes{kNoNormals});
    expect_consistent(box);
}

TEST_F(RepairedScan, ANormalWeighsAnglesAndNotTriangles) {
    // The corner of a box that is cut into one triangle, two and many: all three faces count alike.
    ScanWriter corner;
    corner.positions = {{0, 0, 0}, {10, -4, -4}, {-4, 10, -4}, {-4, -4, 10}};
    corner.faces = {{0, 1, 2}, {0, 2, 3}};
    for (int k = 0; k < 16; ++k) {  // the third face, in 16 triangles
        const auto at = [](int n) {
            return glm::mix(
                glm::vec3(-4, -4, 10), glm::vec3(10, -4, -4), static_cast<float>(n) / 16.0f);
        };
        const int first = static_cast<int>(corner.positions.size());
        corner.positions.push_back(at(k));
        corner.positions.push_back(at(k + 1));
        corner.faces.push_back({0, first, first + 1});
    }
    const Mesh mesh = load(corner);
    ASSERT_EQ(mesh.positions_mm[0], glm::vec3(0.0f));
    EXPECT_LT(glm::distance(mesh.normals[0], glm::normalize(glm::vec3(1, 1, 1))), 0.02f);
}

TEST_F(RepairedScan, InsideOutTurnsOutsideOut) {
    Mesh mesh = load(turned_over(sphere_scan(12)));
    expect_faces_out(mesh);
    EXPECT_EQ(notes_, Notes{"1 surface facing inward turned outside out (528 triangles)"});

    ScanWriter without = turned_over(sphere_scan(12));
    without.normals.clear();
    mesh = load(without);
    expect_faces_out(mesh);
    expect_consistent(mesh);

    // An open one without normals, by how it bulges.
    mesh = load(upper_half(without));
    expect_faces_out(mesh);
    EXPECT_EQ(notes_.at(0), "1 surface facing inward turned outside out (264 triangles)");
}

TEST_F(RepairedScan, ABowlWhoseNormalsAgreeWithItStaysABowl) {
    ScanWriter bowl = turned_over(upper_half(sphere_scan(12)));
    for (auto& normal : bowl.normals) normal = -normal;
    const Mesh mesh = load(bowl);
    EXPECT_TRUE(notes_.empty());
    expect_consistent(mesh);
    const auto& t = mesh.triangles[0];
    EXPECT_LT(glm::dot(mesh.normals[t.x], mesh.positions_mm[t.x]), 0.0f);
}

TEST_F(RepairedScan, MixedWindingIsMadeOne) {
    for (const bool open : {false, true}) {
        for (const bool normals : {false, true}) {
            ScanWriter scan = open ? upper_half(sphere_scan(12)) : sphere_scan(12);
            if (!normals) scan.normals.clear();
            Random random(7, 1);
            std::size_t turned = 0;
            for (auto& face : scan.faces) {
                if (random.uniform() < 0.6) continue;
                std::swap(face[0], face[1]);
                ++turned;
            }
            const Mesh mesh = load(scan);
            expect_faces_out(mesh);
            expect_consistent(mesh);
            EXPECT_EQ(
                notes_.at(0),
                std::to_string(turned) + " triangles wound against their neighbours turned over");
        }
    }
}

TEST_F(RepairedScan, EachSurfaceIsTurnedByItself) {
    const ScanWriter scan =
        joined(sphere_scan(6), turned_over(sphere_scan(6)), glm::vec3(500.0f, 0, 0));
    const Mesh mesh = load(scan);
    EXPECT_EQ(notes_, Notes{"1 surface facing inward turned outside out (120 triangles)"});
    EXPECT_NEAR(signed_volume(mesh), 2.0 * signed_volume(load(sphere_scan(6))), 1.0);
}

TEST_F(RepairedScan, HollowSpacesKeepFacingInward) {
    ScanWriter inner = turned_over(sphere_scan(6));
    for (auto& p : inner.positions) p *= 0.5f;
    for (auto& n : inner.normals) n = -n;
    const Mesh hollow = load(joined(sphere_scan(6), inner));
    EXPECT_EQ(notes_, Notes{"1 closed surface inside others left facing inward: hollow spaces"});
    expect_consistent(hollow);
    // A box's corner is inside the box of a sphere, and yet not inside the sphere.
    const Mesh beside = load(joined(sphere_scan(6), inner, glm::vec3(80.0f)));
    EXPECT_EQ(notes_.at(0), "1 surface facing inward turned outside out (120 triangles)");
    expect_consistent(beside);
}

TEST_F(RepairedScan, AMoebiusStripIsSaidToHaveOneSide) {
    ScanWriter strip;
    constexpr int n = 24;
    for (int k = 0; k < n; ++k) {
        const float angle = 6.2831853f * static_cast<float>(k) / n;
        const glm::vec3 out(std::cos(angle), 0.0f, std::sin(angle));
        const glm::vec3 across =
            std::cos(angle / 2) * glm::vec3(0, 1, 0) + std::sin(angle / 2) * out;
        strip.positions.push_back(100.0f * out + 20.0f * across);
        strip.positions.push_back(100.0f * out - 20.0f * across);
    }
    for (int k = 0; k < n; ++k) {
        const int a = 2 * k, b = a + 1, next = 2 * ((k + 1) % n), flip = k + 1 == n ? 1 : 0;
        strip.faces.push_back({a, b, next + 1 - flip});
        strip.faces.push_back({a, next + 1 - flip, next + flip});
    }
    const Mesh mesh = load(strip);
    EXPECT_EQ(mesh.triangles.size(), 2u * n);
    EXPECT_NE(std::find(notes_.begin(),
                        notes_.end(),
                        "1 surface of one side only (a Moebius strip) wound as well as it goes"),
              notes_.end());
    expect_consistent(mesh);
}

TEST_F(RepairedScan, BrokenNormalsAreRepairedAndCounted) {
    ScanWriter scan = sphere_scan(12);
    const auto exact = load(scan);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scan.normals[30] = glm::vec3(0.0f);
    scan.normals[31] = glm::vec3(nan, 0.0f, 1.0f);
    scan.normals[32] = {std::numeric_limits<float>::infinity(), 0.0f, 1.0f};
    scan.normals[60] *= 7.0f;
    scan.normals[61] *= 1e-20f;
    scan.normals[90] = -scan.normals[90];
    const Mesh mesh = load(scan);
    EXPECT_EQ(notes_,
              (Notes{"3 normals of no length or not a number computed anew",
                     "2 normals not of unit length; made so",
                     "1 normal pointing into the surface turned out of it"}));
    expect_consistent(mesh);
    ASSERT_EQ(mesh.normals.size(), exact.normals.size());
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        EXPECT_LT(glm::distance(mesh.normals[v], exact.normals[v]), 0.05f) << v;
    }
}

TEST_F(RepairedScan, NormalsThatAllPointInwardAreTurnedRound) {
    ScanWriter scan = sphere_scan(12);
    const auto exact = load(scan);
    for (auto& normal : scan.normals) normal = -normal;
    const Mesh mesh = load(scan);
    ASSERT_EQ(notes_.size(), 1u);
    EXPECT_NE(notes_[0].find("normals pointing into the surface turned out of it"),
              std::string::npos);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        EXPECT_LT(glm::distance(mesh.normals[v], exact.normals[v]), 1e-6f);
    }
}

TEST_F(RepairedScan, UselessTrianglesAreDroppedAndCounted) {
    ScanWriter scan = sphere_scan(6);
    scan.faces.push_back({20, 20, 21});
    scan.faces.push_back({20, 20, 20});
    scan.faces.push_back(scan.faces[10]);
    scan.faces.push_back({scan.faces[11][2], scan.faces[11][1], scan.faces[11][0]});
    const Mesh mesh = load(scan);
    EXPECT_EQ(mesh.triangles.size(), 120u);
    EXPECT_EQ(notes_,
              (Notes{"2 triangles without area dropped", "2 triangles on top of others dropped"}));
    expect_consistent(mesh);
}

TEST_F(RepairedScan, WhereThreeSheetsMeetEachKeepsItsNormals) {
    ScanWriter scan;
    scan.positions = {{0, 0, 0}, {0, 0, 10}, {10, 0, 5}, {-10, 1, 5}, {0, 10, 5}};
    scan.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    const Mesh mesh = load(scan);
    EXPECT_EQ(mesh.positions_mm.size(), 9u);
    expect_consistent(mesh);
}

TEST_F(RepairedScan, TangentsWithoutTextureCoordinatesChangeLittle) {
    ScanWriter scan = sphere_scan(60);
    const Mesh mesh = load(scan);
    for (const auto& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            // Around the lowest point there is no continuous choice.
            if (mesh.normals[a].y < -0.95f) continue;
            EXPECT_GT(glm::dot(glm::vec3(mesh.tangents[a]), glm::vec3(mesh.tangents[b])), 0.85f);
        }
        if (mesh.normals[t.x].y > 0.999f) {
            EXPECT_GT(mesh.tangents[t.x].x, 0.99f) << "a roof's runs along x";
        }
    }
}

}  // namespace
}  // namespace livery
