// A folder of photographs is one more camera: what it gives, and what is said of a folder that
// lacks something, holds too much or shows other pictures.
#include "jobs/captured_calibration.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "calibration/correspondence/patterns.h"
#include "calibration/settings.h"
#include "capture/patterns_folder.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/statistics.h"
#include "core/worst_error.h"
#include "jobs/simulated_captures.h"
#include "session/small_session.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::kSmallHeight;
using testing::kSmallWidth;

/// A folder of the simulated bench's photographs, in the order in which a live session takes them:
/// white and black first, and once more at the end.
class CapturedCalibration : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        shared_ = new TemporaryFolder;
        std::vector<Pattern> geometry = geometry_patterns(kSmallWidth, kSmallHeight);
        std::vector<Pattern> patterns{geometry[geometry.size() - 2], geometry.back()};
        patterns.insert(patterns.end(), geometry.begin(), geometry.end() - 2);
        for (const Pattern& pattern : colour_patterns(kSmallWidth, kSmallHeight, 0, 255))
            patterns.push_back(pattern);
        patterns.insert(patterns.end(), geometry.end() - 2, geometry.end());
        std::vector<PatternFile> files;
        for (const Pattern& one : patterns)
            files.push_back({one.role, one.drive, one.drive_values});
        write_patterns_folder(*shared_ / "patterns", kSmallWidth, kSmallHeight, files);
        photograph_patterns(
            {testing::small_bench_description(), *shared_ / "patterns", *shared_ / "captures"});
    }
    static void TearDownTestSuite() { delete shared_; }

    /// Of the folder above, its manifest changed.
    ColourCalibration calibrated(const std::function<void(Json&)>& change) const {
        const std::filesystem::path from = *shared_ / "captures";
        Json manifest = read_json_file(from / "manifest.json");
        for (Json& entry : manifest["captures"])
            for (const char* field : {"file", "pattern"})
                entry[field] = (from / entry[field].get<std::string>()).string();
        change(manifest["captures"]);
        write_json_file(folder_ / "manifest.json", manifest);
        return calibrate_from_folder({folder_.path(), {}, {}});
    }
    std::string refused(const std::function<void(Json&)>& change) const {
        const std::string said = message_of([&] { calibrated(change); });
        std::printf("    %s\n", said.c_str());
        return said;
    }

    static Json& entry(Json& captures, const std::string& role) {
        for (Json& one : captures)
            if (one["role"] == role) return one;
        throw std::logic_error("no " + role);
    }
    static void erase(Json& captures, const std::string& role) {
        Json kept = Json::array();
        for (const Json& one : captures)
            if (one["role"] != role) kept.push_back(one);
        captures = kept;
    }
    /// A copy of that photograph, its values changed.
    std::string changed(const Json& of, const std::function<float(float)>& change) const {
        ImageF image = read_image(of["file"].get<std::string>()).image;
        for (float& value : image.values) value = change(value);
        write_exr(folder_ / "changed.exr", image);
        return (folder_ / "changed.exr").string();
    }

    static TemporaryFolder* shared_;
    TemporaryFolder folder_;
};
TemporaryFolder* CapturedCalibration::shared_ = nullptr;

void expect_same(const ImageF& a, const ImageF& b, const char* name) {
    ASSERT_EQ(a.values.size(), b.values.size()) << name;
    std::size_t differ = 0, known = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        known += std::isfinite(a.values[i]);
        differ += a.values[i] != b.values[i] &&
                  (std::isfinite(a.values[i]) || std::isfinite(b.values[i]));
    }
    EXPECT_EQ(differ, 0u) << name;
    EXPECT_GT(known, 1000u) << name;
}

