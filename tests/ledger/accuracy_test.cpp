#include "ledger/accuracy/accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

AccuracyScene small_scene() {
    AccuracyScene scene;
    scene.name = "ball";
    Product product;
    product.mesh = make_sphere({0, 0, 0}, 10.0, 24, "body");
    product.exchange = part_exchange(product.mesh);
    scene.scene.product = std::make_shared<const Product>(std::move(product));
    scene.scene.part_materials.resize(1);
    scene.scene.lights.emplace_back();
    scene.scene.eye_in_world_mm = {0.0, 10.0, 60.0};
    scene.view = look_at({0.0, 10.0, 60.0}, {0.0, 0.0, 0.0}, 0.4, 40, 30);
    return scene;
}

TEST(Truth, IsTracedOnceAndKept) {
    const TemporaryFolder folder;
    TruthOptions options;
    options.samples_per_pixel = 16;
    options.folder = folder.path();
    AccuracyScene scene = small_scene();
    const Truth first = truth_of(scene, options);
    EXPECT_GT(first.seconds, 0.0);
    EXPECT_GT(first.floor.pixels, 100u);
    const Truth again = truth_of(scene, options);
    EXPECT_EQ(again.seconds, 0.0);
    EXPECT_EQ(again.hash, first.hash);
    EXPECT_EQ(again.radiance_working.values, first.radiance_working.values);
    // Another paint, light, eye or number of samples is another truth.
    std::vector<std::string> hashes{first.hash};
    const auto differs = [&] {
        const std::string hash = truth_hash(scene, options);
        EXPECT_EQ(std::count(hashes.begin(), hashes.end(), hash), 0);
        hashes.push_back(hash);
    };
    scene.scene.part_materials[0].diffuse.x += 1e-6;
    differs();
    scene.scene.lights[0].angle_rad = 0.01;
    differs();
    scene.scene.eye_in_world_mm.y += 1.0;
    differs();
    scene.view.principal_px.x += 0.5;
    differs();
    options.samples_per_pixel = 17;
    differs();
    scene.mean_px = 2;
    differs();
}

TEST(Truth, InSquaresErrsByLessThanByPixels) {
    TruthOptions options;
    options.samples_per_pixel = 16;
    AccuracyScene scene = small_scene();
    scene.scene.lights[0].angle_rad = 0.5;  // noise on all of it
    const Truth by_pixels = truth_of(scene, options);
    scene.mean_px = 4;
    const Truth in_squares = truth_of(scene, options);
    EXPECT_EQ(in_squares.radiance_working.width, scene.view.width / 4);
    EXPECT_EQ(in_squares.radiance_working.height, scene.view.height / 4);
    // A quarter, by independent pixels; half, with what few squares tell
    EXPECT_LT(in_squares.floor.median, 0.5 * by_pixels.floor.median);
    EXPECT_GT(in_squares.floor.median, 0.0);
}

TEST(Truth, ThatLiesDamagedIsTracedAgain) {
    const TemporaryFolder folder;
    TruthOptions options;
    options.samples_per_pixel = 4;
    options.folder = folder.path();
    const AccuracyScene scene = small_scene();
    const Truth first = truth_of(scene, options);
    std::filesystem::resize_file(folder.path() / (first.hash + ".exr"), 100);
    const Truth again = truth_of(scene, options);
    EXPECT_GT(again.seconds, 0.0);
    EXPECT_EQ(again.radiance_working.values, first.radiance_working.values);
}

TEST(ColourDifferences, CountWhatIsNoNumberAsTheWorst) {
    ImageF truth(4, 1, 4, 0.5f), drawn = truth;
    for (std::size_t i = 0; i < 4; ++i) truth.values[4 * i + 3] = drawn.values[4 * i + 3] = 1.0f;
    drawn.values[0] = std::numeric_limits<float>::quiet_NaN();
    drawn.values[4] = 0.6f;
    truth.values[11] = 0.49f;  // less than half of that pixel
    const std::vector<float> apart = colour_differences(drawn, truth);
    ASSERT_EQ(apart.size(), 3u);
    EXPECT_TRUE(std::isinf(apart[0]));
    EXPECT_GT(apart[1], 1.0f);
    EXPECT_NEAR(apart[2], 0.0f, 1e-5f);
}

