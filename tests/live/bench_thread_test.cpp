#include "live/bench_thread.h"

#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "live/contexts.h"
#include "live/orbit.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "support/kept_light.h"
#include "support/temporary_folder.h"
#include "twin/bench.h"
#include "twin/place.h"

namespace livery {
namespace {

/// The default bench with a sixteenth of its pixels: set up and calibrated in a second.
constexpr const char* kSmallBench = R"({
  "format_version": 1, "name": "small", "base": "default.json", "product": "assets/car.json",
  "projector": {"width": 320, "height": 200, "matrix": [882.5, 0, 160.3, 0, 882.5, 190.7, 0, 0, 1],
                "at_px": [160, 101]},
  "camera": {"width": 432, "height": 288, "matrix": [1225, 0, 216.7, 0, 1225, 143.3, 0, 0, 1],
             "at_px": [216, 145]}
})";

constexpr glm::dvec3 kEye_mm{281.0, 425.0, 696.0};

class OnTheBench : public ::testing::Test {
  protected:
    OnTheBench() {
        const char* before = std::getenv("LIVERY_HOME");
        before_ = before ? before : "";
        ::setenv("LIVERY_HOME", (folder_ / "home").c_str(), 1);
        bench_ = folder_.write("small.json", kSmallBench).string();
        car_ = find_product("car");
    }
    ~OnTheBench() override {
        if (before_.empty()) {
            ::unsetenv("LIVERY_HOME");
        } else {
            ::setenv("LIVERY_HOME", before_.c_str(), 1);
        }
    }

    TemporaryFolder folder_;
    std::string bench_;
    std::shared_ptr<const Product> car_;

  private:
    std::string before_;
};

std::shared_ptr<const Image8> drive_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    auto drive = std::make_shared<Image8>(320, 200, 3);
    for (std::size_t i = 0; i < drive->pixel_count(); ++i) {
        drive->values[3 * i] = red;
        drive->values[3 * i + 1] = green;
        drive->values[3 * i + 2] = blue;
    }
    return drive;
}

glm::dvec3 mean_of(const Image8& picture) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        sum[static_cast<int>(i % 3)] += picture.values[i];
    }
    return sum / static_cast<double>(picture.pixel_count());
}

/// A bench thread, and its answers as they come.
struct Watched {
    testing::Finished<std::shared_ptr<const BenchPhotograph>> photographs;
    testing::Finished<BenchThread::Calibrating> calibrations;
    std::unique_ptr<BenchThread> thread;
    std::atomic<BenchThread*> ready{nullptr};

    Watched() {
        thread = std::make_unique<BenchThread>([this] {
            BenchThread* it = ready;
            if (const auto newest = it->newest_photograph()) photographs.add(newest);
            calibrations.add(it->calibrating());
        });
        ready = thread.get();
    }
    std::shared_ptr<const BenchPhotograph> photograph(std::uint64_t number,
                                                      std::shared_ptr<const Image8> drive,
                                                      double white_y = 0.5) {
        thread->photograph(number, std::move(drive), kEye_mm, white_y);
        return photographs.wait_for([&](const auto& p) { return p && p->number == number; });
    }
    BenchThread::Calibrating end_of_calibration() {
        return calibrations.wait_for([](const auto& c) { return !c.running; });
    }
};