// A camera that answers with the very photographs that lie in the folder, asked live for whatever a
// live session asks for: latency, exposure, and one picture after another.
TEST_F(CapturedCalibration, IsTheOneOfTheSamePhotographsTakenLive) {
    // The camera knows a picture by what it shows: uniform white and black are one picture each.
    const auto alike = [](Json& captures) {
        entry(captures, "bright-gray")["file"] = entry(captures, "white")["file"];
        entry(captures, "dark-gray")["file"] = entry(captures, "black")["file"];
        const auto end = captures.size();
        captures[end - 2]["file"] = captures[0]["file"].get<std::string>() + ".copy.exr";
        captures[end - 1]["file"] = captures[1]["file"].get<std::string>() + ".copy.exr";
        for (std::size_t k = 0; k < 2; ++k)
            std::filesystem::copy_file(captures[k]["file"].get<std::string>(),
                                       captures[end - 2 + k]["file"].get<std::string>(),
                                       std::filesystem::copy_options::overwrite_existing);
    };
    const ColourCalibration folder = calibrated(alike);

    std::vector<std::pair<Image8, Photograph>> known;
    for (const Capture& capture :
         read_captures_folder(folder_.path(), PhotographUse::light).captures) {
        Image8 drive(kSmallWidth, kSmallHeight, 3);
        const ImageFile shown = read_image(capture.pattern);
        std::copy(shown.image.values.begin(), shown.image.values.end(), drive.values.begin());
        known.emplace_back(std::move(drive), load_photograph(capture));
    }
    BenchPorts ports;
    const Photograph* seen = &known.back().second;
    ports.show = [&](const Image8& drive) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const auto& one) {
            return one.first.values == drive.values;
        });
        ASSERT_NE(found, known.end());
        seen = &found->second;
    };
    ports.photograph = [&](double) { return *seen; };
    CalibrationSettings options = testing::live_settings(testing::small_bench_description());
    const ColourCalibration live = calibrate_live(ports, options).calibration;

    expect_same(folder.unmixing, live.unmixing, "unmixing");
    expect_same(folder.dark, live.dark, "dark");
    expect_same(folder.span, live.span, "span");
    expect_same(folder.camera_px, live.camera_px, "camera_px");
    EXPECT_EQ(folder.status.values, live.status.values);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(folder.response[k].drive_from_n, live.response[k].drive_from_n) << k;
    EXPECT_EQ(folder.warnings, live.warnings);
    EXPECT_GT(folder.valid_fraction, 0.8);
}

// Without a manifest names give the order; where it does not hold, what the photographs show does.
TEST_F(CapturedCalibration, RecognisesAnotherOrderOfTheFiles) {
    const std::filesystem::path from = *shared_ / "captures";
    const Json manifest = read_json_file(from / "manifest.json");
    std::vector<Pattern> patterns = geometry_patterns(kSmallWidth, kSmallHeight);
    for (Pattern& pattern : colour_patterns(kSmallWidth, kSmallHeight, 0, 255))
        patterns.push_back(std::move(pattern));
    std::vector<PatternFile> shown;
    std::vector<std::string> roles;
    for (const Pattern& one : patterns) {
        shown.push_back({one.role, one.drive, one.drive_values});
        roles.push_back(one.role);
    }
    write_patterns_folder(folder_ / "patterns", kSmallWidth, kSmallHeight, shown);
    const auto photograph_of = [&](const std::string& role) {
        for (const Json& entry : manifest["captures"])
            if (entry["role"] == role) return from / entry["file"].get<std::string>();
        throw std::logic_error("no " + role);
    };
    // How many get a wrong role, and what is said
    const auto read = [&](const std::vector<std::string>& order) {
        const TemporaryFolder here;
        for (std::size_t k = 0; k < order.size(); ++k)
            std::filesystem::copy_file(photograph_of(order[k]),
                                       here.path() / ("IMG_" + std::to_string(1000 + k) + ".exr"));
        std::vector<std::string> warnings;
        const CapturesFolder folder = read_shown_captures(
            here.path(), PhotographUse::places, folder_ / "patterns/manifest.json", warnings);
        for (const std::string& warning : warnings) std::printf("    %s\n", warning.c_str());
        std::size_t wrong = 0;
        for (std::size_t k = 0; k < order.size(); ++k) {
            // What is flat and shows the same may have the other's role
            const bool alike = order[k] == "white" || order[k] == "bright-gray" ||
                               order[k] == "black" || order[k] == "dark-gray";
            wrong += !alike && folder.captures[k].role != order[k];
        }
        return std::pair(wrong, warnings.size());
    };
    EXPECT_EQ(read(roles), std::pair(std::size_t{0}, std::size_t{0}));
    std::vector<std::string> white_first{"white", "black"};
    for (const std::string& role : roles)
        if (role != "white" && role != "black") white_first.push_back(role);
    EXPECT_EQ(read(white_first), std::pair(std::size_t{0}, std::size_t{1}));
}

