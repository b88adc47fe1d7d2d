// livery measure profile, from photographs of photons to a medium: the walk shares no formula with
// what measures or with what fits.

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/subsurface/fit_profile.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "jobs/file_check.h"
#include "jobs/spot_bench.h"
#include "support/file_error.h"
#include "support/message_of.h"
#include "support/thorough.h"

namespace livery {
namespace {

constexpr std::uint64_t kSpotSeed = 3;

/// Jensen et al. (2001), red, green, blue.
using Media = std::array<ScatteringMedium, 3>;
const Media kMarbleRgb{
    {{0.0021, 2.19, 0.0, 1.5, {}}, {0.0041, 2.62, 0.0, 1.5, {}}, {0.0071, 3.00, 0.0, 1.5, {}}}};
const Media kSkinRgb{
    {{0.032, 0.74, 0.0, 1.3, {}}, {0.17, 0.88, 0.0, 1.3, {}}, {0.48, 1.01, 0.0, 1.3, {}}}};
const Media kMilkRgb{
    {{0.0014, 0.70, 0.0, 1.3, {}}, {0.0025, 1.22, 0.0, 1.3, {}}, {0.0142, 1.90, 0.0, 1.3, {}}}};

struct FoundMedium {
    double of_s = 0.0, of_a = 0.0;  ///< relative error of sigma_s' and sigma_a
    ProfileFit fit;
};

FoundMedium found_again(const MeasuredChannel& one, const ScatteringMedium& truth) {
    ProfileFitOptions options;
    options.eta = truth.eta;
    options.g = truth.g;
    options.spot_mm = one.profile.spot_mm;
    FoundMedium found;
    found.fit = fit_profile(read_profile_csv(one.file), options);
    found.of_s = found.fit.sigma_s_prime_per_mm.value / truth.sigma_s_prime() - 1.0;
    found.of_a = found.fit.sigma_a_per_mm.value / truth.sigma_a_per_mm - 1.0;
    return found;
}

void print(const char* what, const MeasuredChannel& one, const FoundMedium& found) {
    std::printf(
        "%-24s %-5s spot %.3f mm, %zu rings to %.3g mm, back %.4f; sigma_s' %+.1f%% (%.1f%%) "
        "sigma_a %+.1f%% (%.1f%%)\n",
        what,
        one.channel.c_str(),
        one.profile.spot_mm,
        one.profile.samples.size(),
        one.profile.samples.back().r_mm,
        one.profile.total_reflectance,
        100.0 * found.of_s,
        100.0 * found.fit.sigma_s_prime_per_mm.relative_standard_error,
        100.0 * found.of_a,
        100.0 * found.fit.sigma_a_per_mm.relative_standard_error);
}

TEST(SpotMeasurement, FindsKnownMediaInPhotographs) {
    std::printf("seed %d\n", static_cast<int>(kSpotSeed));
    const struct {
        const char* name;
        const Media& media;
    } cases[] = {{"marble", kMarbleRgb}, {"skin 1", kSkinRgb}, {"skim milk", kMilkRgb}};
    for (const auto& one : cases) {
        if (&one != cases && !thorough()) break;
        const SpotBench bench(
            one.media, 640, 60'000, [](SpotStand& stand) { stand.seed = kSpotSeed; });
        const SpotMeasurement report = bench.measure();
        ASSERT_EQ(report.channels.size(), 3u);
        EXPECT_EQ(report.photographs, bench.taken.photographs);
        for (std::size_t c = 0; c < 3; ++c) {
            const FoundMedium found = found_again(report.channels[c], one.media[c]);
            print(one.name, report.channels[c], found);
            EXPECT_LT(std::abs(found.of_s), 0.10) << one.name << c;
            EXPECT_LT(std::abs(found.of_a), 0.25) << one.name << c;
        }
        EXPECT_NEAR(report.incidence_rad * kDegreesPerRadian, 5.0, 0.1);
        EXPECT_NEAR(report.view_rad * kDegreesPerRadian, 45.0, 0.1);
    }
}

/// Where the camera stands: what the mean over directions is worth.
TEST(SpotMeasurement, NightlyDependsLittleOnWhereTheCameraStands) {
    for (const double off_deg : {12.0, 30.0, 60.0}) {
        const double off = off_deg / kDegreesPerRadian;
        for (const auto* media : {&kMarbleRgb, &kSkinRgb}) {
            // At each change marble at the nearest angle, where it is noted, and at the farthest
            if (!thorough() && (media == &kSkinRgb || off_deg == 30.0)) continue;
            const SpotBench bench(
                {(*media)[1], (*media)[1], (*media)[1]}, 512, 30'000, [&](SpotStand& stand) {
                    stand.seed = kSpotSeed;
                    View& view = stand.camera.view;
                    const View from =
                        look_at(600.0 * glm::dvec3(0.0, -std::sin(off), std::cos(off)),
                                {0.0, 0.0, 0.0},
                                1.0,
                                view.width,
                                view.height);
                    view.view_from_world = from.view_from_world;
                });
            const SpotMeasurement report = bench.measure();
            const FoundMedium found = found_again(report.channels[1], (*media)[1]);
            const std::string what = std::to_string(static_cast<int>(off_deg)) + " degrees, " +
                                     (media == &kMarbleRgb ? "marble" : "skin 1");
            print(what.c_str(), report.channels[1], found);
            // Twice the tolerance of the place that is recommended.
            EXPECT_LT(std::abs(found.of_s), 0.20) << what;
            EXPECT_LT(std::abs(found.of_a), 0.50) << what;
            const bool noted = !report.notes.empty() &&
                               report.notes.front().find("off the normal") != std::string::npos;
            EXPECT_EQ(noted, off_deg == 12.0) << what;
        }
    }
}

TEST(SpotMeasurement, ACameraAlongTheNormalNeedsNoCameraFile) {
    constexpr double kAway_mm = 20'000.0, kView_rad = 0.0022;
    SpotBench bench(
        {kMarbleRgb[1], kMarbleRgb[1], kMarbleRgb[1]}, 512, 30'000, [](SpotStand& stand) {
            stand.seed = kSpotSeed;
            stand.projector_mm = {120.0, 0.0, 690.0};
            stand.camera.view = look_at({0.0, 0.0, kAway_mm}, {0.0, 0.0, 0.0}, kView_rad, 512, 512);
        });
    for (const char* name : {"camera", "plane", "projector_mm"}) bench.manifest.erase(name);
    bench.manifest["mm_per_px"] = kAway_mm * 2.0 * std::tan(0.5 * kView_rad) / 512.0;
    bench.manifest["incidence_deg"] = kDegreesPerRadian * std::atan2(120.0, 690.0);
    bench.rewrite();
    const SpotMeasurement report = bench.measure();
    const FoundMedium found = found_again(report.channels[1], kMarbleRgb[1]);
    print("along the normal, marble", report.channels[1], found);
    EXPECT_LT(std::abs(found.of_s), 0.20);
    EXPECT_LT(std::abs(found.of_a), 0.50);
    EXPECT_NEAR(report.view_rad, 0.0, 1e-4);
}

void two_pixels_wide(SpotStand& stand) { stand.spot_sigma_mm = 0.13; }

/// A small picture of marble with few photons; its manifest and its pictures are spoiled.
class SpotProblems : public ::testing::Test {
  protected:
    SpotProblems()
        : bench_({kMarbleRgb[1], kMarbleRgb[1], kMarbleRgb[1]}, 320, 4000, two_pixels_wide) {}