TEST_F(OnTheBench, PhotographsWhatTheProjectorShows) {
    Watched watched;
    watched.thread->use(bench_, car_);
    const auto white = watched.photograph(1, drive_of(255, 255, 255));
    const auto black = watched.photograph(2, drive_of(0, 0, 0));
    const auto red = watched.photograph(3, drive_of(255, 0, 0));
    ASSERT_TRUE(white && black && red);
    for (const auto& photograph : {white, black, red}) {
        EXPECT_EQ(photograph->problem, "");
        EXPECT_GT(photograph->seconds, 0.0);
        EXPECT_EQ(photograph->srgb.channels, 3);
        // Cropped to the car, the same way each time
        EXPECT_EQ(photograph->srgb.width, white->srgb.width);
        EXPECT_EQ(photograph->srgb.height, white->srgb.height);
        EXPECT_LT(photograph->srgb.width, 432);
        EXPECT_GT(photograph->srgb.width, 150);
        EXPECT_LT(photograph->srgb.height, 250);
    }
    EXPECT_LT(mean_of(black->srgb).y, 10.0);
    EXPECT_GT(mean_of(white->srgb).y, 60.0);
    // The mock-up is nearly neutral, and so is the lamp's white but for its greenish tint
    const glm::dvec3 neutral = mean_of(white->srgb);
    EXPECT_NEAR(neutral.x / neutral.y, 1.0, 0.25);
    EXPECT_NEAR(neutral.z / neutral.y, 1.0, 0.25);
    EXPECT_GT(mean_of(red->srgb).x, 3.0 * mean_of(red->srgb).z);
    EXPECT_EQ(watched.thread->newest_photograph()->number, 3u);
    // By its own brightest, and by half of the light as white
    const auto own = watched.photograph(4, drive_of(80, 80, 80), 0.0);
    const auto bright = watched.photograph(5, drive_of(80, 80, 80), 0.02);
    EXPECT_GT(mean_of(own->srgb).y, 40.0);
    EXPECT_GT(mean_of(bright->srgb).y, mean_of(black->srgb).y + 40.0);
}

TEST_F(OnTheBench, NightlyPhotographsFromTheEyeAndCalibratesWithItsOwnCamera) {
    Watched watched;
    watched.thread->use(bench_, car_);
    const auto photograph_from = [&](std::uint64_t number, const glm::dvec3& eye_mm) {
        watched.thread->photograph(number, drive_of(255, 255, 255), eye_mm, 0.5);
        return watched.photographs.wait_for([&](const auto& one) { return one->number == number; });
    };
    std::uint64_t number = 0;
    for (const glm::dvec3 eye_mm : {kEye_mm, glm::dvec3(450, 251, 327), glm::dvec3(0, 900, 60)}) {
        const auto photograph = photograph_from(++number, eye_mm);
        ASSERT_TRUE(photograph);
        EXPECT_EQ(photograph->problem, "");
        // What the stage's eye view shows: the same corners of the car.
        const View view = eye_view(eye_mm, bounds_of(car_->mesh), 432, 288);
        const PixelRectangle whole = pixels_that_see(view, car_->mesh, 12);
        EXPECT_EQ(photograph->srgb.width, whole.right - whole.left);
        EXPECT_EQ(photograph->srgb.height, whole.bottom - whole.top);
    }
    watched.thread->start_calibration();
    EXPECT_EQ(watched.calibrations
                  .wait_for([](const auto& c) { return c.finished || !c.refused_why.empty(); })
                  .refused_why,
              "");
}

TEST_F(OnTheBench, ThePhotographIsTheObserversTruthForNeutralSurfaces) {
    // Absolute scale and colour: the camera's matrix against the bench's own observer, over the
    // same light (a wide average: the two see the car from different sides).
    BenchDescription description = read_bench_file(bench_);
    description.camera.view = description.projector.view;  // the same side
    description.eye_mm = centre_in_world(description.projector.view);
    Bench bench = testing::bench_on_kept_light(description, car_);
    const auto drive = drive_of(200, 120, 60);
    bench.ports().show(*drive);
    const ImageF photographed =
        developed(bench.ports().photograph(0.0), xyz_from_bench_camera(description));
    const ImageF observed = bench.observe_xyz(*drive);
    glm::dvec3 a(0.0), b(0.0);
    for (std::size_t i = 0; i < observed.values.size(); ++i) {
        a[static_cast<int>(i % 3)] += photographed.values[i];
        b[static_cast<int>(i % 3)] += observed.values[i];
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1.0, 0.02);
}

