// PLY and OBJ as they should be: what is read, and as what.
#include <cmath>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "mesh/mesh_checks.h"
#include "mesh/scan_writer.h"
#include "scene/product.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Notes = std::vector<std::string>;

class LoadScan : public ::testing::Test {
  protected:
    Mesh load(const char* name, const std::string& bytes) {
        notes_.clear();
        return load_mesh(folder_.write(name, bytes), &notes_, LengthUnit::mm);
    }
    std::vector<std::string> part_names(const Mesh& mesh) {
        std::vector<std::string> names;
        for (const Part& part : mesh.parts) names.push_back(part.name);
        return names;
    }
    TemporaryFolder folder_;
    Notes notes_;
};

TEST_F(LoadScan, EveryEncodingGivesTheSameSphere) {
    const ScanWriter scan = sphere_scan(16);
    const Mesh text = load("a.ply", scan.ascii_ply());
    // The seam and the poles of the sphere are there more than once.
    EXPECT_EQ(notes_, Notes{"79 duplicate vertices welded"});
    expect_consistent(text);
    EXPECT_GT(signed_volume(text), 0.95 * 4.0 / 3.0 * 3.14159 * 1e6);
    EXPECT_EQ(text.triangles.size(), scan.faces.size());
    for (const Mesh& other : {load("b.ply", scan.binary_ply(std::endian::little)),
                              load("c.ply", scan.binary_ply(std::endian::big)),
                              load("d.obj", scan.obj())}) {
        EXPECT_EQ(other.positions_mm, text.positions_mm);
        EXPECT_EQ(other.normals, text.normals);
        EXPECT_EQ(other.triangles, text.triangles);
    }
}

TEST_F(LoadScan, OtherTypesOrdersAndLineEndsAreRead) {
    const Mesh mesh = load("a.ply",
                           "ply\r\ncomment made by hand\r\nformat ascii 1.0\r\n"
                           "element face 1\r\nproperty uchar red\r\n"
                           "property list ushort uint32 vertex_index\r\n"
                           "element vertex 3\r\nproperty int16 z\r\nproperty double y\r\n"
                           "property uchar x\r\nend_header\r\n"
                           "255 3 0 1 2\r\n\r\n-5 0 0\r\n-5 0 10\r\n-5 1e1 0\r\n");
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions_mm[1], glm::vec3(10, 0, -5));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(notes_.at(0), "face colours are not read");
}

TEST_F(LoadScan, StripsAlternateAndRestart) {
    ScanWriter scan;
    scan.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 0}, {0, 20, 0}, {10, 20, 0}};
    scan.faces = {{0, 1, 2, 3, -1, 2, 3, 4, 5}};
    scan.face_element = "tristrips";
    scan.face_properties = "property list int int vertex_indices\n";
    const Mesh mesh = load("a.ply", scan.ascii_ply());
    EXPECT_EQ(mesh.triangles.size(), 4u);
    for (const auto& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(notes_, Notes{"no normals; computed, with edges sharper than 50 degrees kept sharp"});
}

TEST_F(LoadScan, WhatAVertexHasBesidesIsNamed) {
    ScanWriter scan = box_scan({10, 10, 10});
    scan.vertex_properties +=
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n"
        "property list uchar float weights\n";
    std::string text = scan.header("ascii");
    for (const auto& p : scan.positions) {
        text += fmt::format("{} {} {} 255 0 0 0.5 2 1 2\n", p.x, p.y, p.z);
    }
    for (const auto& f : scan.faces) {
        text += fmt::format("4 {} {} {} {}\n", f[0], f[1], f[2], f[3]);
    }
    const Mesh mesh = load("a.ply", text + "more\n");
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(notes_.at(0), "vertex colours are not read");
    EXPECT_EQ(notes_.at(1), "vertex properties that are not read: quality, weights");
    EXPECT_EQ(notes_.at(2), "what follows the last element is not read");
}

