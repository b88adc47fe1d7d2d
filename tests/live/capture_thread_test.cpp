#include "live/capture_thread.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/pictures/white_balance.h"
#include "live/capture_work.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "session/small_session.h"
#include "support/jpeg.h"
#include "support/kept_light.h"
#include "support/ptpip_camera.h"
#include "support/small_bench_file.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Doing = CaptureView::Doing;

/// A user's folder of the test's own.
class Home {
  public:
    Home() {
        if (const char* before = std::getenv("LIVERY_HOME")) before_ = before;
        ::setenv("LIVERY_HOME", folder_.path().c_str(), 1);
    }
    ~Home() { ::setenv("LIVERY_HOME", before_.c_str(), 1); }
    Home(const Home&) = delete;
    Home& operator=(const Home&) = delete;
    const TemporaryFolder& folder() const { return folder_; }

  private:
    TemporaryFolder folder_;
    std::string before_;
};

template <typename Done>
CaptureView wait_until(const CaptureThread& capture, const Done& done) {
    for (int k = 0; k < 60000; ++k) {
        const CaptureView view = capture.view();
        if (done(view)) return view;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ADD_FAILURE() << "it does not come: " << capture.view().stage << " " << capture.view().why;
    return capture.view();
}

bool rests(const CaptureView& view) { return view.doing == Doing::watching; }

struct CaptureRoom {
    Home home;
    HeadlessContext context{GlDevice::automatic};
    std::unique_ptr<CaptureThread> capture;
    CaptureSetup setup;

    CaptureRoom() {
        context.release();
        capture = std::make_unique<CaptureThread>(context, [] {});
        setup.camera = {"bench", testing::small_bench_file(home.folder().path()).string()};
        setup.product = find_product("car");
        capture->use(setup);
        wait_until(*capture, [](const CaptureView& view) { return view.live != nullptr; });
    }
};

TEST(CaptureThread, LooksAndCaptures) {
    CaptureRoom room;
    EXPECT_NE(room.capture->view().camera.find("bench small"), std::string::npos);
    room.capture->start(CaptureStep::look, false);
    const CaptureView looked = wait_until(*room.capture, [](const CaptureView& view) {
        return view.step(CaptureStep::look).figures.size() == 12 && rests(view);
    });
    EXPECT_TRUE(looked.why.empty()) << looked.why;
    room.capture->start(CaptureStep::colour, true);
    const CaptureView made = wait_until(*room.capture, [](const CaptureView& view) {
        return view.finished.has_value() || !view.why.empty();
    });
    ASSERT_TRUE(made.finished) << made.why;
    EXPECT_TRUE(std::filesystem::exists(*made.finished / "projector.json"));
    EXPECT_GT(made.taken, 50);
    EXPECT_GT(made.tiles.size(), 10u);
    for (const CaptureTile& tile : made.tiles) EXPECT_EQ(tile.of.empty(), tile.seen == nullptr);
    wait_until(*room.capture, rests);
    EXPECT_FALSE(room.capture->view().step(CaptureStep::colour).can_go_on) << "it is whole";

    EXPECT_TRUE(made.step(CaptureStep::geometry).done);
    EXPECT_EQ(made.step(CaptureStep::geometry).figures.size(), 3u);
    EXPECT_TRUE(made.step(CaptureStep::geometry).finding);
    EXPECT_FALSE(made.step(CaptureStep::check).done);

    // One picture again: nothing else is taken.
    const auto green = std::find_if(
        made.tiles.begin(), made.tiles.end(), [](const auto& tile) { return tile.of == "green"; });
    ASSERT_NE(green, made.tiles.end());
    room.capture->take_again(static_cast<std::size_t>(green - made.tiles.begin()));
    const CaptureView again = wait_until(*room.capture, [&](const CaptureView& view) {
        return (view.finished && view.finished != made.finished) || !view.why.empty();
    });
    ASSERT_TRUE(again.finished) << again.why;
    EXPECT_EQ(again.taken, 2);
    EXPECT_GT(again.kept_from_before, 25);
}

TEST(CaptureThread, EachCameraHasPhotographsOfItsOwn) {
    CaptureRoom room;
    const auto photograph_some = [&] {
        room.capture->start(CaptureStep::colour, false);
        const CaptureView view = wait_until(*room.capture, [](const CaptureView& now) {
            return now.taken >= 3 || !now.why.empty();
        });
        EXPECT_EQ(view.why, "");
        room.capture->cancel();
        wait_until(*room.capture, rests);
    };
    photograph_some();
    EXPECT_TRUE(room.capture->view().step(CaptureStep::geometry).can_go_on);
    CaptureSetup other = room.setup;
    const auto file = room.home.folder() / "other.json";
    Json bench = read_json_file(room.setup.camera.what);
    bench["name"] = "other";
    write_json_file(file, bench);
    other.camera.what = file.string();
    room.capture->use(other);
    wait_until(*room.capture, [](const CaptureView& view) {
        return view.camera.find("other") != std::string::npos && rests(view);
    });
    EXPECT_FALSE(room.capture->view().step(CaptureStep::geometry).can_go_on);
    photograph_some();
    // What the first has stands
    room.capture->use(room.setup);
    wait_until(*room.capture, [](const CaptureView& view) {
        return view.camera.find("small") != std::string::npos && rests(view) &&
               view.step(CaptureStep::geometry).can_go_on;
    });
}

TEST(CaptureThread, ChecksWhatItMadeAndSeesThatNothingMoved) {
    CaptureRoom room;
    room.capture->start(CaptureStep::colour, true);
    const CaptureView made = wait_until(*room.capture, [](const CaptureView& view) {
        return view.finished.has_value() || !view.why.empty();
    });
    ASSERT_TRUE(made.finished) << made.why;
    CaptureSetup setup = room.setup;
    setup.in_use = *made.finished;
    room.capture->use(setup);
    room.capture->start(CaptureStep::check, false);
    const CaptureView checked = wait_until(*room.capture, [](const CaptureView& view) {
        return (view.step(CaptureStep::check).done && rests(view)) || !view.why.empty();
    });
    ASSERT_TRUE(checked.why.empty()) << checked.why;
    for (const GradedFigure& figure : checked.step(CaptureStep::check).figures)
        EXPECT_NE(figure.grade, Grade::bad) << figure.name << " " << figure.value;
    // Against itself
    ASSERT_FALSE(checked.compared.empty());
    EXPECT_EQ(checked.compared[1].value, "0.00 / 0.00 px");
    for (const GradedFigure& figure : checked.compared)
        EXPECT_EQ(figure.grade, Grade::good) << figure.name << " " << figure.value;

    room.capture->look_for_drift(*made.finished);
    const CaptureView drift = wait_until(*room.capture, [](const CaptureView& view) {
        return (!view.drift.empty() && rests(view)) || !view.why.empty();
    });
    ASSERT_TRUE(drift.why.empty()) << drift.why;
    for (const GradedFigure& figure : drift.drift)
        EXPECT_EQ(figure.grade, Grade::good) << figure.name << " " << figure.value;
}

/// The bench's mock-up shifted; all else stays. The bench's frame is the mock-up's.
void bump(const std::filesystem::path& bench_file, const glm::dvec3& shift_mm) {
    Json bench = read_json_file(bench_file);
    const auto shift = [&](Json& point) {
        for (int k = 0; k < 3; ++k) {
            Json& value = point[static_cast<std::size_t>(k)];
            value = value.get<double>() - shift_mm[k];
        }
    };
    for (const char* view : {"projector", "camera"})
        for (const char* point : {"from_mm", "at_mm"}) shift(bench[view][point]);
    for (auto& surface : bench["surroundings"]) shift(surface["corner_mm"]);
    shift(bench["eye_mm"]);
    write_json_file(bench_file, bench);
}

TEST(CaptureThread, FindsABumpedMockupAgain) {
    CaptureRoom room;
    room.capture->start(CaptureStep::colour, true);
    const CaptureView made = wait_until(*room.capture, [](const CaptureView& view) {
        return view.finished.has_value() || !view.why.empty();
    });
    ASSERT_TRUE(made.finished) << made.why;
    wait_until(*room.capture, rests);
    const View before = read_camera_file(*made.finished / "projector.json");

    room.capture->close();
    wait_until(*room.capture, [](const CaptureView& view) { return view.camera.empty(); });
    const glm::dvec3 shift_mm(3.0, 0.0, 2.0);
    bump(room.setup.camera.what, shift_mm);
    room.capture->use(room.setup);
    wait_until(*room.capture, [](const CaptureView& view) { return view.live != nullptr; });
    room.capture->find_mockup_again(*made.finished);
    const CaptureView found = wait_until(*room.capture, [](const CaptureView& view) {
        return (view.reposed && rests(view)) || !view.why.empty();
    });
    ASSERT_TRUE(found.reposed) << found.why;
    EXPECT_FALSE(found.found_again.empty());
    EXPECT_EQ(kept_calibrations().front(), *found.reposed);
    // The mock-up's middle is where it was pushed to, seen from the projector.
    const View now = read_camera_file(*found.reposed / "projector.json");
    const Bounds bounds = bounds_of(room.setup.product->mesh);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const glm::dvec3 moved_mm =
        inverse(before.view_from_world) * (now.view_from_world * middle) - middle;
    EXPECT_LT(glm::distance(moved_mm, shift_mm), 0.5)
        << moved_mm.x << " " << moved_mm.y << " " << moved_mm.z;

    // Without a calibration there is nothing to carry along.
    room.capture->find_mockup_again("");
    const CaptureView refused =
        wait_until(*room.capture, [](const CaptureView& view) { return !view.why.empty(); });
    EXPECT_NE(refused.why.find("where everything stood"), std::string::npos) << refused.why;
}

TEST(CaptureThread, NightlyGoesOnAfterItWasStoppedAndPauses) {
    CaptureRoom room;
    room.capture->start(CaptureStep::colour, true);
    wait_until(*room.capture, [](const CaptureView& view) { return view.taken > 20; });
    room.capture->set_paused(true);
    std::this_thread::sleep_for(std::chrono::seconds(2));  // longer than the rest would take
    EXPECT_FALSE(room.capture->view().finished);
    EXPECT_EQ(room.capture->view().doing, Doing::capturing);
    room.capture->cancel();
    wait_until(*room.capture, rests);
    const int taken = room.capture->view().taken;
    EXPECT_TRUE(room.capture->view().step(CaptureStep::geometry).can_go_on);
    EXPECT_TRUE(room.capture->view().why.empty()) << "a stop is no failure";
    room.capture->set_paused(false);
    room.capture->start(CaptureStep::colour, false);
    const CaptureView made = wait_until(*room.capture, [](const CaptureView& view) {
        return view.finished.has_value() || !view.why.empty();
    });
    ASSERT_TRUE(made.finished) << made.why;
    EXPECT_EQ(made.kept_from_before, taken);
}

/// Light from nothing to full across the picture, through a curve that is not sRGB.
testing::PtpPicture ramp_in_jpeg(const testing::PtpSettings& settings) {
    Image8 picture(256, 64, 3);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const double light = std::min(1.0, x / 8 / 32.0 * settings.exposure_s / 0.25);
                picture.at(x, y, c) =
                    static_cast<std::uint8_t>(255.0 * std::pow(light, 1.0 / 1.8) + 0.5);
            }
    return {"IMG_0001.JPG", testing::jpeg_of(picture)};
}