TEST(AccuracyRows, ComeBackAsTheyWereWritten) {
    const TemporaryFolder folder;
    AccuracyRow row = rows_to_measure({small_scene()}).front();
    row.own_ms = 1.5;
    row.solve_ms = 20.0;
    row.swap_ms = 0.25;
    row.fragments = 1000.0;
    row.error = {900, 0.1, 0.5, 0.2, 3.0};
    row.p99 = 1.25;
    row.floor_median = 0.01;
    write_row(folder.path(), "abc", row);
    const auto read = read_row(folder.path(), "abc");
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->scene, row.scene);
    EXPECT_EQ(read->effect, row.effect);
    EXPECT_EQ(read->solve_ms, row.solve_ms);
    EXPECT_EQ(read->error.p95, row.error.p95);
    EXPECT_EQ(read->p99, row.p99);
    EXPECT_FALSE(read_row(folder.path(), "other").has_value());
    std::ofstream(folder.path() / "abc.json") << "{\"format_version\": 1, \"scene\": 3}";
    EXPECT_THROW(read_row(folder.path(), "abc"), FileError);
}

TEST(AccuracyRows, OfAnotherLevelOrTruthAreOthers) {
    const std::vector<AccuracyRow> rows = rows_to_measure({small_scene()});
    std::vector<std::string> hashes;
    for (const AccuracyRow& row : rows) {
        for (const char* truth : {"a", "b"}) {
            const std::string hash = hash_of(row, truth);
            EXPECT_EQ(std::count(hashes.begin(), hashes.end(), hash), 0)
                << row.effect << " " << row.level;
            hashes.push_back(hash);
        }
    }
    EXPECT_GE(rows.size(), 3u + 2u * kEffects);
}

/// An effect that no scene calls for has no row, whatever its scene is called.
TEST(AccuracyScenes, SomeSceneCallsForEachEffect) {
    const std::vector<AccuracyScene> scenes = accuracy_scenes(false);
    for (const EffectInfo& info : effect_table()) {
        EXPECT_TRUE(std::any_of(scenes.begin(), scenes.end(), [&](const AccuracyScene& scene) {
            return calls_for(scene.scene, info.effect);
        })) << info.name;
    }
    for (const AccuracyScene& scene : scenes) {
        const bool named = scene.name.starts_with("car, silver with glints");
        EXPECT_EQ(calls_for(scene.scene, Effect::glints), named) << scene.name;
    }
}

// Ladders rise: a dearer level is nowhere less accurate, within what the truth itself may err by.
// On small pictures; livery bench has the large ones.
void expect_ladders_rise(const std::vector<std::string>& scenes) {
    const HeadlessContext context(GlDevice::automatic);
    for (const AccuracyScene& whole : accuracy_scenes(false)) {
        if (std::find(scenes.begin(), scenes.end(), whole.name) == scenes.end()) continue;
        // Those for one effect alone are small enough
        const AccuracyScene scene = whole.only ? whole : resized(whole, 128, 80);
        TruthOptions options;
        options.samples_per_pixel = 64;
        const Truth truth = truth_of(scene, options);
        RowMeasurement measurement(scene, truth);
        std::optional<AccuracyRow> below;
        for (const AccuracyRow& row : rows_to_measure({scene})) {
            if (!row.called_for) continue;
            // The path tracer draws flakes as a smooth lobe: single ones are no error.
            if (row.effect == effect_info(Effect::glints).name) continue;
            const AccuracyRow found = measurement.measured(row);
            std::printf(
                "    %-36s %-22s %-12s median %.3f, mean %.3f, 95%% %.2f (truth %.3f, %.2f)\n",
                scene.name.c_str(),
                row.effect.c_str(),
                row.level.c_str(),
                found.error.median,
                found.error.mean,
                found.error.p95,
                truth.floor.median,
                truth.floor.p95);
            if (below && below->effect == found.effect) {
                EXPECT_LE(found.error.mean, below->error.mean + truth.floor.mean)
                    << scene.name << ", " << found.effect << " " << found.level;
                EXPECT_LE(found.error.p95, below->error.p95 + truth.floor.p95)
                    << scene.name << ", " << found.effect << " " << found.level;
            }
            below = found;
        }
    }
}

