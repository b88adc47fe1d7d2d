// Bench files, spectral tables and paint files: what is shipped reads, what is broken is refused by
// name.
#include <fstream>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "scene/library.h"
#include "small_bench.h"
#include "twin/painted_sphere.h"

namespace livery {
namespace {

using namespace livery::testing;

class Files : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() / ("livery-twin-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        write("grey.csv", "wavelength,a\n380,0.5\n780,0.5\n");
        write("rgb.csv", "nm,R,G,B\n380,0.1,0.1,0.3\n780,0.3,0.2,0.1\n");
        write("product.json", "{}");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }

    /// A good bench file; a test replaces one piece of it.
    std::string bench_text() const {
        return R"({"format_version": 1, "kind": "bench", "name": "t", "product": "product.json",
"projector": {"width": 64, "height": 48, "matrix": [100, 0, 31.5, 0, 100, 23.5, 0, 0, 1],
 "from_mm": [0, 10, 500], "at_mm": [0, 0, 0], "gamma": 2.0},
"camera": {"width": 64, "height": 48, "matrix": [100, 0, 31.5, 0, 100, 23.5, 0, 0, 1],
 "rotation": [1, 0, 0, 0, -1, 0, 0, 0, -1], "translation_mm": [0, 0, 500],
 "sensitivities": "rgb.csv"},
"mockup": {"surfaces": {"*": {"reflectance": "grey.csv"}}},
"eye_mm": [1, 2, 3]})";
    }
    std::string with(const std::string& from, const std::string& to) const {
        std::string text = bench_text();
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }

    std::filesystem::path folder_;
};

/// Field, what was found and what was expected; the message itself names all of it and the file.
template <typename Read>
void expect_refused(const Read& read,
                    const std::string& field,
                    const std::string& found,
                    const std::string& expected) {
    try {
        read();
        ADD_FAILURE() << "read without an error; expected one about " << field;
    } catch (const FileError& error) {
        EXPECT_EQ(error.field(), field);
        EXPECT_NE(error.found().find(found), std::string::npos) << error.what();
        EXPECT_NE(error.expected().find(expected), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(error.file().string()), std::string::npos);
    }
}

TEST(BenchFile, EveryShippedProductStandsOnOneOfItsOwn) {
    int products = 0;
    for (const auto& entry : std::filesystem::directory_iterator(shipped_path("assets"))) {
        if (entry.path().extension() != ".json") continue;
        ++products;
        const std::string name = entry.path().stem().string();
        const auto bench = bench_of_shipped_product(name);
        ASSERT_TRUE(bench) << name;
        const BenchDescription description = read_bench_file(*bench);
        EXPECT_EQ(std::filesystem::path(description.product).stem(), name) << "bench " << *bench;
    }
    EXPECT_GE(products, 3);
    EXPECT_FALSE(bench_of_shipped_product("teapot"));
    EXPECT_FALSE(bench_of_shipped_product(""));
}

TEST_F(Files, EveryShippedBenchReadsAndStandsAsDocumented) {
    for (const char* name :
         {"default", "paper-2.75m", "white-segment", "led", "hard", "player", "sphere"}) {
        const BenchDescription bench = read_bench_file(name);
        EXPECT_EQ(bench.name, name);
        const std::string product(name);
        const glm::dvec3 middle(
            0.0, product == "sphere" ? 0.0 : (product == "player" ? 48.0 : 26.0), 0.0);
        const auto direction = [&](const glm::dvec3& from) {
            return glm::normalize(from - middle);
        };
        const auto degrees = [](const glm::dvec3& a, const glm::dvec3& b) {
            return std::acos(glm::dot(a, b)) * 57.29577951308232;
        };
        const auto projector = direction(centre_in_world(bench.projector.view));
        const auto camera = direction(centre_in_world(bench.camera.view));
        EXPECT_GT(degrees(projector, camera), 10.0) << name;
        EXPECT_NEAR(degrees(direction(bench.eye_mm), camera), 30.0, 3.0) << name;
        const auto pixel = project(bench.projector.view, middle);
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x, 640.5, 1.0) << name;
        EXPECT_NEAR(pixel->y, 402.0, 5.0) << name;
    }
    const BenchDescription clean = read_bench_file("default");
    EXPECT_EQ(clean.projector.leak, 0.0);
    EXPECT_EQ(clean.projector.white_segment, 0.0);
    EXPECT_EQ(clean.projector.flicker, 0.0);
    EXPECT_EQ(clean.camera.flare, 0.0);
    EXPECT_EQ(clean.camera.shift_px, 0.0);
    EXPECT_GT(clean.camera.electrons_per_unit, 0.0);
    EXPECT_NE(clean.camera.view.distortion[0], 0.0);
    EXPECT_FALSE(clean.mockup.interreflection);
    EXPECT_EQ(clean.ambient, 0.0);
    const BenchDescription hard = read_bench_file("hard");
    EXPECT_EQ(hard.projector.gamma, clean.projector.gamma);  // from its base
    EXPECT_GT(hard.projector.gamma_spread, 0.0);
    EXPECT_EQ(hard.camera.flare, 0.01);
    EXPECT_EQ(hard.camera.shift_px, 1.0);
    EXPECT_TRUE(hard.mockup.interreflection);
    EXPECT_EQ(hard.ambient, 0.01);
    EXPECT_GT(read_bench_file("white-segment").projector.white_segment, 0.0);
}