TEST(CaptureThread, SetsACameraAndFitsItsCurve) {
    Home home;
    ::setenv("HOME", home.folder().path().c_str(), 1);  // libgphoto2 writes there
    testing::PtpIpCamera responder(ramp_in_jpeg);
    HeadlessContext context{GlDevice::automatic};
    context.release();
    CaptureThread capture(context, [] {});
    int shown = 0;
    CaptureSetup setup;
    setup.camera = {"tethered", responder.port()};
    setup.width = setup.height = 16;
    setup.projector_port = [&](const Progress&, const TellWait&) {
        return [&](const Image8&) { ++shown; };
    };
    capture.use(setup);
    const CaptureView opened = wait_until(capture, rests);
    EXPECT_TRUE(opened.may_have_curve);
    EXPECT_TRUE(opened.curve.empty());
    const auto iso = [](const CaptureView& view) {
        for (const CameraSetting& setting : view.settings)
            if (setting.name == "iso") return setting.value;
        return std::string();
    };
    capture.set("iso", "400");
    wait_until(capture, [&](const CaptureView& view) { return iso(view) == "400"; });
    capture.set("iso", "123");
    wait_until(capture, [](const CaptureView& view) { return !view.why.empty(); });
    EXPECT_EQ(responder.settings().iso, 400);

    capture.start_curve_fit();
    const CaptureView fitted = wait_until(capture, [](const CaptureView& view) {
        return rests(view) && (!view.curve.empty() || view.why.find("iso") == std::string::npos);
    });
    EXPECT_FALSE(fitted.curve.empty()) << fitted.why;
    EXPECT_EQ(shown, 1);
    // A camera that is opened again has it.
    capture.use(setup);
    wait_until(capture, [](const CaptureView& view) {
        return rests(view) && view.curve.find(user_folder() / "cameras") != std::string::npos;
    });
}