TEST_F(LoadScan, TextureCoordinatesFallDownThePicture) {
    const Mesh ply = load("a.ply",
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nproperty float s\nproperty float t\n"
                          "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                          "0 0 0 0 0\n10 0 0 1 0\n0 10 0 0 nan\n3 0 1 2\n");
    EXPECT_EQ(ply.uvs[1], glm::vec2(1, 1));
    EXPECT_EQ(notes_.at(0), "1 texture coordinate not a number; taken as 0");
    const Mesh obj =
        load("a.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    EXPECT_EQ(obj.uvs[2], glm::vec2(0, 0));
    EXPECT_LT(glm::distance(glm::vec3(obj.tangents[0]), glm::vec3(1, 0, 0)), 1e-6f);
    EXPECT_EQ(obj.tangents[0].w, 1.0f);
}

TEST_F(LoadScan, ObjCornersAreReadInEveryForm) {
    const char* points = "v 0 0 0\nv 10 0 0 1\nv 10 10 0 1 0 0\nv 0 10 0\nvn 0 0 1\nvt 0 0\n";
    for (const char* face : {"f 1 2 3 4",
                             "f -4 -3 -2 -1",
                             "f 1/1 2/1 3/1 4/1",
                             "f 1//1 2//1 3//1 4//1",
                             "f 1/1/1 2/-1/-1 3/1/1 \\\n 4/1/1",
                             "\tf  1\t2 3 4  # a quad"}) {
        const Mesh mesh = load("a.obj", std::string(points) + face + "\n");
        EXPECT_EQ(mesh.triangles.size(), 2u) << face;
        EXPECT_EQ(mesh.positions_mm.size(), 4u) << face;
        for (const auto& normal : mesh.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1)) << face;
        EXPECT_EQ(notes_.at(0), "vertex colours are not read");
    }
    // Faces may name what comes later.
    EXPECT_EQ(load("b.obj", "f 1 2 3\nv 0 0 0\nv 9 0 0\nv 0 9 0\n").triangles.size(), 1u);
}

TEST_F(LoadScan, ObjPartsAreMaterialsObjectsOrBoth) {
    const std::string points = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 20 0\n";
    const std::string a = "f 1 2 3\n", b = "f 1 3 4\n", c = "f 4 3 5\n";
    const auto names = [&](const std::string& faces) {
        return part_names(load("a.obj", points + faces));
    };
    EXPECT_EQ(names(a + b), Notes{"scan"});
    EXPECT_EQ(names("o car\n" + a + b), Notes{"car"});
    EXPECT_EQ(names("o car\nusemtl body\n" + a + "usemtl glass\n" + b), (Notes{"body", "glass"}));
    EXPECT_EQ(names("usemtl body\n" + a + "usemtl glass\n" + b + "usemtl body\n" + c),
              (Notes{"body", "glass"}));
    EXPECT_EQ(names("o door\n" + a + "o wheel\n" + b), (Notes{"door", "wheel"}));
    EXPECT_EQ(names("g door left\n" + a + "g wheel\n" + b), (Notes{"door left", "wheel"}));
    EXPECT_EQ(names("o door\nusemtl paint\n" + a + "usemtl trim\n" + b + "o wheel\n" + c),
              (Notes{"door/paint", "door/trim", "wheel"}));
    EXPECT_EQ(names("o car\ng one\n" + a + "g two\n" + b), Notes{"car"});
    EXPECT_EQ(names("usemtl caf\xff\x07\n" + a), Notes{"caf??"});
    const Mesh mesh = load("a.obj", points + "o door\n" + a + "o wheel\n" + b);
    EXPECT_EQ(mesh.triangle_part, (std::vector<std::uint16_t>{0, 1}));
}

TEST_F(LoadScan, MaterialLibrariesGiveColoursAndAreMissedByName) {
    const std::string mesh = "v 0 0 0\nv 10 0 0\nv 0 10 0\nusemtl red paint\nf 1 2 3\n";
    folder_.write("the paints.mtl", "newmtl red paint\nKd 0.8 0.1 0.05\nmap_Kd red.png\nNs 3\n");
    const Mesh red = load("a.obj", "mtllib the paints.mtl\n" + mesh);
    EXPECT_EQ(red.parts.at(0).material_name, "red paint");
    EXPECT_EQ(red.parts.at(0).base_colour_rec709, glm::dvec3(0.8, 0.1, 0.05));
    EXPECT_EQ(notes_.at(0), "material \"red paint\": the picture \"red.png\" is not read");

    const Mesh grey = load("a.obj", "mtllib gone.mtl\n" + mesh);
    EXPECT_EQ(grey.parts.at(0).base_colour_rec709, glm::dvec3(0.5));
    EXPECT_EQ(notes_.at(0),
              "the material library \"gone.mtl\" is missing; its colours are not known");
    load("a.obj", "mtllib ../../etc/passwd\n" + mesh);
    EXPECT_NE(notes_.at(0).find("not beside the file"), std::string::npos);
    folder_.write("bad.mtl", "newmtl red paint\nKd 0.8 nan 0\n");
    EXPECT_TRUE(fails_with([&] { load("a.obj", "mtllib bad.mtl\n" + mesh); },
                           {"bad.mtl: line 2: Kd: found \"nan\", expected three numbers"}));
}

TEST_F(LoadScan, WhatObjHasBesidesIsNamed) {
    load("a.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\ns 1\nl 1 2\ncurv 0 1\nf 1 2\nf 1 2 3\n");
    EXPECT_EQ(notes_.at(0), "lines that are not read: curv, l");
    EXPECT_EQ(notes_.at(1), "1 faces of fewer than three corners dropped");
}

TEST_F(LoadScan, ConcavePolygonsKeepTheirArea) {
    // An L, a comb whose teeth hide its ears, and both upside down.
    const std::string ell = "v 0 0 0\nv 30 0 0\nv 30 10 0\nv 10 10 0\nv 10 30 0\nv 0 30 0\n";
    for (const char* face : {"f 1 2 3 4 5 6\n", "f 6 5 4 3 2 1\n"}) {
        const Mesh mesh = load("a.obj", ell + face);
        EXPECT_EQ(mesh.triangles.size(), 4u);
        EXPECT_NEAR(area_mm2(mesh), 500.0, 1e-3);
    }
    std::string comb, face = "f";
    int corners = 0;
    const auto corner = [&](double x, double y) {
        comb += fmt::format("v {} {} {}\n", x, y, 0.5 * x);
        face += fmt::format(" {}", ++corners);
    };
    corner(0, -1);
    corner(400, -1);
    for (int tooth = 200; tooth-- > 0;) {
        corner(2 * tooth + 2, 0);
        corner(2 * tooth + 1, 50);
    }
    corner(0, 0);
    const Mesh mesh = load("a.obj", comb + face + "\n");
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(corners - 2));
    EXPECT_NEAR(area_mm2(mesh), (400 + 200 * 50) * std::sqrt(1.25), 1.0);
}