TEST_F(Files, MishapsAreReadAndWrongOnesNamed) {
    const auto bench_with = [&](const std::string& mishap) {
        return read_bench_file(
            write("b.json", with("\"camera\"", "\"mishaps\": [" + mishap + "], \"camera\"")));
    };
    const BenchDescription bench = bench_with(R"({"what": "room-light", "from": 3, "size": 0.25})");
    ASSERT_EQ(bench.mishaps.size(), 1u);
    EXPECT_EQ(bench.mishaps[0].kind, MishapKind::room_light);
    EXPECT_EQ(bench.mishaps[0].from, 3);
    EXPECT_GT(bench.mishaps[0].to, 1'000'000);
    EXPECT_EQ(bench.mishaps[0].size, 0.25);
    expect_refused([&] { bench_with(R"({"what": "rain", "size": 1})"); },
                   "mishaps[0].what",
                   "'rain'",
                   "room-light");
    expect_refused(
        [&] { bench_with(R"({"what": "shadow", "size": 2})"); }, "mishaps[0].size", "2", "1");
}

TEST_F(Files, APlacedViewLooksWhereItSays) {
    const auto file = write("b.json",
                            with("\"at_mm\": [0, 0, 0]",
                                 "\"at_mm\": [5, -3, 20], \"at_px\": [40, -8], "
                                 "\"distortion\": [-0.1, 0, 0.001, 0, 0]"));
    const View view = read_bench_file(file).projector.view;
    const auto pixel = project(view, {5, -3, 20});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, 40.5, 1e-7);  // the file's pixel centres are at integers
    EXPECT_NEAR(pixel->y, -7.5, 1e-7);
    EXPECT_NEAR(glm::distance(centre_in_world(view), glm::dvec3(0, 10, 500)), 0.0, 1e-9);
    EXPECT_NEAR(glm::determinant(view.view_from_world.rotation), 1.0, 1e-12);
    // World up stays up: a point above appears in the same column of the optical axis, higher up.
    const auto above = project(view, {5, 3, 20});
    EXPECT_LT(above->y, pixel->y);
}