// As a live calibration does: what lights the mock-up where the camera does not see it
TEST_F(CapturedCalibration, PredictsWhatTheCameraDoesNotSee) {
    const ColourCalibration without = calibrated([](Json&) {});
    CalibrationSettings settings;
    settings.product = testing::small_bench_product();
    settings.projector = testing::small_bench_description().projector.view;
    const ColourCalibration with = calibrate_from_folder({folder_.path(), {}, {}}, settings);
    EXPECT_EQ(without.predicted_fraction, 0.0);
    std::printf("    %.1f%% predicted, to %.1f%% in the median\n",
                100.0 * with.predicted_fraction,
                100.0 * with.prediction_error_median);
    EXPECT_GT(with.predicted_fraction, 0.01);
    EXPECT_LT(with.prediction_error_median, 0.05);
    std::size_t black = 0;
    for (std::size_t p = 0; p < with.status.values.size(); ++p) {
        const auto before = static_cast<PixelStatus>(without.status.values[p]);
        const auto after = static_cast<PixelStatus>(with.status.values[p]);
        if (is_valid(before)) {
            EXPECT_EQ(before, after);
        }
        black += !is_valid(before) && is_valid(after);
    }
    EXPECT_GT(black, 100u);
}

// Half the exposure and another black level, said of the one photograph that has them
TEST_F(CapturedCalibration, TakesEachPhotographAsItWasExposed) {
    const ColourCalibration plain = calibrated([](Json&) {});
    const ColourCalibration other = calibrated([&](Json& captures) {
        Json& red = entry(captures, "red");
        const float black = red["black_level"].get<float>();
        red["file"] = changed(red, [&](float v) { return 100.0f + 0.5f * (v - black); });
        red["black_level"] = 100.0;
        red["exposure_s"] = 0.5 * red["exposure_s"].get<double>();
        red["saturates_at"] = 100.0 + 0.5 * (red["saturates_at"].get<double>() - double{black});
    });
    EXPECT_EQ(plain.status.values, other.status.values);
    EXPECT_NEAR(plain.additivity_error, other.additivity_error, 1e-6);
    double largest = 0.0;
    for (std::size_t i = 0; i < plain.span.values.size(); ++i) {
        // A pixel that nothing lights spans nothing, in both.
        if (!std::isfinite(plain.span.values[i]) || plain.span.values[i] == other.span.values[i])
            continue;
        largest = worse_of(largest,
                           std::abs(static_cast<double>(other.span.values[i]) /
                                        static_cast<double>(plain.span.values[i]) -
                                    1.0));
    }
    EXPECT_LT(largest, 1e-4);
}

TEST_F(CapturedCalibration, NamesThePictureThatNobodyPhotographed) {
    for (const char* role : {"red", "gray-row-3", "white"}) {
        const std::string said = refused([&](Json& captures) { erase(captures, role); });
        EXPECT_NE(said.find("no photograph of " + std::string(role)), std::string::npos) << said;
        EXPECT_NE(said.find(folder_.path().string()), std::string::npos) << said;
    }
}

