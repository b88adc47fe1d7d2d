#include "calibration/preflight.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>

#include "calibration/support/messages.h"
#include "calibration/support/synthetic_bench.h"
#include "core/error.h"

namespace livery {
namespace {

using testing::SyntheticBench;

/// A bench on which somebody tampers with the picture and with the lamp.
struct Room {
    SyntheticBench bench;
    Image8 visible;
    int photographs = 0;
    std::function<Image8(const Image8&)> on_its_way = [](const Image8& drive) { return drive; };
    std::function<double(const Image8&, int photograph)> lamp = [](const Image8&, int) {
        return 1.0;
    };

    Room() {
        bench.camera_width = 300;
        bench.camera_height = 200;
        bench.projector_width = 240;
        bench.projector_height = 150;
        bench.read_noise = 2.0;
        bench.file_units_per_light = bench.units_per_light();
        bench.exposure_s = 0.021;
        visible = Image8(240, 150, 3);
    }
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;

    Preflight run(Image8 mockup = {}) {
        BenchPorts ports;
        ports.show = [this](const Image8& drive) { visible = on_its_way(drive); };
        ports.photograph = [this](double exposure_s) {
            if (exposure_s > 0.0) bench.exposure_s = exposure_s;
            bench.lamp = lamp(visible, photographs++);
            return bench.photograph(visible);
        };
        return preflight(ports, {240, 150, std::move(mockup)});
    }
};

const GradedFigure& figure(const Preflight& result, const std::string& name) {
    for (const GradedFigure& each : result.figures)
        if (each.name == name) return each;
    throw std::runtime_error("no figure " + name);
}

double mean_drive(const Image8& drive) {
    return std::accumulate(drive.values.begin(), drive.values.end(), 0.0) /
           static_cast<double>(drive.values.size());
}

/// Every figure is good but these, which have this grade.
void expect_only(const Preflight& result,
                 Grade grade,
                 const std::vector<std::string>& names,
                 const std::string& what) {
    for (const GradedFigure& each : result.figures) {
        const bool named = std::find(names.begin(), names.end(), each.name) != names.end();
        EXPECT_EQ(each.grade, named ? grade : Grade::good)
            << what << ": " << each.name << " " << each.value;
        EXPECT_FALSE(each.fix.empty()) << each.name;
    }
    for (const std::string& name : names) figure(result, name);
}

/// What a scaler makes of the picture: sampled between pixels, drives mixed.
Image8 scaled(const Image8& drive, double factor) {
    Image8 result(drive.width, drive.height, 3);
    for (int y = 0; y < drive.height; ++y)
        for (int x = 0; x < drive.width; ++x) {
            const double u = (x + 0.5) / factor - 0.5, v = (y + 0.5) / factor - 0.5;
            const int x0 = static_cast<int>(std::floor(u)), y0 = static_cast<int>(std::floor(v));
            const double s = u - x0, t = v - y0;
            for (int c = 0; c < 3; ++c) {
                const auto at = [&](int px, int py) {
                    return static_cast<double>(drive.at(std::clamp(px, 0, drive.width - 1),
                                                        std::clamp(py, 0, drive.height - 1),
                                                        c));
                };
                result.at(x, y, c) = static_cast<std::uint8_t>(
                    (1 - t) * ((1 - s) * at(x0, y0) + s * at(x0 + 1, y0)) +
                    t * ((1 - s) * at(x0, y0 + 1) + s * at(x0 + 1, y0 + 1)) + 0.5);
            }
        }
    return result;
}

TEST(Preflight, IsGoodInAGoodRoom) {
    Room room;
    const Preflight result = room.run();
    EXPECT_EQ(result.figures.size(), 12u);
    // Some 50,000 of the camera's 60,000 pixels see light, which is not many.
    expect_only(result, Grade::usable, {"Size in the camera"}, "a good room");
    EXPECT_GT(result.exposure_s, 0.05);
    EXPECT_EQ(result.latency_photographs, 0);
    RecordProperty("photographs", room.photographs);
    EXPECT_LE(room.photographs, 33);
    EXPECT_EQ(room.visible.values, Image8(240, 150, 3).values) << "black at the end";
}

TEST(Preflight, CountsCameraPixelsOnTheMockUp) {
    Room room;
    Image8 mockup(240, 150, 1);
    std::fill_n(mockup.values.begin(), 20000, std::uint8_t{255});
    const Preflight result = room.run(mockup);
    EXPECT_EQ(figure(result, "Size in the camera").grade, Grade::good);
    EXPECT_HAS(figure(result, "Size in the camera").meaning, "takes 20000 of the");
}

TEST(Preflight, FindsAPictureThatIsScaled) {
    for (const double factor : {0.97, 1.03, 0.8}) {
        Room room;
        room.on_its_way = [&](const Image8& drive) { return scaled(drive, factor); };
        const Preflight result = room.run();
        EXPECT_EQ(figure(result, "Native pixels").grade, Grade::bad) << factor;
        EXPECT_EQ(figure(result, "White against its channels").grade, Grade::good) << factor;
    }
}

TEST(Preflight, FindsWhatSpoilsTheLight) {
    struct Case {
        const char* what;
        std::vector<std::string> figures;
        Grade grade;
        std::function<void(Room&)> spoil;
    };
    const std::vector<Case> cases{
        {"a clear wheel segment of 30%",
         {"White against its channels"},
         Grade::usable,
         [](Room& room) { room.bench.white_segment = 0.3; }},
        {"a room with the lights on",
         {"Room light"},
         Grade::bad,
         [](Room& room) { room.bench.ambient = glm::dvec3(0.08); }},
        {"a little light from the window",
         {"Room light"},
         Grade::usable,
         [](Room& room) { room.bench.ambient = glm::dvec3(0.02); }},
        {"a dynamic iris",
         {"Dynamic modes"},
         Grade::bad,
         [](Room& room) {
             room.lamp = [](const Image8& drive, int) {
                 return mean_drive(drive) < 40.0 ? 1.3 : 1.0;
             };
         }},
        {"a lamp that is dimmed in dark pictures",
         {"Dynamic modes"},
         Grade::bad,
         [](Room& room) {
             room.lamp = [](const Image8& drive, int) {
                 return mean_drive(drive) < 40.0 ? 0.7 : 1.0;
             };
         }},
        {"a lamp that flickers",
         {"Flicker"},
         Grade::bad,
         [](Room& room) {
             // In white alone, and not while the bench is met
             room.lamp = [](const Image8& drive, int k) {
                 return mean_drive(drive) > 250.0 && k > 26 ? 1.0 + 0.012 * (k % 2) : 1.0;
             };
         }},
        {"glass that shines at the camera",
         {"Exposure"},  // which must be short, or it would be clipped
         Grade::bad,
         [](Room& room) {
             room.bench.scale = [](glm::dvec2 at) {
                 return at.x > 100.0 && at.x < 125.0 && at.y > 60.0 && at.y < 64.0 ? 9.0 : 1.0;
             };
         }},
        {"a spot of polish that shines at the camera",
         {"Clipped in white"},
         Grade::usable,
         [](Room& room) {
             // Fewer than a thousandth of each channel's lit pixels, elsewhere for each of them
             room.bench.mixing = glm::dmat3(0.80, 0.0, 0.0, 0.0, 0.80, 0.0, 0.0, 0.0, 0.80);
             room.bench.tint = [](glm::dvec2 at) {
                 glm::dvec3 tint(1.0);
                 if (at.y > 60.0 && at.y < 63.0)
                     for (int c = 0; c < 3; ++c)
                         if (at.x > 60.0 + 40.0 * c && at.x < 68.0 + 40.0 * c) tint[c] = 3.0;
                 return tint;
             };
         }},
    };
    for (const Case& each : cases) {
        Room room;
        each.spoil(room);
        const Preflight result = room.run();
        auto named = each.figures;
        for (const std::string& name : named)
            EXPECT_EQ(figure(result, name).grade, each.grade)
                << each.what << ": " << figure(result, name).value;
        for (const GradedFigure& other : result.figures) {
            const bool meant = std::find(named.begin(), named.end(), other.name) != named.end();
            if (meant || other.name == "Size in the camera") continue;
            if (named[0] == "Flicker" && other.name == "Warm-up drift") continue;
            EXPECT_EQ(other.grade, Grade::good)
                << each.what << ": " << other.name << " " << other.value;
        }
    }
}

TEST(Preflight, FindsALampThatIsStillCold) {
    Room room;
    room.lamp = [](const Image8&, int k) { return 1.0 + 0.003 * k; };
    EXPECT_EQ(figure(room.run(), "Warm-up drift").grade, Grade::bad);
}

TEST(Preflight, FindsPicturesThatAreOutOfFocus) {
    for (const auto& [reach, grade] :
         {std::pair{0, Grade::good}, {2, Grade::usable}, {4, Grade::bad}}) {
        Room room;
        room.bench.gamma = glm::dvec3(1.0);  // so that mixed drives are mixed light
        room.on_its_way = [reach = reach](const Image8& drive) {
            Image8 blurred = drive;
            for (int y = 0; y < drive.height; ++y)
                for (int x = 0; x < drive.width; ++x)
                    for (int c = 0; c < 3; ++c) {
                        int sum = 0;
                        for (int k = -reach; k <= reach; ++k)
                            sum += drive.at(std::clamp(x + k, 0, drive.width - 1), y, c);
                        blurred.at(x, y, c) = static_cast<std::uint8_t>(sum / (2 * reach + 1));
                    }
            return blurred;
        };
        EXPECT_EQ(figure(room.run(), "Focus").grade, grade) << reach;
    }
}

TEST(Preflight, SaysWhyNothingCanBeMeasured) {
    Room cap;
    cap.lamp = [](const Image8&, int) { return 0.0; };
    const Preflight dark = cap.run();
    ASSERT_EQ(dark.figures.size(), 1u);
    EXPECT_EQ(dark.figures[0].grade, Grade::bad);
    EXPECT_HAS(dark.figures[0].meaning, "sees no light of the projector");

    BenchPorts folder;
    folder.turn_to = [](const std::string&) { return 1; };
    EXPECT_THROW(preflight(folder, {240, 150, {}}), std::invalid_argument);
    EXPECT_THROW(preflight({}, {240, 150, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