TEST_F(Files, BrokenBenchFilesAreRefusedByName) {
    const auto refuses =
        [&](const std::string& text, const char* field, const char* found, const char* expected) {
            const auto file = write("b.json", text);
            expect_refused([&] { read_bench_file(file); }, field, found, expected);
        };
    expect_refused([&] { read_bench_file(folder_ / "none.json"); }, "", "no such file", "a file");
    expect_refused(
        [&] { read_bench_file("no-such-bench"); },
        "bench",
        "no such file or shipped bench",
        "a bench file or default, hard, led, paper-2.75m, player, room, sphere, white-segment");
    refuses("", "", "an empty file", "a JSON object");
    refuses(bench_text().substr(0, 200), "line 3, column 31", "not JSON", "complete");
    refuses(with("\"bench\"", "\"captures\""), "kind", "'captures'", "'bench'");
    refuses(with("\"format_version\": 1", "\"format_version\": 2"), "format_version", "newer", "1");
    refuses(with("\"gamma\": 2.0", "\"gama\": 2.0"), "projector", "gama", "only width");
    refuses(with("\"gamma\": 2.0", "\"gamma\": [2, 2]"), "projector.gamma", "2 elements", "3");
    refuses(with("\"gamma\": 2.0", "\"gamma\": 90"), "projector.gamma", "90", "between 0.2 and 5");
    refuses(with("\"gamma\": 2.0", "\"flicker\": -1"), "projector.flicker", "-1", "between 0");
    refuses(with("\"width\": 64", "\"width\": 100000"), "projector.width", "100000", "16384");
    refuses(with("\"from_mm\": [0, 10, 500], ", ""), "projector.from_mm", "nothing", "this field");
    refuses(with("\"from_mm\": [0, 10, 500], \"at_mm\": [0, 0, 0], ", ""),
            "projector",
            "no pose",
            "either rotation");
    refuses(with("\"gamma\": 2.0", "\"translation_mm\": [0, 0, 1]"),
            "projector",
            "two poses",
            "either rotation");
    refuses(with("[0, 10, 500]", "[0, 10, 0]"), "projector.from_mm", "straight above", "beside");
    refuses(with("\"at_mm\": [0, 0, 0]",
                 "\"at_mm\": [0, 0, 0], \"at_px\": [4000, 405], "
                 "\"distortion\": [-0.045, 0, 20, 0, 0]"),
            "projector.at_px",
            "[4000",
            "a pixel that light reaches through this lens");
    refuses(with("\"at_mm\": [0, 0, 0]", "\"at_mm\": [1e308, 0, -1e308]"),
            "projector.at_mm[0]",
            "1e+308",
            "between -1e+");
    refuses(with("[1, 0, 0, 0, -1, 0, 0, 0, -1]", "[1, 0, 0, 0, -1, 0, 0, 0, 1]"),
            "camera.rotation",
            "a mirror",
            "a rotation");
    refuses(with("[100, 0, 31.5", "[-100, 0, 31.5"), "projector.matrix[0]", "-100", "between 0.1");
    refuses(with("\"eye_mm\": [1, 2, 3]", "\"eye_mm\": [1, 2]"), "eye_mm", "2 elements", "3");
    refuses(
        with("\"eye_mm\": [1, 2, 3]", "\"eye_mm\": [1, 2, null]"), "eye_mm[2]", "null", "number");
    refuses(with("\"grey.csv\"", "\"grey.csv#b\""),
            "mockup.surfaces.*.reflectance",
            "'b'",
            "one of a in");
    refuses(with("\"grey.csv\"", "1.5"), "mockup.surfaces.*.reflectance", "1.5", "between 0 and 1");
    refuses(with("\"grey.csv\"", "\"none.csv\""), "", "nothing in", "shipped");
    refuses(with("\"rgb.csv\"", "\"grey.csv\""), "header", "other columns", "R, G, B");
    refuses(with("\"product.json\"", "\"none.glb\""), "", "nothing in", "shipped");
    refuses(with("\"sensitivities\": \"rgb.csv\"", "\"exposure_s\": 1"),
            "camera.sensitivities",
            "nothing",
            "this field");
    write("bright.csv", "nm,x\n380,0.5\n780,1.2\n");
    refuses(with("\"grey.csv\"", "\"bright.csv\""),
            "mockup.surfaces.*.reflectance",
            "1.2",
            "at most 1");
    refuses(with("\"rgb.csv\"", "\"rgb.csv\", \"encoding\": \"jpeg\""),
            "camera.encoding",
            "'jpeg'",
            "raw14 or srgb8");
    // A base must stand alone, and its own faults are told under its own name.
    write("b.json", bench_text());
    write("c.json", R"({"format_version": 1, "base": "b.json", "name": "c"})");
    EXPECT_EQ(read_bench_file(folder_ / "c.json").name, "c");
    const auto d = write("d.json", R"({"format_version": 1, "base": "c.json", "name": "d"})");
    expect_refused([&] { read_bench_file(d); }, "base", "a base", "none in a file");
}

