#include "capture/captures_folder.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "capture/patterns_folder.h"
#include "core/colour.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/reference_data.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// A folder with one 4x3 photograph, 000.png, and the manifest given.
struct Folder {
    TemporaryFolder folder;
    explicit Folder(const std::string& manifest) {
        write_png(folder / "000.png", Image8(4, 3, 3, 128));
        folder.write("manifest.json", manifest);
    }
    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        return fails_with([&] { read_captures_folder(folder.path(), PhotographUse::light); },
                          parts);
    }
};

/// A manifest of one capture with the members given.
std::string one_capture(const std::string& members) {
    return R"({"projector": [8, 6], "captures": [{)" + members + "}]}";
}

TEST(CapturesFolder, ReadsAManifest) {
    const Folder made(R"({"projector": [1280, 800], "captures": [
        {"file": "000.png", "pattern": "../p/000.png", "role": "dark-gray", "drive": [80, 80, 80],
         "exposure_s": 0.25, "transfer": "srgb", "black_level": 2.5, "saturates_at": 250}]})");
    const auto read = read_captures_folder(made.folder.path(), PhotographUse::light);
    EXPECT_EQ(read.projector_width, 1280);
    EXPECT_EQ(read.projector_height, 800);
    ASSERT_EQ(read.captures.size(), 1u);
    const auto& capture = read.captures[0];
    EXPECT_EQ(capture.file, made.folder / "000.png");
    EXPECT_EQ(capture.pattern, made.folder / "../p/000.png");
    EXPECT_EQ(capture.role, "dark-gray");
    EXPECT_EQ(capture.drive, (std::vector<int>{80, 80, 80}));
    EXPECT_EQ(capture.exposure_s, 0.25);
    EXPECT_EQ(capture.transfer, "srgb");
    EXPECT_EQ(capture.black_level, 2.5);
    EXPECT_EQ(capture.saturates_at, 250.0);
}

TEST(CapturesFolder, SettingsOfTheWholeFolderAreDefaults) {
    const Folder made(R"({"projector": [8, 6], "exposure_s": 0.5, "black_level": 3, "captures": [
        {"file": "000.png", "role": "white"},
        {"file": "000.png", "role": "black", "exposure_s": 2, "drive": 0}]})");
    const auto captures = read_captures_folder(made.folder.path(), PhotographUse::light).captures;
    ASSERT_EQ(captures.size(), 2u);
    EXPECT_EQ(captures[0].exposure_s, 0.5);
    EXPECT_EQ(captures[1].exposure_s, 2.0);
    EXPECT_EQ(captures[1].black_level, 3.0);
    EXPECT_EQ(captures[1].drive, (std::vector<int>{0, 0, 0}));
    EXPECT_EQ(captures[0].transfer, "linear");
}