TEST_F(OnTheBench, SaysWhyThereIsNoPhotograph) {
    Watched watched;
    EXPECT_FALSE(watched.thread->newest_photograph());
    EXPECT_THROW(watched.thread->photograph(1, drive_of(1, 1, 1), kEye_mm, 0.0),
                 std::invalid_argument);
    EXPECT_THROW(watched.thread->start_calibration(), std::invalid_argument);
    EXPECT_THROW(watched.thread->use(bench_, nullptr), std::invalid_argument);

    watched.thread->use("no such bench", car_);
    EXPECT_THROW(watched.thread->photograph(1, nullptr, kEye_mm, 0.0), std::invalid_argument);
    const auto none = watched.photograph(1, drive_of(9, 9, 9));
    ASSERT_TRUE(none);
    EXPECT_NE(none->problem.find("no such bench"), std::string::npos) << none->problem;
    EXPECT_TRUE(none->srgb.empty());

    watched.thread->use(bench_, car_);
    const auto good = watched.photograph(2, drive_of(255, 255, 255));
    ASSERT_TRUE(good);
    EXPECT_EQ(good->problem, "");
    const auto wrong = watched.photograph(3, std::make_shared<const Image8>(64, 64, 3));
    ASSERT_TRUE(wrong);
    EXPECT_NE(wrong->problem.find("64"), std::string::npos) << wrong->problem;
    EXPECT_EQ(wrong->srgb.values, good->srgb.values);
}

TEST_F(OnTheBench, TheNewestOfManyIsPhotographed) {
    Watched watched;
    watched.thread->use(bench_, car_);
    for (std::uint64_t number = 1; number < 50; ++number) {
        watched.thread->photograph(number, drive_of(100, 100, 100), kEye_mm, 0.5);
    }
    ASSERT_TRUE(watched.photograph(50, drive_of(100, 100, 100)));
    EXPECT_LT(watched.photographs.all().size(), 50u);
}

TEST_F(OnTheBench, CalibratesAndTellsHowFarItIs) {
    Watched watched;
    watched.thread->use(bench_, car_);
    EXPECT_FALSE(watched.thread->calibrating().running);
    watched.thread->start_calibration();
    EXPECT_TRUE(watched.thread->calibrating().running);
    watched.thread->start_calibration();  // once is enough
    const BenchThread::Calibrating done = watched.end_of_calibration();
    EXPECT_EQ(done.refused_why, "");
    ASSERT_TRUE(done.finished);
    EXPECT_TRUE(std::filesystem::exists(*done.finished / "calibration.json"));
    // A new session of this product on this bench finds it; no other does.
    const auto kept = [&](const Product& product) {
        return kept_calibration_of(bench_key(bench_, product));
    };
    EXPECT_EQ(kept(*car_), done.finished);
    Product other = *car_;
    other.mesh.positions_mm[0].x += 0.5f;
    EXPECT_EQ(kept(other), std::nullopt);
    std::string brighter = kSmallBench;
    brighter.replace(brighter.find("small"), 5, "other");
    folder_.write("small.json", brighter);
    EXPECT_EQ(kept(*car_), std::nullopt) << "the bench is another one";
    std::set<std::string> stages;
    for (const auto& step : watched.calibrations.all()) {
        if (step.running) stages.insert(step.stage);
        EXPECT_GE(step.fraction, 0.0);
        EXPECT_LE(step.fraction, 1.0);
    }
    EXPECT_GE(stages.size(), 3u);
    // The bench serves on
    const auto after = watched.photograph(9, drive_of(255, 255, 255));
    ASSERT_TRUE(after);
    EXPECT_EQ(after->problem, "");
}

TEST_F(OnTheBench, ARefusalSaysWhyAndWhatToDo) {
    std::string curved = kSmallBench;
    curved.insert(curved.find("\"at_px\": [216"), "\"encoding\": \"srgb8\", ");
    Watched watched;
    watched.thread->use(folder_.write("curved.json", curved).string(), car_);
    watched.thread->start_calibration();
    const BenchThread::Calibrating refused = watched.end_of_calibration();
    EXPECT_FALSE(refused.finished);
    EXPECT_NE(refused.refused_why, "");
    EXPECT_NE(refused.refused_fix, "");
    // Its photographs can still be looked at
    const auto photograph = watched.photograph(1, drive_of(255, 255, 255));
    ASSERT_TRUE(photograph);
    EXPECT_GT(mean_of(photograph->srgb).y, 60.0);
}