TEST_F(Files, BrokenSpectraAreRefusedByName) {
    const auto refuses =
        [&](const std::string& text, const char* field, const char* found, const char* expected) {
            const auto file = write("s.csv", text);
            expect_refused([&] { read_spectra_csv(file); }, field, found, expected);
        };
    expect_refused([&] { read_spectra_csv(folder_ / "no.csv"); }, "", "no such file", "a file");
    refuses("", "", "nothing", "a header");
    refuses("# only a comment\n", "", "nothing", "a header");
    refuses("colour,R\n400,1\n700,1\n", "line 1", "'colour'", "'wavelength' or 'nm'");
    refuses("nm\n400\n700\n", "line 1", "no spectrum", "one or more");
    refuses("nm,R\n400,1\n", "", "1 rows", "2 or more");
    refuses("nm,R\n400,1\n700,1,2\n", "line 3", "3 cells", "2, as in the header");
    refuses("nm,R\n400,1\n700\n", "line 3", "1 cell", "2, as in the header");
    refuses("nm,R\n400,nan\n700,1\n", "line 2, R", "'nan'", "finite");
    refuses("nm,R\n400,-0.1\n700,1\n", "line 2, R", "'-0.1'", "0 or more");
    refuses("nm,R\n400,1x\n700,1\n", "line 2, R", "'1x'", "finite");
    refuses("nm,R\n400,1\n400,1\n700,1\n", "line 3, nm", "'400'", "above that of the row before");
    refuses("nm,R\n410,1\n700,1\n", "wavelength", "410", "400 to 700");
    refuses("nm,R\n400,1\n690,1\n", "wavelength", "690", "400 to 700");
    std::string wide = "nm", row = "400";
    for (int k = 0; k < 80; ++k) wide += ",a", row += ",1";
    refuses(wide + "\n" + row + "\n", "line 1", "81 columns", "at most 65");
    std::string tall = "nm,R\n";
    for (int k = 0; k < 10'002; ++k) tall += std::to_string(300.0 + 0.05 * k) + ",1\n";
    refuses(tall, "line 10002", "more rows", "at most 10000");
}

TEST_F(Files, SpectraAreInterpolatedAndCommentsAndQuotesAllowed) {
    const auto file =
        write("s.csv", "# a comment\r\n\"wavelength\", R ,G\r\n\r\n380,0,1\r\n780,4,1\r\n");
    const SpectrumTable table = read_spectra_csv(file);
    EXPECT_EQ(table.names, (std::vector<std::string>{"R", "G"}));
    EXPECT_DOUBLE_EQ(table.columns[0][0], 0.0);
    EXPECT_DOUBLE_EQ(table.columns[0][40], 2.0);
    EXPECT_DOUBLE_EQ(table.columns[0][80], 4.0);
    EXPECT_DOUBLE_EQ(table.columns[1][17], 1.0);
}

TEST_F(Files, BrokenPaintsAreRefusedByName) {
    write("p.csv", "nm,diffuse,f0\n380,0.1,0.5\n780,0.1,0.5\n");
    const std::string good = R"({"format_version": 1, "kind": "spectral-paint", "name": "p",
"family": "solid", "spectra": "p.csv", "alpha": 0.3, "coat_alpha": 0.1, "coat_f0": 0.04,
"provenance": "test"})";
    EXPECT_EQ(read_spectral_paint(write("p.json", good)).f0[3], 0.5);
    const auto refuses = [&](const std::string& from,
                             const std::string& to,
                             const char* field,
                             const char* found,
                             const char* expected) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        const auto file = write("q.json", text);
        expect_refused([&] { read_spectral_paint(file); }, field, found, expected);
    };
    expect_refused([&] { read_spectral_paint("no-such-paint"); }, "", "nothing in", "shipped");
    expect_refused([&] { read_spectral_paint(write("e.json", " ")); }, "", "an empty file", "JSON");
    refuses("spectral-paint", "paint", "kind", "'paint'", "'spectral-paint'");
    refuses("\"format_version\": 1", "\"format_version\": 9", "format_version", "newer", "1");
    refuses("\"alpha\": 0.3", "\"alpha\": 0", "alpha", "0", "between 0.001");
    refuses("\"alpha\": 0.3", "\"alfa\": 0.3", "", "alfa", "only");
    refuses(", \"coat_f0\": 0.04", "", "coat_f0", "nothing", "this field");
    refuses("p.csv", "none.csv", "", "no such file", "a file");
    refuses("p.csv", "grey.csv", "header", "no column 'diffuse'", "diffuse and f0");
    write("loud.csv", "nm,diffuse,f0\n380,0.1,0.5\n780,1.1,0.5\n");
    refuses("p.csv", "loud.csv", "diffuse", "1.1", "at most 1");
}

}  // namespace
}  // namespace livery