TEST(CapturesFolder, BadManifestsSayWhy) {
    const std::string good = R"("file": "000.png", "role": "white", "exposure_s": 1)";
    EXPECT_NO_THROW(
        read_captures_folder(Folder(one_capture(good)).folder.path(), PhotographUse::light));

    EXPECT_TRUE(Folder("").fails({"manifest.json", "an empty file", "a JSON object"}));
    EXPECT_TRUE(Folder(one_capture(good).substr(0, 60)).fails({"manifest.json", "not JSON"}));
    EXPECT_TRUE(Folder("[1, 2]").fails({"manifest.json", "array", "a JSON object"}));
    EXPECT_TRUE(Folder("{}").fails({"captures", "nothing"}));
    EXPECT_TRUE(Folder(R"({"captures": [{}]})").fails({"projector", "nothing"}));
    EXPECT_TRUE(Folder(R"({"projector": [8, 6], "captures": []})").fails({"an empty list"}));
    EXPECT_TRUE(Folder(R"({"projector": [8], "captures": [{}]})").fails({"[width, height]"}));
    EXPECT_TRUE(Folder(R"({"projector": [1e9, 6], "captures": [{}]})")
                    .fails({"projector[0]", "1000000000", "between 1 and 16384"}));
    EXPECT_TRUE(Folder(R"({"format_version": 2, "projector": [8, 6], "captures": [{}]})")
                    .fails({"format_version", "2 (written by a newer Livery)"}));
    EXPECT_TRUE(Folder(R"({"projektor": [8, 6], "captures": [{}]})")
                    .fails({"unknown field \"projektor\"", "only"}));

    const auto fails = [](const std::string& members,
                          std::initializer_list<std::string_view> parts) {
        return Folder(one_capture(members)).fails(parts);
    };
    EXPECT_TRUE(fails(R"("role": "white", "exposure_s": 1)", {"captures[0].file", "nothing"}));
    EXPECT_TRUE(fails(R"("file": "1.png", "role": "white", "exposure_s": 1)",
                      {"captures[0].file", "no such file", "1.png"}));
    EXPECT_TRUE(fails(R"("file": "000.png", "role": "pink", "exposure_s": 1)",
                      {"captures[0].role", "\"pink\"", "a known role"}));
    EXPECT_TRUE(fails(R"("file": "000.png", "role": "white")", {"captures[0].exposure_s"}));
    EXPECT_TRUE(fails(R"("file": "000.png", "role": "white", "exposure_s": null)",
                      {"captures[0].exposure_s", "nothing", "fill in exposure_s"}));
    EXPECT_TRUE(fails(R"("file": "000.png", "role": "white", "exposure_s": 0)",
                      {"captures[0].exposure_s", "found 0", "between"}));
    EXPECT_TRUE(fails(R"("file": "000.png", "role": "white", "exposure_s": NaN)", {"not JSON"}));
    EXPECT_TRUE(fails(good + R"(, "transfer": "log")",
                      {"captures[0].transfer", "\"log\"", "a response file"}));
    EXPECT_TRUE(fails(good + R"(, "black_level": 20, "saturates_at": 10)",
                      {"captures[0].saturates_at", "more than black_level"}));
    EXPECT_TRUE(fails(good + R"(, "drive": [1, 2])", {"captures[0].drive", "[R, G, B]"}));
    EXPECT_TRUE(fails(good + R"(, "drive": [1, 2, 256])", {"captures[0].drive[2]", "256"}));
    EXPECT_TRUE(fails(good + R"(, "exposure": 1)", {"unknown field \"exposure\""}));
    EXPECT_TRUE(fails(good + "}, {" + good, {"captures[1].file", "a second time"}));
}

TEST(CapturesFolder, ARoleMayComeAsOftenAsThereArePhotographsOfIt) {
    const std::string good = R"("file": "000.png", "role": "white", "exposure_s": 1)";
    const Folder made(
        one_capture(good + R"(}, {"file": "001.png", "role": "white", "exposure_s": 1)"));
    made.folder.write("001.png", "");
    const auto captures = read_captures_folder(made.folder.path(), PhotographUse::light).captures;
    ASSERT_EQ(captures.size(), 2u);
    EXPECT_EQ(captures[1].role, "white");
    EXPECT_EQ(captures[1].file.filename(), "001.png");
}

TEST(CapturesFolder, AnswersAsACameraRoleByRole) {
    const Folder made(R"({"projector": [8, 6], "exposure_s": 0.5, "captures": [
        {"file": "000.png", "role": "red"},
        {"file": "001.png", "role": "white", "exposure_s": 2},
        {"file": "002.png", "role": "red", "black_level": 3}]})");
    for (const int k : {1, 2})
        write_png(made.folder / ("00" + std::to_string(k) + ".png"),
                  Image8(4, 3, 3, static_cast<std::uint8_t>(10 * k)));
    const BenchPorts ports =
        ports_of(read_captures_folder(made.folder.path(), PhotographUse::light));
    EXPECT_FALSE(ports.measure_xyz);
    ports.show(Image8(8, 6, 3));
    EXPECT_THROW(ports.photograph(0.0), std::invalid_argument);

    EXPECT_EQ(ports.turn_to("red"), 2);
    EXPECT_EQ(ports.photograph(7.0).name, "000.png");
    const Photograph second = ports.photograph(7.0);
    EXPECT_EQ(second.name, "002.png");
    EXPECT_EQ(second.taken_at, 2.0);
    EXPECT_EQ(second.exposure_s, 0.5);  // not the one asked for
    EXPECT_EQ(second.black_level, 3.0);
    EXPECT_EQ(second.image.at(1, 1, 2), 20.0f);
    EXPECT_THROW(ports.photograph(0.0), std::invalid_argument);

    // Turning to another role leaves what was not taken; the first photographs can be had again.
    EXPECT_EQ(ports.turn_to("red"), 2);
    EXPECT_EQ(ports.turn_to("white"), 1);
    EXPECT_EQ(ports.photograph(0.0).taken_at, 1.0);
    EXPECT_EQ(ports.turn_to("red"), 2);
    EXPECT_EQ(ports.photograph(0.0).taken_at, 0.0);
    EXPECT_TRUE(fails_with([&] { ports.turn_to("blue"); },
                           {made.folder.path().string(), "captures", "no photograph of blue"}));
}

