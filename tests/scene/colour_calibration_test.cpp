#include "scene/colour_calibration.h"

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/json.h"
#include "core/random.h"
#include "scene/broken.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ColourCalibration some_calibration() {
    Random random(7);
    ColourCalibration c;
    c.width = 13;
    c.height = 9;
    c.created = "2026-11-21T05:41:04Z";
    c.mode = "robust";
    c.made_with = "a test";
    c.dark_drive = 16.0;
    c.bright_drive = 235.0;
    c.unmixing = ImageF(13, 9, 9);
    c.dark = ImageF(13, 9, 3);
    c.span = ImageF(13, 9, 3);
    c.camera_px = ImageF(13, 9, 2, kNan);
    c.status = Image8(13, 9, 1, static_cast<std::uint8_t>(PixelStatus::measured));
    for (auto* plane : {&c.unmixing, &c.dark, &c.span}) {
        for (float& value : plane->values) value = static_cast<float>(random.normal());
    }
    for (int k = 0; k < 100; ++k)
        c.camera_px.values[static_cast<std::size_t>(k)] = 0.1f * static_cast<float>(k);
    c.status.at(3, 3) = static_cast<std::uint8_t>(PixelStatus::saturated);
    c.unmixing.at(3, 3, 4) = kNan;
    for (auto& curve : c.response) {
        for (int k = 0; k < 33; ++k)
            curve.drive_from_n.push_back(255.0f * std::pow(static_cast<float>(k) / 32.0f, 0.45f));
        curve.largest_violation = 0.0123;
    }
    c.table.grid = 2;
    for (int k = 0; k < 8; ++k)
        c.table.n_from_drive.emplace_back(random.uniform(), random.uniform(), random.uniform());
    c.xyz_from_camera = glm::dmat3(0.4, 0.2, 0.1, 0.3, 0.7, 0.1, 0.2, 0.1, 0.9);
    c.xyz_origin = "primaries";
    c.camera_ambient = {0.1, 0.2, 1.0 / 3.0};
    c.additivity_error = 0.01;
    c.condition_p99 = 3.3;
    c.valid_fraction = 0.9;
    c.ambient_fraction = 0.02;
    c.mixing_spread = 1.1;
    c.predicted_fraction = 0.05;
    c.prediction_error_median = 0.01;
    c.prediction_error_p95 = 0.04;
    c.warnings = {"one", "two"};
    seal(c);
    return c;
}

TEST(ColourCalibration, ComesBackBitForBit) {
    const TemporaryFolder folder;
    const auto c = some_calibration();
    write_calibration(folder / "new folder", c);
    const auto back = read_calibration(folder / "new folder");
    EXPECT_EQ(back.id, c.id);
    EXPECT_EQ(back.dark.values, c.dark.values);
    EXPECT_EQ(back.span.values, c.span.values);
    EXPECT_EQ(back.status.values, c.status.values);
    for (std::size_t k = 0; k < c.unmixing.values.size(); ++k) {
        if (std::isnan(c.unmixing.values[k])) {
            EXPECT_TRUE(std::isnan(back.unmixing.values[k]));
        } else {
            EXPECT_EQ(back.unmixing.values[k], c.unmixing.values[k]) << k;
        }
    }
    EXPECT_TRUE(std::isnan(back.camera_px.values.back()));
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(back.response[k].drive_from_n, c.response[k].drive_from_n);
        EXPECT_EQ(back.response[k].largest_violation, c.response[k].largest_violation);
    }
    EXPECT_EQ(back.table.grid, c.table.grid);
    EXPECT_EQ(back.table.n_from_drive, c.table.n_from_drive);
    EXPECT_EQ(back.xyz_from_camera, c.xyz_from_camera);
    EXPECT_EQ(back.camera_ambient, c.camera_ambient);
    EXPECT_EQ(back.warnings, c.warnings);
    EXPECT_EQ(back.created, c.created);
    EXPECT_EQ(back.additivity_error, c.additivity_error);
    EXPECT_EQ(back.predicted_fraction, c.predicted_fraction);
    EXPECT_EQ(back.prediction_error_median, c.prediction_error_median);
    EXPECT_EQ(back.prediction_error_p95, c.prediction_error_p95);
}