// Fringes in the folder are used by themselves: all of them, or the one that is missing is named.
TEST_F(CapturedCalibration, UsesFringesThatWerePhotographed) {
    std::vector<PatternFile> files;
    for (const Pattern& one : place_patterns(PlaceCode::gray_and_phase, kSmallWidth, kSmallHeight))
        files.push_back({one.role, one.drive, one.drive_values});
    for (const Pattern& one : colour_patterns(kSmallWidth, kSmallHeight, 0, 255))
        files.push_back({one.role, one.drive, one.drive_values});
    write_patterns_folder(folder_ / "patterns", kSmallWidth, kSmallHeight, files);
    photograph_patterns(
        {testing::small_bench_description(), folder_ / "patterns", folder_ / "captures"});
    const std::filesystem::path manifest_file = folder_ / "captures/manifest.json";
    const Json manifest = read_json_file(manifest_file);
    const auto calibrated_without = [&](const std::function<bool(const std::string&)>& left_out) {
        Json changed = manifest;
        changed["captures"] = Json::array();
        for (const Json& one : manifest["captures"])
            if (!left_out(one["role"].get<std::string>())) changed["captures"].push_back(one);
        write_json_file(manifest_file, changed);
        return calibrate_from_folder({folder_ / "captures", {}, {}});
    };
    const ColourCalibration fine = calibrated_without([](const std::string&) { return false; });
    const ColourCalibration whole = calibrated_without(is_fringe_role);
    EXPECT_EQ(testing::all_warnings(fine).find("not asked for"), std::string::npos);
    EXPECT_GT(fine.valid_fraction, 0.97 * whole.valid_fraction);
    // Both maps are of one scene: apart by the rounding to whole pixels, and not equal.
    std::vector<float> apart;
    for (std::size_t i = 0; i < fine.camera_px.values.size(); ++i) {
        const float off = std::abs(fine.camera_px.values[i] - whole.camera_px.values[i]);
        if (std::isfinite(off)) apart.push_back(off);
    }
    std::printf("    maps apart by %.4f camera px in the median\n",
                static_cast<double>(median(apart)));
    EXPECT_GT(median(apart), 0.0f);
    EXPECT_LT(median(apart), 0.5f);

    const std::string said = message_of(
        [&] { calibrated_without([](const std::string& role) { return role == "phase-row-3"; }); });
    EXPECT_NE(said.find("no photograph of phase-row-3"), std::string::npos) << said;
    EXPECT_NE(said.find((folder_ / "captures").string()), std::string::npos) << said;
}

TEST_F(CapturedCalibration, NamesPhotographsThatWereNotAskedFor) {
    const ColourCalibration calibration = calibrated([](Json& captures) {
        for (const char* role : {"verify-1", "verify-0"}) {
            captures.push_back(entry(captures, "red"));
            captures.back()["role"] = role;
        }
    });
    EXPECT_NE(testing::all_warnings(calibration).find("verify-0 are not asked for"),
              std::string::npos)
        << testing::all_warnings(calibration);
    const std::string said = refused([](Json& captures) {
        captures.push_back(entry(captures, "gray-column-8"));
        captures.back()["role"] = "gray-column-9";
    });
    EXPECT_NE(said.find("gray-column-9"), std::string::npos) << said;
    EXPECT_NE(said.find("no such bit for a 320x200 projector"), std::string::npos) << said;
}

TEST_F(CapturedCalibration, NamesThePhotographOfAnotherSize) {
    for (const char* role : {"red", "gray-column-2"}) {
        const std::string said = refused([&](Json& captures) {
            write_exr(folder_ / "small.exr", ImageF(64, 48, 3, 2000.0f));
            entry(captures, role)["file"] = (folder_ / "small.exr").string();
        });
        for (const std::string& part :
             {std::string("small.exr"), std::string(role), std::string("64x48")})
            EXPECT_NE(said.find(part), std::string::npos) << said;
    }
}

TEST_F(CapturedCalibration, RefusesTwoPicturesOfOneRole) {
    const std::string said = refused([&](Json& captures) {
        captures.push_back(entry(captures, "gray-levels"));
        captures.back()["file"] = changed(captures.back(), [](float v) { return v; });
        captures.back()["pattern"] = entry(captures, "red")["pattern"];
    });
    EXPECT_NE(said.find("another picture for gray-levels"), std::string::npos) << said;
    EXPECT_NE(said.find("one picture a role"), std::string::npos) << said;
}

TEST_F(CapturedCalibration, TellsAPhotographOfAnotherPicture) {
    const std::string levels = refused([](Json& captures) {
        entry(captures, "gray-levels")["file"] = entry(captures, "bright-gray")["file"];
    });
    EXPECT_NE(levels.find("gray-levels"), std::string::npos) << levels;
    const std::string red = refused([](Json& captures) {
        std::swap(entry(captures, "red")["file"], entry(captures, "green")["file"]);
    });
    EXPECT_NE(red.find("swapped"), std::string::npos) << red;
}

}  // namespace
}  // namespace livery