TEST(CapturesFolder, WithoutAManifestNamesAndCountsDecide) {
    const TemporaryFolder folder;
    const auto fails = [&](std::initializer_list<std::string_view> parts) {
        return fails_with([&] { read_captures_folder(folder.path(), PhotographUse::light); },
                          parts);
    };
    EXPECT_TRUE(fails({folder.path().string(), "0 pictures and no manifest.json", "42 pictures"}));
    for (int k = 0; k < 42; ++k) folder.write("p" + std::to_string(100 + k) + ".PNG", "");
    folder.write("notes.txt", "");
    const auto read = read_captures_folder(folder.path(), PhotographUse::light);
    ASSERT_EQ(read.captures.size(), 42u);
    EXPECT_EQ(read.projector_width, 0);
    EXPECT_EQ(read.captures[0].role, "gray-column-0");
    EXPECT_EQ(read.captures[1].role, "gray-column-0-inverse");
    EXPECT_EQ(read.captures[20].role, "gray-row-0");
    EXPECT_EQ(read.captures[39].role, "gray-row-9-inverse");
    EXPECT_EQ(read.captures[40].role, "white");
    EXPECT_EQ(read.captures[41].role, "black");
    EXPECT_EQ(read.captures[41].file, folder / "p141.PNG");
    for (const auto& capture : read.captures) EXPECT_TRUE(is_known_role(capture.role));

    folder.write("p999.png", "");
    EXPECT_TRUE(fails({"43 pictures", "42 pictures"}));
    EXPECT_TRUE(fails_with([&] { read_captures_folder(folder / "no", PhotographUse::light); },
                           {"no such folder"}));
    EXPECT_TRUE(
        fails_with([&] { read_captures_folder(folder / "notes.txt", PhotographUse::light); },
                   {"notes.txt", "a file", "a folder of photographs"}));
}