TEST(Ladders, NightlyRise) {
    expect_ladders_rise({"sphere, pearl with a film, studio", "player, marble, overcast"});
}
// With those, scenes that together call for every effect
TEST(Ladders, NightlyRiseOnTheCar) {
    expect_ladders_rise({"car, solid red, studio",
                         "car, satin white, overcast",
                         "car without windows, solid red, studio"});
}

AccuracyRow a_row(const std::string& effect, const std::string& level, double ms, double p95) {
    AccuracyRow row;
    row.scene = "ball";
    row.effect = effect;
    row.level = level;
    row.solve_ms = ms;
    row.error.pixels = 7;
    row.error.median = 0.25;
    row.error.p95 = p95;
    row.p99 = 2.0 * p95;
    return row;
}

TEST(AccuracyFile, ComesBackAsItWasWritten) {
    const TemporaryFolder folder;
    AccuracyLedger ledger;
    ledger.renderer = "a card";
    ledger.threads = 3;
    ledger.samples_per_pixel = 64;
    ledger.rows = {a_row(kQualityRows, "normal", 900.0, 2.0),
                   a_row("shadows", "sharp", 800.0, std::numeric_limits<double>::infinity()),
                   a_row("shadows", "none", 700.0, 3.0),
                   a_row("shadows", "of another version", 1.0, 1.0)};
    ledger.rows[2].called_for = false;
    const auto file = folder.path() / "accuracy.json";
    write_accuracy(file, ledger);
    const AccuracyLedger again = parse_accuracy(read_text_file(file), file);
    EXPECT_EQ(again.renderer, "a card");
    EXPECT_EQ(again.threads, 3);
    EXPECT_EQ(again.samples_per_pixel, 64);
    // Neither what no scene calls for nor a level that is no more
    ASSERT_EQ(again.rows.size(), 2u);
    EXPECT_EQ(again.rows[0].effect, kQualityRows);
    EXPECT_EQ(again.rows[0].index, 1);
    EXPECT_EQ(again.rows[0].solve_ms, 900.0);
    EXPECT_EQ(again.rows[0].error.p95, 2.0);
    EXPECT_EQ(again.rows[0].error.pixels, 7u);
    EXPECT_EQ(again.rows[1].index, 1);
    EXPECT_EQ(again.rows[1].error.p95, 1e12) << "infinitely wrong";
}

TEST(AccuracyFile, OfSomethingElseIsRefusedByItsField) {
    const auto problem = [](const std::string& text) -> std::string {
        try {
            parse_accuracy(text, "accuracy.json");
        } catch (const FileError& error) {
            return error.what();
        }
        return "none";
    };
    const std::string head =
        R"({"format_version": 1, "renderer": "a", "threads": 2, "samples_per_pixel": 64, "rows": )";
    EXPECT_EQ(problem(head + "[]}"), "none");
    EXPECT_NE(problem("{\"format_version\": 2}").find("format_version"), std::string::npos);
    EXPECT_NE(problem(head + "7}").find("rows"), std::string::npos);
    EXPECT_NE(problem(head + "[{\"scene\": 1}]}").find("rows[0].scene"), std::string::npos);
    EXPECT_NE(problem(head).find("accuracy.json"), std::string::npos);
}

TEST(AccuracyFront, IsWhatNothingBeatsInBoth) {
    std::vector<AccuracyLevel> levels(5);
    const double ms[] = {1.0, 2.0, 2.0, 3.0, 3.0}, p95[] = {9.0, 5.0, 6.0, 5.0, 1.0};
    for (std::size_t k = 0; k < levels.size(); ++k) {
        levels[k].solve_ms = ms[k];
        levels[k].p95 = p95[k];
    }
    EXPECT_EQ(front_of(levels), (std::vector<bool>{true, true, false, false, true}));
    // Half of the scenes may compare, fewer may not
    for (std::size_t k = 0; k < levels.size(); ++k) levels[k].scenes = k == 1 ? 3 : 8;
    EXPECT_EQ(front_of(levels), (std::vector<bool>{true, false, true, false, true}));
    levels[1].scenes = 4;
    EXPECT_EQ(front_of(levels), (std::vector<bool>{true, true, false, false, true}));
}

}  // namespace
}  // namespace livery
