// What goes wrong between the first photograph and the last, injected into photographs of the
// simulated bench: each must be told apart from a projector that is not additive, and named.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "calibration/calibrate_live.h"
#include "calibration/correspondence/patterns.h"
#include "session/small_session.h"
#include "support/kept_light.h"

namespace livery {
namespace {

using testing::kSmallHeight;
using testing::kSmallWidth;

std::vector<Pattern> colours_and_mosaics() {
    std::vector<Pattern> patterns = colour_patterns(kSmallWidth, kSmallHeight, 0, 255);
    for (Pattern& pattern : mosaic_patterns(kSmallWidth, kSmallHeight, kMosaics))
        patterns.push_back(std::move(pattern));
    return patterns;
}

std::vector<Pattern> all_patterns() {
    std::vector<Pattern> patterns = geometry_patterns(kSmallWidth, kSmallHeight);
    for (Pattern& pattern : colours_and_mosaics()) patterns.push_back(std::move(pattern));
    for (Pattern& pattern : geometry_patterns(kSmallWidth, kSmallHeight))
        if (pattern.role == "white" || pattern.role == "black")
            patterns.push_back(std::move(pattern));
    return patterns;
}

/// Photographs of all patterns in their order, taken once.
const std::vector<RoledPhotograph>& photographs() {
    static const std::vector<RoledPhotograph> taken = [] {
        BenchDescription description = testing::small_bench_description();
        description.projector.leak = 0.001;
        description.camera.flare = 0.003;
        description.ambient = 0.006;
        Bench bench = testing::bench_on_kept_light(description, testing::small_bench_product());
        const BenchPorts ports = bench.ports();
        std::vector<RoledPhotograph> result;
        for (const Pattern& pattern : all_patterns()) {
            ports.show(pattern.drive);
            result.push_back({pattern.role, ports.photograph(0.0)});
            result.back().photograph.name = pattern.role;
        }
        return result;
    }();
    return taken;
}

using Shots = std::vector<RoledPhotograph>;

/// The first photograph with this role.
RoledPhotograph& shot(Shots& shots, const std::string& role) {
    return *std::find_if(
        shots.begin(), shots.end(), [&](const auto& shot) { return shot.role == role; });
}

void each_from(Shots& shots,
               const std::string& role,
               const std::function<void(RoledPhotograph&)>& change) {
    const auto first =
        std::find_if(shots.begin(), shots.end(), [&](const auto& one) { return one.role == role; });
    std::for_each(first, shots.end(), change);
}

void expose(RoledPhotograph& shot, double factor) {
    Photograph& photo = shot.photograph;
    for (float& value : photo.image.values) {
        const double light = (static_cast<double>(value) - photo.black_level) * factor;
        value = static_cast<float>(
            std::clamp(std::round(light + photo.black_level), 0.0, photo.saturates_at));
    }
}

void shade(RoledPhotograph& shot) {
    Photograph& photo = shot.photograph;
    for (int y = 0; y < photo.image.height; ++y)
        for (int x = 0; x < photo.image.width; ++x) {
            const double dx = (x - 0.45 * photo.image.width) / (0.13 * photo.image.width),
                         dy = (y - 0.5 * photo.image.height) / (0.3 * photo.image.height);
            const double shadow = 0.6 / (1.0 + std::exp((std::hypot(dx, dy) - 1.0) * 12.0));
            for (int c = 0; c < 3; ++c) {
                float& value = photo.image.at(x, y, c);
                value = static_cast<float>(photo.black_level +
                                           (1.0 - shadow) *
                                               (static_cast<double>(value) - photo.black_level));
            }
        }
}

void move(RoledPhotograph& shot, double dx, double dy) {
    const ImageF from = shot.photograph.image;
    ImageF& to = shot.photograph.image;
    const int left = static_cast<int>(std::floor(-dx)), top = static_cast<int>(std::floor(-dy));
    const auto right_share = static_cast<float>(-dx - left),
               low_share = static_cast<float>(-dy - top);
    const auto at = [&](int x, int y, int c) {
        return from.at(std::clamp(x, 0, to.width - 1), std::clamp(y, 0, to.height - 1), c);
    };
    const auto across = [&](int x, int y, int c) {
        return std::lerp(at(x, y, c), at(x + 1, y, c), right_share);
    };
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x)
            for (int c = 0; c < 3; ++c)
                to.at(x, y, c) = std::lerp(
                    across(x + left, y + top, c), across(x + left, y + top + 1, c), low_share);
}

/// Photographs that are what they are; in the order in which they were taken.
BenchPorts ports_of(const Shots& shots) {
    BenchPorts ports;
    const auto waiting = std::make_shared<std::vector<std::size_t>>();
    ports.show = [](const Image8&) {};
    ports.turn_to = [&shots, waiting](const std::string& role) {
        for (std::size_t k = shots.size(); k-- > 0;)
            if (shots[k].role == role) waiting->push_back(k);
        return static_cast<int>(waiting->size());
    };
    ports.photograph = [&shots, waiting](double) {
        Photograph photograph = shots[waiting->back()].photograph;
        photograph.taken_at = static_cast<double>(waiting->back());
        waiting->pop_back();
        return photograph;
    };
    return ports;
}

/// Why and fix of the refusal, else the warnings.
std::string said_of(
    const Shots& shots,
    const std::vector<Pattern>& patterns = colour_patterns(kSmallWidth, kSmallHeight, 0, 255)) {
    try {
        CalibrationSettings options;
        options.width = kSmallWidth;
        options.height = kSmallHeight;
        options.patterns = patterns;
        const ColourCalibration calibration = calibrate_live(ports_of(shots), options).calibration;
        return "accepted: " + testing::all_warnings(calibration);
    } catch (const Refused& refused) {
        return "refused: " + refused.why() + "; " + refused.fix();
    }
}

struct Fault {
    const char* name;
    std::function<void(Shots&)> spoil;
    std::vector<const char*> said;  ///< each of it
};

class SpoiledCaptures : public ::testing::TestWithParam<Fault> {};

TEST_P(SpoiledCaptures, AreNamed) {
    Shots shots = photographs();
    GetParam().spoil(shots);
    const std::string said = said_of(shots);
    std::printf("%s\n", said.c_str());
    for (const char* part : GetParam().said)
        EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
    EXPECT_TRUE(said.starts_with("accepted") || said.find("not additive") == std::string::npos)
        << said;
}

void swap_roles(Shots& shots, const char* a, const char* b) {
    std::swap(shot(shots, a).photograph, shot(shots, b).photograph);
}

const std::vector<Fault> kFaults = {
    {"AutomaticExposure",
     [](Shots& shots) {
         for (RoledPhotograph& one : shots) {
             double mean = 0.0;
             for (const float v : one.photograph.image.values)
                 mean += static_cast<double>(v) - one.photograph.black_level;
             mean /= static_cast<double>(one.photograph.image.values.size());
             expose(one, 1200.0 / mean);
         }
     },
     {"refused", "automatic exposure"}},
    {"OneAtSeventyPercent",
     [](Shots& s) { expose(shot(s, "red"), 0.7); },
     {"refused", "red is 30", "darker", "another exposure"}},
    {"OneAtNinetyFivePercent",
     [](Shots& s) { expose(shot(s, "green"), 0.95); },
     {"green is 5", "darker", "another exposure"}},
    {"BrightGrayAtNinetySevenPercent",
     [](Shots& s) { expose(shot(s, "bright-gray"), 0.97); },
     {"bright-gray is", "darker", "another exposure"}},
    {"LevelsAtNinetyFivePercent",
     [](Shots& s) { expose(shot(s, "gray-levels"), 0.95); },
     {"gray-levels is", "darker", "another exposure"}},
    {"ShadowOverRed", [](Shots& s) { shade(shot(s, "red")); }, {"refused: red", "shadow"}},
    {"ShadowOverBright",
     [](Shots& s) { shade(shot(s, "bright-gray")); },
     {"refused: bright-gray:", "shadow"}},
    {"ShadowOverLevels",
     [](Shots& s) { shade(shot(s, "gray-levels")); },
     {"refused: gray-levels", "shadow"}},
    {"ShadowOverStripes",
     [](Shots& s) { shade(shot(s, "gray-column-2")); },
     {"refused: gray-column-2:", "shadow"}},
    {"ShadowOverWhite", [](Shots& s) { shade(shot(s, "white")); }, {"refused: white", "shadow"}},
    {"ShadowOverAllColours",
     [](Shots& s) {
         for (const char* role : {"bright-gray", "red", "green", "blue"}) shade(shot(s, role));
     },
     {"refused: bright-gray, red, green and blue", "shadow"}},
    {"RoomLightSwitchedOn",
     [](Shots& s) {
         const ImageF black = shot(s, "black").photograph.image;
         each_from(s, "bright-gray", [&](RoledPhotograph& one) {
             Photograph& p = one.photograph;
             for (std::size_t i = 0; i < black.values.size(); ++i)
                 p.image.values[i] += 15.0f * (black.values[i] - static_cast<float>(p.black_level));
         });
     },
     {"refused: the room's light changed before bright-gray"}},
    {"EncodedFilesCalledLinear",
     [](Shots& shots) {
         for (RoledPhotograph& one : shots) {
             Photograph& p = one.photograph;
             for (float& v : p.image.values) {
                 const double light =
                     (static_cast<double>(v) - p.black_level) / (p.saturates_at - p.black_level);
                 v = static_cast<float>(std::round(255.0 * srgb_encode(std::max(0.0, light))));
             }
             p.black_level = 0.0;
             p.saturates_at = 255.0;
         }
     },
     {"refused: the files are encoded", "linear", "stripes", "transfer"}},
    {"OverExposed",
     [](Shots& shots) {
         for (RoledPhotograph& one : shots) expose(one, 2.2);
     },
     {"refused: white", "saturated", "exposure"}},
    {"OverExposedUndeclared",
     [](Shots& shots) {
         for (RoledPhotograph& one : shots) {
             expose(one, 2.2);
             one.photograph.saturates_at = 65535.0;
         }
     },
     {"refused: white", "saturated", "exposure"}},
    {"StripesExchangedWithTheirInverse",
     [](Shots& s) { swap_roles(s, "gray-column-4", "gray-column-4-inverse"); },
     {"refused: the photographs of gray-column-4 and gray-column-4-inverse are exchanged"}},
    {"TwoStripesExchanged",
     [](Shots& s) { swap_roles(s, "gray-row-3", "gray-row-4"); },
     {"refused: the photographs of gray-row-3 and gray-row-4 are exchanged"}},
    {"RedAndGreenSwapped",
     [](Shots& s) { swap_roles(s, "red", "green"); },
     {"refused: red (green) and green (red) are swapped"}},
    {"RedShowsThePictureBefore",
     [](Shots& s) { shot(s, "red").photograph = shot(s, "bright-gray").photograph; },
     {"refused: red", "shows what bright-gray"}},
    {"EachShowsThePictureBefore",
     [](Shots& shots) {
         for (std::size_t k = shots.size(); k-- > 1;) shots[k].photograph = shots[k - 1].photograph;
     },
     {"refused: black", "is brighter than white", "before"}},
    {"CameraMovedAtTheRows",
     [](Shots& s) { each_from(s, "gray-row-0", [](auto& one) { move(one, 2, 1); }); },
     {"refused: camera, projector or mock-up moved: from gray-row-0 on", "2.2"}},
    {"CameraMovedAtTheColours",
     [](Shots& s) { each_from(s, "dark-gray", [](auto& one) { move(one, 2, 1); }); },
     {"refused: camera, projector or mock-up moved: from bright-gray on"}},
    {"CameraMovedByOneAndAHalfPixelsAtTheColours",
     [](Shots& s) { each_from(s, "dark-gray", [](auto& one) { move(one, 1.2, 0.9); }); },
     {"refused: camera, projector or mock-up moved: from bright-gray on"}},
    {"CameraMovedByHalfAPixelAtTheColours",
     [](Shots& s) { each_from(s, "dark-gray", [](auto& one) { move(one, 0.4, 0.3); }); },
     {"accepted", "camera, projector or mock-up moved: from bright-gray on"}},
    {"LightFlickers",
     [](Shots& shots) {
         Random random(3);
         for (RoledPhotograph& one : shots) expose(one, 1.0 + 0.02 * random.normal());
     },
     {"refused", "flickers"}},
    {"LightDrifts",
     [](Shots& shots) {
         for (std::size_t k = 0; k < shots.size(); ++k)
             expose(shots[k],
                    1.0 - 0.05 * static_cast<double>(k) / static_cast<double>(shots.size()));
     },
     {"the light drifts", "darker"}},
    {"Mirrored",
     [](Shots& shots) {
         for (RoledPhotograph& one : shots) {
             const ImageF from = one.photograph.image;
             ImageF& to = one.photograph.image;
             for (int y = 0; y < to.height; ++y)
                 for (int x = 0; x < to.width; ++x)
                     std::copy_n(from.pixel(to.width - 1 - x, y), 3, to.pixel(x, y));
         }
     },
     {"accepted", "mirrored"}},
};

INSTANTIATE_TEST_SUITE_P(Faults,
                         SpoiledCaptures,
                         ::testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

/// Photographs that are darker from one on, to the end: by a tenth and by half.
std::string said_of_darker(const std::string& from, double factor, bool mosaics, bool ends) {
    Shots shots = photographs();
    if (!ends) shots.resize(shots.size() - 2);
    if (!mosaics)
        std::erase_if(shots, [](const auto& one) { return one.role.starts_with("colors-"); });
    each_from(shots, from, [&](auto& one) { expose(one, factor); });
    const std::string said = mosaics ? said_of(shots, colours_and_mosaics()) : said_of(shots);
    std::printf("    %.2f from %s%s%s: %s\n",
                factor,
                from.c_str(),
                mosaics ? ", mosaics" : "",
                ends ? ", white and black at the end" : "",
                said.c_str());
    return said;
}

// The projector is not blamed, whatever the picture at which it begins.
TEST(SpoiledSession, DarkerFromOnePictureOnIsNamed) {
    for (const auto& [factor, whole_session] : {std::pair{0.5, false}, std::pair{0.9, true}})
        for (const std::string from : {"bright-gray", "red", "green", "blue"}) {
            const std::string said = said_of_darker(from, factor, whole_session, whole_session);
            EXPECT_NE(said.find(from), std::string::npos) << said;
            EXPECT_NE(said.find("darker"), std::string::npos) << said;
            EXPECT_EQ(said.find("sRGB"), std::string::npos) << said;
            EXPECT_EQ(said.find("not additive"), std::string::npos) << said;
        }
    // Mosaics are not used where white is the sum of the channels; the white after them is
    EXPECT_TRUE(said_of_darker("colors-2", 0.5, true, false).starts_with("accepted"));
    EXPECT_NE(said_of_darker("colors-2", 0.5, true, true).find("refused: white"),
              std::string::npos);
}

TEST(CleanCaptures, AreAcceptedWithoutAWordOfBlame) {
    const std::string said = said_of(photographs());
    EXPECT_TRUE(said.starts_with("accepted")) << said;
    for (const char* blame : {"moved",
                              "exposure",
                              "shadow",
                              "drift",
                              "flicker",
                              "swapped",
                              "not "
                              "additive",
                              "mirrored",
                              "encoded"})
        EXPECT_EQ(said.find(blame), std::string::npos) << blame << "\n" << said;
}

// More shots of one picture are averaged, whichever picture it is.
TEST(CleanCaptures, MayComeSeveralTimes) {
    Shots shots = photographs();
    const Shots again = photographs();
    shots.insert(shots.end(), again.begin(), again.end());
    EXPECT_TRUE(said_of(shots).starts_with("accepted"));
    expose(shots.back(), 1.0);
    for (std::size_t k = again.size(); k < shots.size(); ++k)
        if (shots[k].role == "blue") expose(shots[k], 0.9);
    const std::string said = said_of(shots);
    EXPECT_NE(said.find("refused: blue"), std::string::npos) << said;
}

}  // namespace
}  // namespace livery