TEST(ColourCalibration, TheIdDependsOnEveryField) {
    const auto c = some_calibration();
    using Change = std::function<void(ColourCalibration&)>;
    const Change changes[] = {
        [](auto& d) { std::swap(d.width, d.height); },
        [](auto& d) { d.created += "x"; },
        [](auto& d) { d.mode = "paper"; },
        [](auto& d) { d.made_with += "x"; },
        [](auto& d) { d.dark_drive += 1; },
        [](auto& d) { d.bright_drive -= 1; },
        [](auto& d) { d.unmixing.values.back() += 1e-6f; },
        [](auto& d) { d.dark.values.back() += 1e-6f; },
        [](auto& d) { d.span.values.back() += 1e-6f; },
        [](auto& d) { d.camera_px.values.back() = 1; },
        [](auto& d) { d.status.values.back() = 2; },
        [](auto& d) { d.response[2].drive_from_n[5] += 0.001f; },
        [](auto& d) { d.response[0].largest_violation += 1e-9; },
        [](auto& d) { d.table.grid = 3; },
        [](auto& d) { d.table.n_from_drive[7].z += 1e-6f; },
        [](auto& d) { d.xyz_from_camera[2][1] += 1e-15; },
        [](auto& d) { d.xyz_origin = "chart"; },
        [](auto& d) { d.camera_ambient.z += 1e-15; },
        [](auto& d) { d.additivity_error += 1e-9; },
        [](auto& d) { d.condition_p99 += 1e-9; },
        [](auto& d) { d.valid_fraction += 1e-9; },
        [](auto& d) { d.ambient_fraction += 1e-9; },
        [](auto& d) { d.mixing_spread += 1e-9; },
        [](auto& d) { d.predicted_fraction += 1e-9; },
        [](auto& d) { d.prediction_error_median += 1e-9; },
        [](auto& d) { d.prediction_error_p95 += 1e-9; },
        [](auto& d) { d.warnings.pop_back(); },
    };
    std::set<std::string> ids{c.id};
    for (const auto& change : changes) {
        auto changed = c;
        change(changed);
        seal(changed);
        EXPECT_TRUE(ids.insert(changed.id).second) << "change " << ids.size();
    }
    auto again = c;
    seal(again);
    EXPECT_EQ(again.id, c.id);
}

TEST(ColourCalibration, FilesFromBeforePredictionsOpen) {
    const TemporaryFolder folder;
    auto c = some_calibration();
    c.predicted_fraction = c.prediction_error_median = c.prediction_error_p95 = 0.0;
    seal(c);
    write_calibration(folder / "c", c);
    Json json = read_json_file(folder / "c/calibration.json");
    for (const char* name :
         {"predicted_fraction", "prediction_error_median", "prediction_error_p95"}) {
        ASSERT_EQ(json["residuals"].erase(name), 1u);
    }
    folder.write("c/calibration.json", json.dump());
    EXPECT_EQ(read_calibration(folder / "c").id, c.id);
}

TEST(ColourCalibration, OnlySealedAndCompleteOnesAreWritten) {
    const TemporaryFolder folder;
    const auto refuses = [&](const std::function<void(ColourCalibration&)>& damage) {
        auto c = some_calibration();
        damage(c);
        EXPECT_THROW(write_calibration(folder / "c", c), std::invalid_argument);
    };
    refuses([](auto& c) { c.id.clear(); });
    refuses([](auto& c) { c.dark_drive = 17; });
    refuses([](auto& c) { c.span = ImageF(13, 8, 3), seal(c); });
    refuses([](auto& c) { c.table.grid = 3, seal(c); });
    refuses([](auto& c) { c.response[1].drive_from_n.clear(), seal(c); });
    refuses([](auto& c) { c.condition_p99 = std::numeric_limits<double>::infinity(), seal(c); });
    EXPECT_FALSE(std::filesystem::exists(folder / "c"));
}

const Broken kBrokenCalibrations[] = {
    {"no version", [](Json& c) { c.erase("format_version"); }, "format_version: found nothing"},
    {"newer version", [](Json& c) { c["format_version"] = 2; }, "found 2 (written by a newer"},
    {"other kind", [](Json& c) { c["kind"] = "geometry"; }, "kind: found \"geometry\""},
    {"no kind", [](Json& c) { c.erase("kind"); }, "kind: found nothing"},
    {"unknown field", [](Json& c) { c["comment"] = 1; }, "the unknown field \"comment\""},
    {"mode", [](Json& c) { c["mode"] = "quick"; }, "mode: found \"quick\", expected \"paper\" or"},
    {"other size", [](Json& c) { c["width"] = 14; }, "status.png: size: found 13x9 with 1"},
    {"smaller size", [](Json& c) { c["width"] = 12; }, "status.png: size: found 13x9"},
    {"huge size", [](Json& c) { c["width"] = 2000000000; }, "width: found 2000000000"},
    {"drive", [](Json& c) { c["dark_drive"] = 300; }, "dark_drive: found 300"},
    {"dark over bright", [](Json& c) { c["bright_drive"] = 3; }, "bright_drive: found 3"},
    {"a channel less",
     [](Json& c) { c["response"].erase("blue"); },
     "response.blue: found nothing"},
    {"falling response",
     [](Json& c) { c["response"]["green"]["drive_from_n"][5] = 0; },
     "response.green.drive_from_n[5]: found 0, expected at least the sample before it"},
    {"empty response",
     [](Json& c) { c["response"]["green"]["drive_from_n"] = Json::array(); },
     "response.green.drive_from_n: found 0 samples"},
    {"table of another size",
     [](Json& c) { c["table"]["grid"] = 3; },
     "table.n_from_drive: found 24 elements, expected 81 numbers"},
    {"huge table", [](Json& c) { c["table"]["grid"] = 1000; }, "table.grid: found 1000"},
    {"singular matrix",
     [](Json& c) {
         c["xyz_from_camera"] = {1, 0, 0, 1, 0, 0, 0, 0, 1};
     },
     "xyz_from_camera: found a singular matrix"},
    {"residual that is no number",
     [](Json& c) { c["residuals"]["condition_p99"] = nullptr; },
     "residuals.condition_p99: found null"},
    {"fraction",
     [](Json& c) { c["residuals"]["valid_fraction"] = 1.5; },
     "valid_fraction: found 1.5"},
    {"predicted fraction",
     [](Json& c) { c["residuals"]["predicted_fraction"] = -0.5; },
     "predicted_fraction: found -0.5"},
    {"warnings",
     [](Json& c) { c["warnings"] = "none"; },
     "warnings: found \"none\", expected an array"},
    {"edited by hand",
     [](Json& c) { c["camera_ambient"][0] = 0.2; },
     "of the content: a file was changed or is of another run"},
    {"id", [](Json& c) { c["id"] = "0"; }, "calibration.json: id: found 0, expected"},
};