/// Somebody with a camera that is on no cable: shoots what is shown, copies the files.
class Photographer {
  public:
    explicit Photographer(std::filesystem::path card)
        : card_(std::move(card)),
          bench_(testing::bench_on_kept_light(testing::small_bench_description(),
                                              testing::small_bench_product())),
          ports_(bench_.ports()) {}

    ShowPicture port() {
        return [this](const Image8& drive) { ports_.show(drive); };
    }
    /// Until the capture waits for no more pictures; all of them but `forgotten`.
    void shoot(CaptureThread& capture, const std::string& forgotten) {
        std::string last;
        wait_until(capture, [](const CaptureView& v) { return v.waits_for_next; });
        for (;;) {
            const CaptureView view = wait_until(capture, [&](const CaptureView& v) {
                return (v.waits_for_next && v.stage.starts_with("shoot") && v.stage != last) ||
                       (!v.waits_for_next && v.stage.find("photographs") != std::string::npos) ||
                       v.finished || !v.why.empty();
            });
            if (!view.waits_for_next) return;
            last = view.stage;
            ++shown_;
            if (!last.ends_with(": " + forgotten)) take();
            capture.next();
        }
    }
    int shown() const { return shown_; }

  private:
    void take() {
        const Photograph photograph = ports_.photograph(bench_.default_exposure_s());
        Image16 picture(photograph.image.width, photograph.image.height, 3);
        for (std::size_t k = 0; k < picture.values.size(); ++k)
            picture.values[k] = static_cast<std::uint16_t>(
                std::max(0.0f, 4.0f * (photograph.image.values[k] - 1024.0f)));
        write_png(card_ / fmt::format("IMG_{:04}.png", ++files_), picture);
    }