TEST(CapturesFolder, PatternsManifestNamesThePhotographs) {
    const TemporaryFolder folder;
    const Image8 grey(8, 6, 3, 80), white(8, 6, 3, 255);
    write_patterns_folder(folder / "patterns",
                          8,
                          6,
                          {{"white", white, {255, 255, 255}}, {"gray-column-0", grey, {}}});
    const auto manifest = folder / "patterns/manifest.json";
    const auto patterns = read_patterns_manifest(manifest);
    EXPECT_EQ(patterns.projector_width, 8);
    EXPECT_EQ(patterns.projector_height, 6);
    ASSERT_EQ(patterns.patterns.size(), 2u);
    EXPECT_EQ(patterns.patterns[0].file, "000.png");
    EXPECT_EQ(patterns.patterns[0].drive, (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(patterns.patterns[1].role, "gray-column-0");
    EXPECT_TRUE(patterns.patterns[1].drive.empty());
    EXPECT_EQ(read_image(folder / "patterns/001.png").image.at(7, 5, 2), 80.0f);

    // Photographs beside no manifest, matched with the patterns'.
    std::filesystem::create_directory(folder / "photos");
    folder.write("photos/b.jpg", "");
    folder.write("photos/a.jpg", "");
    const auto matched = read_captures_folder(folder / "photos", PhotographUse::light, manifest);
    ASSERT_EQ(matched.captures.size(), 2u);
    EXPECT_EQ(matched.projector_width, 8);
    EXPECT_EQ(matched.captures[0].file, folder / "photos/a.jpg");
    EXPECT_EQ(matched.captures[0].role, "white");
    EXPECT_EQ(matched.captures[0].pattern, folder / "patterns/000.png");
    folder.write("photos/c.jpg", "");
    EXPECT_TRUE(
        fails_with([&] { read_captures_folder(folder / "photos", PhotographUse::light, manifest); },
                   {"3 pictures", "2 pictures", "patterns/manifest.json"}));

    // The manifest as written is of pictures to show.
    EXPECT_TRUE(fails_with([&] { read_captures_folder(folder / "patterns", PhotographUse::light); },
                           {"captures", "nobody has photographed", "exposure_s filled in"}));
    EXPECT_TRUE(is_patterns_manifest(manifest));
    std::string text = read_text_file(manifest);
    for (auto at = text.find("null"); at != std::string::npos; at = text.find("null")) {
        text.replace(at, 4, "0.5");
    }
    write_text_file(manifest, text);
    const auto filled = read_captures_folder(folder / "patterns", PhotographUse::light);
    EXPECT_EQ(filled.captures[1].exposure_s, 0.5);
    EXPECT_EQ(filled.captures[0].drive, (std::vector<int>{255, 255, 255}));
}

TEST(CapturesFolder, WritingPatternsChecksThem) {
    const TemporaryFolder folder;
    const auto write = [&](const std::vector<PatternFile>& patterns) {
        write_patterns_folder(folder / "p", 8, 6, patterns);
    };
    EXPECT_THROW(write({}), std::invalid_argument);
    EXPECT_THROW(write({{"pink", Image8(8, 6, 3), {}}}), std::invalid_argument);
    EXPECT_THROW(write({{"white", Image8(8, 5, 3), {}}}), std::invalid_argument);
    EXPECT_THROW(write({{"white", Image8(8, 6, 1), {}}}), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder / "p"));
    folder.write("p", "a file in the way");
    EXPECT_TRUE(fails_with([&] { write({{"white", Image8(8, 6, 3), {}}}); }, {"/p"}));
}

TEST(CapturesFolder, KnowsItsRoles) {
    for (const char* role : {"gray-column-0",
                             "gray-row-10-inverse",
                             "phase-column-3",
                             "colors-12",
                             "verify-0",
                             "gray-levels",
                             "white",
                             "bright-gray"}) {
        EXPECT_TRUE(is_known_role(role)) << role;
    }
    for (const char* role : {"",
                             "gray-column-",
                             "gray-column--inverse",
                             "gray-column-x",
                             "White",
                             "phase-row-1-inverse",
                             "colors",
                             "verify-12345"}) {
        EXPECT_FALSE(is_known_role(role)) << role;
    }
}

TEST(Photograph, UndoesTheTransferCurve) {
    const TemporaryFolder folder;
    Image8 picture(256, 1, 3);
    for (int x = 0; x < 256; ++x) {
        for (int c = 0; c < 3; ++c) picture.at(x, 0, c) = static_cast<std::uint8_t>(x);
    }
    write_png(folder / "a.png", picture);
    Capture capture;
    capture.file = folder / "a.png";
    capture.exposure_s = 0.5;
    const auto linear = load_photograph(capture);
    EXPECT_EQ(linear.image.at(200, 0, 1), 200.0f);
    EXPECT_EQ(linear.saturates_at, 255.0);
    EXPECT_EQ(linear.exposure_s, 0.5);
    EXPECT_EQ(linear.name, "a.png");

    capture.transfer = "srgb";
    capture.black_level = 10.0;
    const auto srgb = load_photograph(capture);
    // IEC 61966-2-1 by hand: ((188/255 + .055)/1.055)^2.4 = .50289; 10 lies on the linear part.
    EXPECT_NEAR(srgb.image.at(188, 0, 0), 255.0 * 0.50289, 255.0 * 1e-5);
    EXPECT_NEAR(srgb.black_level, 10.0 / 12.92, 1e-9);
    EXPECT_NEAR(srgb.saturates_at, 255.0, 1e-9);

    capture.transfer =
        folder.write("response.json", R"({"format_version": 1, "linear_from_file": [0, 0.25, 1]})");
    const auto response = load_photograph(capture);
    EXPECT_NEAR(response.image.at(51, 0, 0), 255.0 * 0.25 * 0.4, 1e-4);  // a fifth of full scale
    EXPECT_NEAR(response.image.at(255, 0, 2), 255.0, 1e-4);
    EXPECT_NEAR(response.image.at(204, 0, 2), 255.0 * (0.25 + 0.6 * 0.75), 1e-4);
}

TEST(Photograph, BadResponseFilesSayWhy) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", Image8(2, 2, 3));
    Capture capture;
    capture.file = folder / "a.png";
    capture.exposure_s = 1.0;
    const auto fails = [&](const char* text, std::initializer_list<std::string_view> parts) {
        capture.transfer = folder.write("response.json", text);
        return fails_with([&] { load_photograph(capture); }, parts);
    };
    EXPECT_TRUE(fails("", {"response.json", "an empty file"}));
    EXPECT_TRUE(fails(R"({"linear_from_file": [0, 1]})", {"format_version", "nothing"}));
    EXPECT_TRUE(fails(R"({"format_version": 9, "linear_from_file": [0, 1]})", {"newer Livery"}));
    EXPECT_TRUE(fails(R"({"format_version": 1, "linear_from_file": [0]})", {"1 elements"}));
    EXPECT_TRUE(fails(R"({"format_version": 1, "linear_from_file": [0, 0.6, 0.5]})",
                      {"linear_from_file[2]", "0.5", "between 0.6 and 1"}));
    EXPECT_TRUE(fails(R"({"format_version": 1, "linear_from_file": [0, "x"]})",
                      {"linear_from_file[1]", "a number"}));
}