TEST(ColourCalibration, EachMistakeInItsJsonIsNamed) {
    const TemporaryFolder folder;
    write_calibration(folder / "c", some_calibration());
    const Json good = read_json_file(folder / "c/calibration.json");
    for (const auto& broken : kBrokenCalibrations) {
        Json json = good;
        broken.damage(json);
        folder.write("c/calibration.json", json.dump());
        EXPECT_TRUE(fails_with([&] { read_calibration(folder / "c"); }, {broken.message}))
            << broken.what;
    }
    const auto refuses = [&](std::string_view bytes, std::string_view message) {
        folder.write("c/calibration.json", bytes);
        return fails_with([&] { read_calibration(folder / "c"); }, {"calibration.json", message});
    };
    EXPECT_TRUE(refuses("", "empty file"));
    EXPECT_TRUE(refuses(good.dump().substr(0, 500), "not JSON"));
    std::filesystem::remove(folder / "c/calibration.json");
    EXPECT_TRUE(fails_with([&] { read_calibration(folder / "c"); }, {"no such file"}));
    EXPECT_TRUE(fails_with([&] { read_calibration(folder / "gone"); },
                           {"gone: found nothing, expected a calibration's folder"}));
    const auto file = folder.write("file", "x");
    EXPECT_TRUE(fails_with([&] { read_calibration(file); }, {"file: found a file"}));
}

TEST(ColourCalibration, EachMistakeInItsPlanesIsNamed) {
    const TemporaryFolder folder;
    const auto good = some_calibration();
    const auto refuses = [&](const std::function<void()>& damage,
                             std::initializer_list<std::string_view> parts) {
        write_calibration(folder / "c", good);
        damage();
        return fails_with([&] { read_calibration(folder / "c"); }, parts);
    };
    const std::vector<std::string> matrix{
        "m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"};
    for (const char* plane :
         {"unmixing.exr", "dark.exr", "span.exr", "camera_px.exr", "status.png"}) {
        const auto file = folder / "c" / plane;
        EXPECT_TRUE(refuses([&] { std::filesystem::remove(file); }, {plane, "no such file"}));
        EXPECT_TRUE(refuses([&] { std::filesystem::resize_file(file, 60); }, {plane}));
        EXPECT_TRUE(refuses([&] { std::filesystem::resize_file(file, 0); }, {plane}));
        EXPECT_TRUE(refuses([&] { folder.write("c/" + std::string(plane), "text"); }, {plane}));
    }
    EXPECT_TRUE(refuses([&] { write_exr(folder / "c/dark.exr", ImageF(12, 9, 3)); },
                        {"dark.exr: size: found 12x9 with 3", "expected 13x9 with 3"}));
    EXPECT_TRUE(refuses([&] { write_exr(folder / "c/dark.exr", ImageF(13, 9, 1)); },
                        {"dark.exr: size: found 13x9 with 1"}));
    EXPECT_TRUE(refuses(
        [&] {
            write_exr(folder / "c/camera_px.exr", ImageF(13, 9, 2), {"U", "V"});
        },
        {"camera_px.exr: channels: found no channel X"}));
    EXPECT_TRUE(
        refuses([&] { write_exr(folder / "c/dark.exr", ImageF(13, 90, 3)); }, {"dark.exr"}));
    auto plane = good.unmixing;
    plane.at(4, 2, 8) = kNan;
    EXPECT_TRUE(refuses([&] { write_exr(folder / "c/unmixing.exr", plane, matrix); },
                        {"unmixing.exr: pixel (4, 2): found nan, expected finite numbers"}));
    plane = good.unmixing;
    plane.at(4, 2, 8) += 1e-3f;
    EXPECT_TRUE(refuses([&] { write_exr(folder / "c/unmixing.exr", plane, matrix); },
                        {"calibration.json: id", "of the content"}));
    auto status = good.status;
    status.at(0, 0) = 10;
    EXPECT_TRUE(refuses([&] { write_png(folder / "c/status.png", status); },
                        {"status.png: pixel 0: found status 10, expected a status from 0 to 9"}));
    EXPECT_TRUE(refuses([&] { write_png(folder / "c/status.png", Image16(13, 9, 1)); },
                        {"status.png: size", "of 8 bit"}));
}

}  // namespace
}  // namespace livery