    std::filesystem::path card_;
    Bench bench_;
    BenchPorts ports_;
    int shown_ = 0, files_ = 0;
};

TEST(CaptureThread, CompletesAFolderOfPhotographs) {
    Home home;
    HeadlessContext context{GlDevice::automatic};
    context.release();
    CaptureThread capture(context, [] {});
    const auto card = home.folder() / "card";
    std::filesystem::create_directories(card);
    Photographer photographer(card);
    CaptureSetup setup;
    setup.camera = {"folder", card.string()};
    setup.product = testing::small_bench_product();
    setup.projector_view = testing::small_bench_description().projector.view;
    setup.projector = "a projector";
    setup.width = setup.projector_view->width;
    setup.height = setup.projector_view->height;
    setup.projector_port = [&](const Progress&, const TellWait&) { return photographer.port(); };
    capture.use(setup);
    // No camera to look through, nothing but the colours to begin with
    const CaptureView view = wait_until(
        capture, [](const CaptureView& v) { return !v.step(CaptureStep::look).called_for; });
    EXPECT_FALSE(view.step(CaptureStep::geometry).called_for);
    EXPECT_TRUE(view.step(CaptureStep::colour).called_for);
    EXPECT_FALSE(view.step(CaptureStep::check).called_for);

    capture.start(CaptureStep::colour, false);
    photographer.shoot(capture, "gray-row-1");
    const CaptureView waiting = wait_until(capture, [](const CaptureView& v) {
        // Or its inverse: nobody can tell which of the two is there
        return v.stage.find("missing: gray-row-1") != std::string::npos || !v.why.empty();
    });
    EXPECT_EQ(waiting.why, "");
    const int all = photographer.shown();
    capture.cancel();
    wait_until(capture, [](const CaptureView& v) { return v.doing == Doing::nothing; });

    // Later: what is missing is shown, and its photographs come last
    capture.start(CaptureStep::colour, false);
    photographer.shoot(capture, "");
    const CaptureView made = wait_until(
        capture, [](const CaptureView& v) { return v.finished.has_value() || !v.why.empty(); });
    ASSERT_TRUE(made.finished) << made.why;
    EXPECT_EQ(photographer.shown(), all + 2) << "the forgotten one and its inverse";
    EXPECT_EQ(made.found_before,
              fmt::format("{} of the {} photographs were there before and are used", all - 1, all));
}

