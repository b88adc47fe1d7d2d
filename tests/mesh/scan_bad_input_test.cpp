// Bad PLY, OBJ and MTL: each mistake is named, with its line or element.
#include <gtest/gtest.h>

#include "core/random.h"
#include "mesh/scan_writer.h"
#include "support/file_error.h"
#include "support/memory_folder.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

struct Bad {
    const char* what;
    std::string bytes;
    std::vector<std::string> message;
};

std::string ply(const std::string& header, const std::string& body, const char* format = "ascii") {
    return std::string("ply\nformat ") + format + " 1.0\n" + header + "end_header\n" + body;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kVertices = "element vertex 3\n" + kXyz;
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPoints = "0 0 0\n9 0 0\n0 9 0\n";

const Bad kBadPly[] = {
    {"nothing", "", {"found an empty file, expected a mesh"}},
    {"another kind", "solid cube\n", {"header: found no \"ply\" at the start"}},
    {"only the magic", "ply\n", {"header, line 2: found nothing, expected end_header"}},
    {"no format", "ply\n" + kVertices + "end_header\n", {"header: found no format"}},
    {"another format",
     "ply\nformat utf8 1.0\n",
     {"line 2: found \"utf8\", expected ascii, binary"}},
    {"newer version", "ply\nformat ascii 2.0\n", {"found \"2.0\", expected version 1.0"}},
    {"a word",
     ply("elemnt vertex 3\n", ""),
     {"line 3: found \"elemnt\", expected format, element"}},
    {"property first",
     ply("property float x\n", ""),
     {"line 3: found \"property\", expected an el"}},
    {"bytes for a type",
     ply("element vertex 3\nproperty \xff\x01 x\n", ""),
     {"line 4: found \"??\""}},
    {"no count", ply("element vertex\n", ""), {"line 3: found nothing, expected how many"}},
    {"negative count", ply("element vertex -3\n", ""), {"line 3: found \"-3\""}},
    {"huge count",
     ply("element vertex 99999999999999999999\n", ""),
     {"found \"9999999999999999999"}},
    {"twice",
     ply(kVertices + "element vertex 3\n", ""),
     {"found \"vertex\", expected each element"}},
    {"x twice", ply(kVertices + "property float x\n", ""), {"found \"x\", expected each property"}},
    {"more words",
     ply("element vertex 3 4\n", ""),
     {"line 3: found \"4\", expected the end of the"}},
    {"length as float",
     ply("element face 1\nproperty list float int vertex_indices\n", ""),
     {"found \"list of float\", expected a whole number"}},
    {"no vertices", ply(kFace, "0\n"), {"header: found no element vertex"}},
    {"no z",
     ply("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n"),
     {"element vertex: found no property z"}},
    {"x as a list", ply("element vertex 1\nproperty list int int x\n", "0\n"), {"no property x"}},
    {"faces without a list",
     ply(kVertices + "element face 1\nproperty int a\n", kPoints + "3\n"),
     {"element face: found no list \"vertex_indices\""}},
    {"float indices",
     ply(kVertices + "element face 1\nproperty list int float vertex_indices\n",
         kPoints + "3 0 1 2\n"),
     {"\"vertex_indices\" that is no list of whole numbers"}},
    {"promises",
     ply("element vertex 4000000000\n" + kXyz + kFace, kPoints + "3 0 1 2\n"),
     {"element vertex: found 4000000000 declared in 27 bytes, expected at most 4"}},
    {"a cloud",
     ply(kVertices, kPoints),
     {"found a point cloud: 3 vertices without faces, expected"}},
    {"a cloud with an empty list",
     ply(kVertices + "element face 0\nproperty list uchar int "
                     "vertex_indices\n",
         kPoints),
     {"found a point cloud: 3 vertices"}},
    {"no number",
     ply(kVertices + kFace, "0 0 0\n9 zero 0\n0 9 0\n3 0 1 2\n"),
     {"line 11: y: found \"zero\", expected a number"}},
    {"too few",
     ply(kVertices + kFace, "0 0 0\n9 0\n0 9 0\n3 0 1 2\n"),
     {"line 11: z: found no more numbers, expected a number"}},
    {"too many",
     ply(kVertices + kFace, "0 0 0\n9 0 0 1\n0 9 0\n3 0 1 2\n"),
     {"line 11: found \"1\" at its end"}},
    {"nan",
     ply(kVertices + kFace, "0 0 0\n9 nan 0\n0 9 0\n3 0 1 2\n"),
     {"line 11: y: found nan at vertex 1, expected a finite number"}},
    {"infinite",
     ply(kVertices + kFace, "0 0 0\n9 0 0\n0 9 1e999\n3 0 1 2\n"),
     {"line 12: z: found inf at vertex 2"}},
    {"cut off",
     ply(kVertices + kFace, "0 0 0\n9 0 0\n0 9 0\n3 0"),
     {"line 13: vertex_indices: found a list of 3, expected at most the 2 that"}},
    {"an index too high",
     ply(kVertices + kFace, kPoints + "3 0 1 3\n"),
     {"line 13: vertex_indices: found the vertex 3, expected 0 to 2"}},
    {"an index below 0", ply(kVertices + kFace, kPoints + "3 0 1 -1\n"), {"found the vertex -1"}},
    {"half an index",
     ply(kVertices + kFace, kPoints + "3 0 1 1.5\n"),
     {"\"1.5\", expected a whole"}},
    {"a long list",
     ply(kVertices + kFace, kPoints + "4000000000 0 1 2\n"),
     {"found a list of 4000000000, expected at most the"}},
    {"a negative list", ply(kVertices + kFace, kPoints + "-3 0 1 2\n"), {"found a list of -3"}},
    {"a line",
     ply(kVertices + kFace, "0 0 0\n9 0 0\n18 0 0\n3 0 1 2\n"),
     {"found no triangle that has an area"}},
    {"far away",
     ply(kVertices + kFace, "0 0 0\n9 0 0\n0 2e9 0\n3 0 1 2\n"),
     {"vertex 2: found a vertex 2e+09 mm away, expected positions within 1e+09 mm"}},
    {"binary cut off",
     ply(kVertices + kFace, std::string(36, '\0') + "\3\0\0", "binary_little_endian"),
     {"face 0: vertex_indices: found a list of 3, expected at most the 0 that can follow"}},
    {"binary nan",
     ply(kVertices + kFace,
         std::string(14, '\0') + "\xc0\x7f" + std::string(33, '\0'),
         "binary_little_endian"),
     {"vertex 1: x: found nan at vertex 1"}},
};

const Bad kBadObj[] = {
    {"nothing", "\n", {"found no triangles"}},
    {"another kind",
     std::string("\x7f"
                 "ELF\0\0\1",
                 7),
     {"found no triangles (lines that are not read: ", "expected at least one"}},
    {"a cloud", "v 0 0 0\nv 1 0 0\n", {"found a point cloud: 2 vertices without faces"}},
    {"no number", "v 0 zero 0\n", {"line 1: v: found \"zero\", expected a number"}},
    {"too few", "v 0 0\nv 1 0 0\n", {"line 1: v: found nothing, expected a number"}},
    {"nan", "v 0 0 0\nv 0 NaN 0\n", {"line 2: v: found \"NaN\" at vertex 2, expected a finite"}},
    {"an index too high",
     "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 4\nf 1 2 3\n",
     {"line 4: f: found v 4, expected 1 to 3, the number there are"}},
    {"no such normal",
     "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1//1 2//1 3//1\n",
     {"f: found vn 1, expected 1 to 0"}},
    {"no such uv", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1/7 2/7 3/7\n", {"line 4: f: found vt 7"}},
    {"index 0", "v 0 0 0\nf 0 1 1\n", {"line 2: f: found \"0\", expected the number of a v"}},
    {"too far back",
     "v 0 0 0\nv 9 0 0\nf -1 -2 -3\n",
     {"line 3: f: found v -3, expected one of the 2 above"}},
    {"lowest index", "v 0 0 0\nf -9223372036854775808 1 1\n", {"found v -9223372036854775808"}},
    {"huge index",
     "v 0 0 0\nf 9223372036854775807 1 1\n",
     {"found v 9223372036854775807, expected at most"}},
    {"a word", "v 0 0 0\nf one 1 1\n", {"line 2: f: found \"one\""}},
    {"four parts",
     "v 0 0 0\nvt 0 0\nvn 0 0 1\nf 1/1/1/1 1 1\n",
     {"\"1/1/1/1\", expected a corner such as"}},
    {"joined lines", "v 0 0 0\nv 0 \\\n0 \\\nzero\n", {"line 4: v: found \"zero\""}},
};

void expect_named(const char* name, const Bad& bad) {
    const TemporaryFolder folder(memory_folder());
    const auto file = folder.write(name, bad.bytes);
    for (const std::string& part : bad.message) {
        EXPECT_TRUE(fails_with([&] { load_mesh(file, nullptr, LengthUnit::mm); }, {name, part}))
            << bad.what;
    }
}

TEST(BadScan, EachMistakeInAPlyIsNamed) {
    for (const Bad& bad : kBadPly) expect_named("a.ply", bad);
}

TEST(BadScan, EachMistakeInAnObjIsNamed) {
    for (const Bad& bad : kBadObj) expect_named("a.obj", bad);
}

TEST(BadScan, AFileThatIsNotThereIsNamed) {
    EXPECT_TRUE(fails_with([&] { load_mesh("/no folder/a.ply"); }, {"a.ply: found no such file"}));
    EXPECT_TRUE(fails_with([&] { load_mesh("/proc"); }, {"found a folder"}));
}

TEST(BadScan, PolygonsWithThousandsOfCornersAreRefused) {
    std::string points, face = "f";
    for (int k = 0; k < 4097; ++k) {
        points += fmt::format("v {} {} 0\n", k, k % 2);
        face += fmt::format(" {}", k + 1);
    }
    const TemporaryFolder folder(memory_folder());
    EXPECT_TRUE(fails_with([&] { load_mesh(folder.write("a.obj", points + face + "\n")); },
                           {"line 4098: f: found more than 4096 corners"}));
}

/// Whatever stands in a file, it is read or refused by name; the sanitizers watch.
TEST(BadScan, AnyDamageIsReadOrRefused) {
    const TemporaryFolder folder(memory_folder());
    const ScanWriter scan = sphere_scan(4);
    const std::pair<const char*, std::string> whole[] = {
        {"a.ply", scan.ascii_ply()},
        {"b.ply", scan.binary_ply(std::endian::little)},
        {"c.ply", scan.binary_ply(std::endian::big)},
        {"d.obj", "mtllib gone.mtl\no a\nusemtl b\n" + scan.obj()}};
    Random random(11, 1);
    for (const auto& [name, bytes] : whole) {
        for (int round = 0; round < 400; ++round) {
            std::string damaged = bytes;
            if (round % 4 == 0) {
                damaged.resize(
                    static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size())));
            }
            for (int k = 0; k < 1 + round % 5 && !damaged.empty(); ++k) {
                const auto at = static_cast<std::size_t>(random.uniform() *
                                                         static_cast<double>(damaged.size()));
                damaged[at] = static_cast<char>(random.below(256));
            }
            try {
                const Mesh mesh = load_mesh(folder.write(name, damaged));
                EXPECT_FALSE(mesh.triangles.empty());
            } catch (const FileError& error) {
                EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
            }
        }
    }
}

}  // namespace
}  // namespace livery