TEST(Photograph, TakesColourChannelsByName) {
    const TemporaryFolder folder;
    Capture capture;
    capture.exposure_s = 1.0;
    capture.file = folder / "a.exr";
    ImageF four(1, 1, 4);
    four.values = {4.0f, 1.0f, 2.0f, 3.0f};
    write_exr(capture.file, four, {"A", "R", "G", "B"});
    EXPECT_EQ(load_photograph(capture).image.values, (std::vector<float>{1.0f, 2.0f, 3.0f}));
    EXPECT_EQ(load_photograph(capture).saturates_at, std::numeric_limits<double>::infinity());
    write_exr(capture.file, ImageF(1, 1, 1, 7.0f));
    EXPECT_EQ(load_photograph(capture).image.values, (std::vector<float>{7.0f, 7.0f, 7.0f}));
    write_exr(capture.file, ImageF(1, 1, 2), {"X", "Y"});
    EXPECT_TRUE(fails_with([&] { load_photograph(capture); },
                           {"a.exr", "channels: found X, Y, expected R, G, B"}));
}

TEST(Photograph, BadPicturesSayWhy) {
    const TemporaryFolder folder;
    Capture capture;
    capture.exposure_s = 1.0;
    const auto fails = [&](std::initializer_list<std::string_view> parts) {
        return fails_with([&] { load_photograph(capture); }, parts);
    };
    capture.file = folder / "no.png";
    EXPECT_TRUE(fails({"no.png", "no such file"}));
    capture.file = folder.write("empty.png", "");
    EXPECT_TRUE(fails({"empty.png", "an empty file"}));
    capture.file = folder.write("kind.png", "not a picture at all");
    EXPECT_TRUE(fails({"kind.png", "content of another kind"}));
    write_png(folder / "a.png", Image8(40, 30, 3, 9));
    const std::string whole = read_text_file(folder / "a.png");
    capture.file = folder.write("cut.png", whole.substr(0, whole.size() - 20));
    EXPECT_TRUE(fails({"cut.png", "cut-off"}));
    ImageF image(3, 2, 3);
    capture.file = folder / "nan.exr";
    image.at(1, 1, 2) = std::nanf("");
    write_exr(capture.file, image);
    EXPECT_TRUE(fails({"nan.exr", "pixel 1,1", "NaN"}));
    image.at(0, 1, 0) = std::numeric_limits<float>::infinity();
    write_exr(capture.file, image);
    EXPECT_TRUE(fails({"nan.exr", "pixel 0,1", "infinity"}));
}

TEST(CapturesFolder, OpensRealPhotographs) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (int pose = 0; pose < 4; ++pose) {
        const auto folder = data / ("procam/capture_" + std::to_string(pose));
        const auto read = read_captures_folder(folder, PhotographUse::light);
        ASSERT_EQ(read.captures.size(), 42u);
        const auto white = load_photograph(read.captures[40]);
        const auto black = load_photograph(read.captures[41]);
        ASSERT_EQ(white.image.width, 1280);
        ASSERT_EQ(white.image.height, 1024);
        EXPECT_EQ(white.saturates_at, 255.0);
        // The projector lights part of the picture; nowhere does white give less than black, on
        // average.
        double white_sum = 0.0, black_sum = 0.0;
        for (const float value : white.image.values) white_sum += static_cast<double>(value);
        for (const float value : black.image.values) black_sum += static_cast<double>(value);
        EXPECT_GT(white_sum, 1.5 * black_sum);
    }
}

}  // namespace
}  // namespace livery