    ::testing::AssertionResult fails(std::initializer_list<std::string_view> parts) const {
        bench_.rewrite();
        return fails_with([&] { bench_.measure(); }, parts);
    }
    std::string refusal() const {
        bench_.rewrite();
        return message_of([&] { bench_.measure(); });
    }
    Json& captures() { return bench_.manifest["captures"]; }
    Json& white() { return bench_.manifest["white_reference"]; }
    std::filesystem::path picture(const Json& entry) const {
        return bench_.captures() / entry["file"].get<std::string>();
    }

    SpotBench bench_;
};

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST_F(SpotProblems, GoodOnesPassAndAreKnown) {
    const SpotMeasurement report = bench_.measure();
    EXPECT_TRUE(report.notes.empty()) << report.notes.front();
    ASSERT_EQ(report.channels.size(), 3u);
    const MeasuredChannel& green = report.channels[1];
    EXPECT_EQ(green.file, bench_.folder / "sample-green.csv");
    EXPECT_SAYS(read_text_file(green.file), "--spot-mm");
    EXPECT_SAYS(green.fit_command, "livery fit bssrdf --profile");
    EXPECT_EQ(check_file(green.file).kind, "profile");
    const FileCheck check = check_file(bench_.captures());
    EXPECT_EQ(check.kind, "spot captures");
    EXPECT_TRUE(check.ok()) << check.problems.front();
}

TEST_F(SpotProblems, CamerasInTheMirrorImageAreRefused) {
    bench_.manifest["projector_mm"] = {0.0, 495.0, 495.0};
    EXPECT_SAYS(refusal(), "45.0 degrees from the normal");
    bench_.manifest["projector_mm"] = {0.0, 300.0, 620.0};
    EXPECT_EQ(refusal(), "nothing thrown");
    bench_.manifest["projector_mm"] = {0.0, 0.0, -620.0};
    EXPECT_TRUE(fails({"projector_mm", "behind the plane"}));
    bench_.manifest["projector_mm"] = {0.0, 0.0, 620.0};
    bench_.manifest["plane"]["normal"] = {0.0, -0.38, 0.92};
    EXPECT_SAYS(refusal(), "mirrors the projector");
}

TEST_F(SpotProblems, ClippedPhotographsAreRefused) {
    const Json good = bench_.manifest;
    captures().erase(0);
    EXPECT_SAYS(refusal(), "the sample is saturated in every photograph where the spot is");
    bench_.manifest = good;
    white()["captures"].erase(0);
    EXPECT_SAYS(refusal(), "the spot on the white reference is saturated");
    bench_.manifest = good;
    bench_.manifest["saturates_at"] = bench_.manifest["black_level"].get<double>() + 1.0;
    EXPECT_SAYS(refusal(), "saturated in every photograph");
}

TEST_F(SpotProblems, DarkPhotographsAreRefused) {
    const Json good = bench_.manifest;
    white()["captures"] = white()["black"];
    EXPECT_SAYS(refusal(), "no spot of light shows");
    bench_.manifest = good;
    captures() = bench_.manifest["black"];
    EXPECT_SAYS(refusal(), "rings lie between");
}

TEST_F(SpotProblems, DamagedPicturesAreRefusedByName) {
    const auto file = picture(captures()[0]);
    const std::string good = read_text_file(file);
    write_text_file(file, good.substr(0, good.size() / 2));
    EXPECT_TRUE(fails({file.filename().string()}));
    EXPECT_FALSE(check_file(bench_.captures()).ok());
    write_png(file, Image16(64, 64, 3, 2000));
    EXPECT_TRUE(fails({file.filename().string(), "64x64", "the camera's 320x320"}));
    write_text_file(file, good);
    ImageF odd(320, 320, 3, 0.5f);
    odd.values[77] = std::nanf("");
    write_exr(bench_.captures() / "odd.exr", odd);
    captures()[0]["file"] = "odd.exr";
    EXPECT_TRUE(fails({"odd.exr", "NaN"}));
}

TEST_F(SpotProblems, RequestsAreChecked) {
    EXPECT_THROW(measure_profile({bench_.captures(), 1.5, "a.json"}), std::invalid_argument);
    EXPECT_THROW(measure_profile({bench_.captures(), 0.5, "a.csv"}), std::invalid_argument);
    EXPECT_THROW(measure_profile({bench_.captures(), std::nan(""), "a.csv"}),
                 std::invalid_argument);
    const std::string out = (bench_.folder / "none").string() + "/sample.csv";
    EXPECT_THROW(measure_profile({bench_.captures(), 1.5, out}), FileError);
    bench_.manifest["sphere"] = {{"diameter_mm", 60}};
    EXPECT_TRUE(fails({"sphere"}));
}

TEST(SpotWidth, SpotsWiderThanAThirdOfTheLightAreRefused) {
    const SpotBench bench(
        {kMarbleRgb[1], kMarbleRgb[1], kMarbleRgb[1]}, 320, 4000, [](SpotStand& stand) {
            stand.spot_sigma_mm = 0.3;
        });
    try {
        bench.measure();
        ADD_FAILURE() << "not refused";
    } catch (const Refused& refused) {
        const std::string said = refused.what();
        EXPECT_SAYS(said, "wide, more than a third of the");
        EXPECT_SAYS(said, "red: ");
    }
    EXPECT_FALSE(std::filesystem::exists(bench.folder / "sample-red.csv"));
}

TEST(SpotWidth, SpotsAtTheEdgeOfThePictureAreRefused) {
    const SpotBench bench(
        {kMarbleRgb[1], kMarbleRgb[1], kMarbleRgb[1]}, 320, 4000, [](SpotStand& stand) {
            stand.camera.view.principal_px.x = 2.0;
            stand.camera.view.distortion = {};
        });
    try {
        bench.measure();
        ADD_FAILURE() << "not refused";
    } catch (const Refused& refused) {
        EXPECT_SAYS(std::string(refused.what()), "not wholly in the picture");
    }
}

TEST(SpotWidth, AChannelWithoutLightIsLeftOut) {
    const SpotBench bench(
        {kMarbleRgb[1], kMarbleRgb[1], kMarbleRgb[1]}, 320, 4000, two_pixels_wide);
    // Blue of every photograph is that of black: a green laser with some red.
    for (const auto& entry : std::filesystem::directory_iterator(bench.captures())) {
        if (entry.path().extension() != ".png") continue;
        const ImageFile file = read_image(entry.path());
        Image16 picture(file.image.width, file.image.height, 3);
        for (std::size_t k = 0; k < picture.values.size(); ++k) {
            picture.values[k] =
                static_cast<std::uint16_t>(k % 3 == 2 ? 1024.0f : file.image.values[k]);
        }
        write_png(entry.path(), picture);
    }
    const SpotMeasurement report = bench.measure();
    ASSERT_EQ(report.channels.size(), 2u);
    EXPECT_EQ(report.channels[1].channel, "green");
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_SAYS(report.notes[0], "no blue light");
}

}  // namespace
}  // namespace livery