TEST_F(LoadScan, UnitsAreAskedForOrToldFromTheSize) {
    const auto side_mm = [&](double side, std::optional<LengthUnit> unit) {
        const auto file =
            folder_.write("a.obj", fmt::format("v 0 0 0\nv {} 0 0\nv 0 1e-2 0\nf 1 2 3\n", side));
        notes_.clear();
        const Bounds bounds = bounds_of(load_mesh(file, &notes_, unit));
        return bounds.high.x - bounds.low.x;
    };
    EXPECT_NEAR(side_mm(4.5, LengthUnit::mm), 4.5, 1e-6);
    EXPECT_NEAR(side_mm(4.5, LengthUnit::cm), 45.0, 1e-5);
    EXPECT_NEAR(side_mm(4.5, LengthUnit::m), 4500.0, 1e-3);
    EXPECT_NEAR(side_mm(4.5, LengthUnit::in), 114.3, 1e-4);
    EXPECT_EQ(notes_.size(), 1u) << "only about normals";

    EXPECT_NEAR(side_mm(4200.0, {}), 4200.0, 1e-3);
    EXPECT_EQ(notes_.at(0), "the file states no unit; its longest side of 4200 is taken as 4.2 m");
    EXPECT_NEAR(side_mm(0.18, {}), 180.0, 1e-4);
    EXPECT_EQ(notes_.at(0), "the file states no unit; its longest side of 0.18 is taken as 180 mm");
    EXPECT_NEAR(side_mm(4.5, {}), 4500.0, 1e-3);
    EXPECT_EQ(notes_.at(0),
              "the file states no unit; its longest side of 4.5 is taken as 4.5 m, but this is "
              "ambiguous: it could be 114 mm (in); --unit decides");
    EXPECT_NEAR(side_mm(180.0, {}), 180.0, 1e-3);
    EXPECT_EQ(notes_.at(0),
              "the file states no unit; its longest side of 180 is taken as 180 mm, but this is "
              "ambiguous: it could be 1.8 m (cm), 4.57 m (in); --unit decides");
    EXPECT_NEAR(side_mm(50000.0, {}), 50000.0, 1e-2);
    EXPECT_EQ(notes_.at(0),
              "the file states no unit; its longest side of 5e+04 is taken as 50 m, an unusual "
              "size for a product; --unit decides");
}

TEST_F(LoadScan, AProductFileSaysTheUnitAndItsCallerKnowsBetter) {
    folder_.write("a.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
    const auto file =
        folder_.write("a.json", R"({"format_version": 1, "mesh": "a.obj", "unit": "cm"})");
    EXPECT_EQ(load_product(file).mesh.positions_mm[1], glm::vec3(20, 0, 0));
    EXPECT_EQ(load_product(file, LengthUnit::in).mesh.positions_mm[1], glm::vec3(50.8f, 0, 0));
    folder_.write("a.json", R"({"format_version": 1, "mesh": "a.obj", "unit": "ft"})");
    EXPECT_TRUE(
        fails_with([&] { load_product(file); }, {"unit: found \"ft\", expected mm, cm, m or in"}));
}

}  // namespace
}  // namespace livery