TEST(CaptureThread, SaysWhyACameraDoesNotOpen) {
    Home home;
    HeadlessContext context{GlDevice::automatic};
    context.release();
    CaptureThread capture(context, [] {});
    CaptureSetup setup;
    setup.camera = {"video", (home.folder() / "none.avi").string()};
    capture.use(setup);
    const CaptureView view = wait_until(capture, [](const auto& v) { return !v.why.empty(); });
    EXPECT_NE(view.why.find("none.avi"), std::string::npos);
    EXPECT_FALSE(view.fix.empty());
    EXPECT_EQ(view.doing, Doing::nothing);
}

// A camera's own numbers are mostly green: white is shown white, and grey grey.
TEST(CapturePictures, AreBalancedByWhite) {
    Photograph white;
    white.image = ImageF(80, 40, 3, 100.0f);
    white.black_level = 100.0;
    white.saturates_at = 1100.0;
    for (int y = 10; y < 30; ++y)
        for (int x = 20; x < 60; ++x) {
            white.image.at(x, y, 0) += 400.0f;
            white.image.at(x, y, 1) += 800.0f;
            white.image.at(x, y, 2) += 500.0f;
        }
    const glm::dvec3 balance = white_balance(white);
    EXPECT_NEAR(balance.x, 2.0, 1e-6);
    EXPECT_EQ(balance.y, 1.0);
    EXPECT_NEAR(balance.z, 1.6, 1e-6);
    const Image8 small = small_photograph(white, 80, balance);
    EXPECT_EQ(small.at(40, 20, 0), small.at(40, 20, 1));
    EXPECT_EQ(small.at(40, 20, 2), small.at(40, 20, 1));
    Photograph nothing = white;
    for (float& value : nothing.image.values) value = 100.0f;
    EXPECT_EQ(white_balance(nothing), glm::dvec3(1.0));
}

TEST(CapturePictures, AreSmallAndTrue) {
    Photograph photograph;
    photograph.image = ImageF(100, 60, 3, 1000.0f + 900.0f);
    photograph.black_level = 1000.0;
    photograph.saturates_at = 2000.0;
    const Image8 small = small_photograph(photograph, 30);
    EXPECT_EQ(small.width, 25);
    EXPECT_EQ(small.height, 15);
    EXPECT_EQ(small.at(3, 3, 1), 255) << "white at nine tenths of full scale";
    const CaptureHistogram histogram = histogram_of(photograph);
    EXPECT_EQ(histogram.share[57], 1.0f);
    EXPECT_EQ(histogram.clipped, 0.0);
    for (float& value : photograph.image.values) value = 1990.0f;
    EXPECT_EQ(histogram_of(photograph).clipped, 1.0);
    EXPECT_EQ(small_picture(Image8(90, 30, 3, 7), 30).at(2, 2, 0), 7);
    EXPECT_EQ(histogram_of(Image8(9, 9, 3, 255)).clipped, 1.0);
    // Nothing but black
    EXPECT_EQ(histogram_of(Image8(9, 9, 3)).share[0], 1.0f);
}

}  // namespace
}  // namespace livery