// The panel prints these words.
TEST_F(OnTheBench, AMishapIsToldByCauseAndPicture) {
    struct Case {
        const char *mishap, *why, *fix;
    };
    const Case cases[] = {
        {R"({"what": "automatic-exposure", "size": 0.18})", "automatic exposure", "by hand"},
        {R"({"what": "camera-moved", "from": 40, "size": 2})",
         "camera, projector or mock-up moved: from gray-row-",
         "fix all three firmly"},
        {R"({"what": "room-light", "from": 40, "size": 0.1})",
         "the room's light changed before gray-row-",
         "leave the room's light as it is"},
    };
    for (const Case& one : cases) {
        std::string bench = kSmallBench;
        bench.insert(bench.find("\"projector\""),
                     "\"mishaps\": [" + std::string(one.mishap) + "], ");
        Watched watched;
        watched.thread->use(folder_.write("mishap.json", bench).string(), car_);
        watched.thread->start_calibration();
        const BenchThread::Calibrating refused = watched.end_of_calibration();
        EXPECT_FALSE(refused.finished);
        EXPECT_NE(refused.refused_why.find(one.why), std::string::npos) << refused.refused_why;
        EXPECT_NE(refused.refused_fix.find(one.fix), std::string::npos) << refused.refused_fix;
    }
}

TEST_F(OnTheBench, AMissingBenchEndsTheCalibrationWithAReason) {
    Watched watched;
    watched.thread->use((folder_ / "gone.json").string(), car_);
    watched.thread->start_calibration();
    const BenchThread::Calibrating refused = watched.end_of_calibration();
    EXPECT_FALSE(refused.finished);
    EXPECT_NE(refused.refused_why.find("gone.json"), std::string::npos) << refused.refused_why;
    EXPECT_NE(refused.refused_fix, "");
}

TEST_F(OnTheBench, CanBeCancelledAtAnyMoment) {
    for (const int ms : {0, 1, 30, 150, 400, 700}) {
        Watched watched;
        watched.thread->use(bench_, car_);
        watched.thread->start_calibration();
        std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        watched.thread->cancel_calibration();
        for (int wait = 0; watched.thread->calibrating().running && wait < 6000; ++wait) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        const BenchThread::Calibrating state = watched.thread->calibrating();
        EXPECT_FALSE(state.running);
        EXPECT_EQ(state.refused_why, "");
        if (!state.finished) continue;
        EXPECT_TRUE(std::filesystem::exists(*state.finished / "calibration.json"));
    }
}

TEST_F(OnTheBench, AnotherBenchEndsTheCalibration) {
    Watched watched;
    watched.thread->use(bench_, car_);
    watched.thread->start_calibration();
    watched.calibrations.wait_for([](const auto& c) { return c.running; });
    watched.thread->use(folder_.write("other.json", kSmallBench).string(), car_);
    const BenchThread::Calibrating state = watched.end_of_calibration();
    EXPECT_FALSE(state.running);
    EXPECT_FALSE(state.finished);
    EXPECT_EQ(state.refused_why, "");
    EXPECT_EQ(watched.photograph(1, drive_of(255, 255, 255))->problem, "");
}

TEST_F(OnTheBench, EndsAtAnyMoment) {
    for (const int ms : {0, 5, 60, 300, 600}) {
        Watched watched;
        watched.thread->use(bench_, car_);
        watched.thread->photograph(1, drive_of(255, 255, 255), kEye_mm, 0.5);
        if (ms % 2 == 0) watched.thread->start_calibration();
        std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        watched.thread.reset();
        const std::size_t calls = watched.calibrations.all().size();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_EQ(watched.calibrations.all().size(), calls) << "called back after its end";
    }
}

}  // namespace
}  // namespace livery
