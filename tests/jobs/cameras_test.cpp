// Whole calibrations through cameras as they are: over the network, with the simulated bench in
// front of their lenses.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include <gtest/gtest.h>

#include "capture/camera.h"
#include "capture/tethered_camera.h"
#include "capture/video_camera.h"
#include "core/random.h"
#include "jobs/capture_bench.h"
#include "jobs/captured_calibration.h"
#include "session/small_session.h"
#include "support/bad_disk.h"
#include "support/dng.h"
#include "support/jpeg.h"
#include "support/kept_light.h"
#include "support/message_of.h"
#include "support/mjpeg_server.h"
#include "support/ptpip_camera.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

using testing::judged;
using testing::live_settings;
using testing::MjpegServer;
using testing::Refusal;
using testing::refusal_of;
using testing::small_bench_description;
using testing::small_bench_product;

/// A network camera in front of the bench: a new picture whenever another drive is shown.
class FilmedBench {
  public:
    explicit FilmedBench(const BenchDescription& description)
        : bench(testing::bench_on_kept_light(description, small_bench_product())),
          ports_(bench.ports()) {
        show(Image8(description.projector.view.width, description.projector.view.height, 3));
    }
    void show(const Image8& drive) {
        ports_.show(drive);
        // Two photographs, so that successive frames differ in their noise
        std::string jpegs[] = {jpeg(), jpeg()};
        const std::lock_guard lock(mutex_);
        std::swap(jpegs_, jpegs);
    }
    std::string frame() {
        const std::lock_guard lock(mutex_);
        return jpegs_[frames_++ % 2];
    }
    MeasureXyz colorimeter() { return ports_.measure_xyz; }

    Bench bench;

  private:
    std::string jpeg() {
        const Photograph photograph = ports_.photograph(bench.default_exposure_s());
        Image8 rgb(photograph.image.width, photograph.image.height, 3);
        for (std::size_t k = 0; k < rgb.values.size(); ++k)
            rgb.values[k] = static_cast<std::uint8_t>(photograph.image.values[k] + 0.5f);
        return testing::jpeg_of(rgb);
    }

    BenchPorts ports_;
    std::mutex mutex_;
    std::string jpegs_[2];
    int frames_ = 0;
};

BenchDescription filmed_description() {
    BenchDescription description = small_bench_description();
    description.camera.encoding = CameraEncoding::srgb8;
    description.camera.black_level_units = 0.0;
    return description;
}

/// What the camera and the projector do not take is ours.
void print_times(const Recording& recording, const CalibrationResult& live) {
    const auto& [all, camera, projector] = live.captured;
    std::printf(
        "    %d photographs: %.1f s in the camera, %.1f s in the projector, %.1f s in all: "
        "%.1f%% more\n",
        recording.taken(),
        camera,
        projector,
        all,
        100.0 * (all / (camera + projector) - 1.0));
}

TEST(Cameras, NightlyAVideoCameraCalibratesAsTheBenchDoes) {
    const BenchDescription description = filmed_description();
    FilmedBench filmed(description);
    MjpegServer server([&] { return filmed.frame(); }, 60.0);
    VideoCameraOptions video;
    video.source = server.address();
    const auto camera = open_video_camera(video);

    BenchPorts ports;
    ports.show = [&](const Image8& drive) { filmed.show(drive); };
    ports.photograph = [&](double exposure_s) { return camera->photograph(exposure_s); };
    ports.measure_xyz = filmed.colorimeter();
    const TemporaryFolder folder;
    Recording recording(folder.path(), "the bench, filmed");
    CalibrationResult live =
        calibrate_through_ports(ports, live_settings(description), {}, &recording);
    print_times(recording, live);
    EXPECT_GT(live.calibration.valid_fraction, 0.85);
    const Comparison& seen = judged(filmed.bench, std::move(live)).comparison;

    Bench direct = testing::bench_on_kept_light(small_bench_description(), small_bench_product());
    const Comparison& best =
        judged(direct, calibrate_live(direct.ports(), live_settings(description))).comparison;
    // Eight bits against fourteen: a step at a tenth of white is 3% of it, of which the noise of
    // frames and neighbours leaves a third.
    EXPECT_LT(seen.interior.median, best.interior.median + 0.5);

    // The recording is a captures folder as any other; its colours are then the camera's own.
    const ColourCalibration again = calibrate_from_folder({folder.path(), {}, {}});
    EXPECT_GT(again.valid_fraction, 0.85);
}

TEST(Cameras, ATetheredCameraCalibratesAsTheBenchDoes) {
    const TemporaryFolder home;
    ::setenv("HOME", home.path().c_str(), 1);  // libgphoto2 writes there
    const BenchDescription description = small_bench_description();
    Bench bench = testing::bench_on_kept_light(description, small_bench_product());
    const BenchPorts on_bench = bench.ports();
    on_bench.show(Image8(description.projector.view.width, description.projector.view.height, 3));
    std::mutex mutex;
    testing::PtpIpCamera responder([&](const testing::PtpSettings& settings) {
        const std::lock_guard lock(mutex);
        const Photograph seen = on_bench.photograph(settings.exposure_s);
        return testing::PtpPicture{"IMG_0001.DNG", testing::dng_of(seen)};
    });
    TetheredOptions options;
    options.port = responder.port();
    const auto camera = open_tethered_camera(options);
    BenchPorts ports;
    ports.show = [&](const Image8& drive) {
        const std::lock_guard lock(mutex);
        on_bench.show(drive);
    };
    ports.photograph = [&](double exposure_s) { return camera->photograph(exposure_s); };
    ports.measure_xyz = on_bench.measure_xyz;
    const TemporaryFolder folder;
    Recording recording(folder.path(), "the bench, tethered");
    CalibrationResult live =
        calibrate_through_ports(ports, live_settings(description), {}, &recording);
    print_times(recording, live);
    const Comparison& seen = judged(bench, std::move(live)).comparison;
    Bench direct = testing::bench_on_kept_light(description, small_bench_product());
    const Comparison& best =
        judged(direct, calibrate_live(direct.ports(), live_settings(description))).comparison;
    // The same numbers but for the nearest shutter speed and rounding: the camera's noise.
    EXPECT_LT(seen.interior.median, best.interior.median + 0.05);
    EXPECT_EQ(responder.on_card(), 0u);
}

TEST(Cameras, ACameraThatGivesOnlyJpegShowsItsCurve) {
    const TemporaryFolder home;
    ::setenv("HOME", home.path().c_str(), 1);  // libgphoto2 writes there
    ::setenv("LIVERY_HOME", home.path().c_str(), 1);
    const BenchDescription description = small_bench_description();
    Bench bench = testing::bench_on_kept_light(description, small_bench_product());
    const BenchPorts on_bench = bench.ports();
    std::mutex mutex;
    // A picture style of its own, that is not sRGB
    const auto styled = [](double linear) {
        const double y = std::pow(linear, 1.0 / 1.9);
        return 0.8 * y + 0.2 * y * y * (3.0 - 2.0 * y);
    };
    testing::PtpIpCamera responder([&](const testing::PtpSettings& settings) {
        const std::lock_guard lock(mutex);
        const Photograph seen = on_bench.photograph(settings.exposure_s);
        Image8 rgb(seen.image.width, seen.image.height, 3);
        for (std::size_t k = 0; k < rgb.values.size(); ++k) {
            const double linear = (static_cast<double>(seen.image.values[k]) - seen.black_level) /
                                  (seen.saturates_at - seen.black_level);
            rgb.values[k] =
                static_cast<std::uint8_t>(255.0 * styled(std::clamp(linear, 0.0, 1.0)) + 0.5);
        }
        return testing::PtpPicture{"IMG_0001.JPG", testing::jpeg_of(rgb)};
    });
    const auto ports_of_camera = [&](Camera& camera) {
        BenchPorts ports;
        ports.show = [&](const Image8& drive) {
            const std::lock_guard lock(mutex);
            on_bench.show(drive);
        };
        ports.photograph = [&camera](double exposure_s) { return camera.photograph(exposure_s); };
        ports.measure_xyz = on_bench.measure_xyz;
        return ports;
    };
    const CalibrationSettings live = live_settings(description);
    const CameraChoice choice{"tethered", responder.port()};
    const auto median = [&] {
        const CaptureBench opened = open_capture_bench(choice, nullptr, {});
        return judged(bench, calibrate_live(ports_of_camera(*opened.camera), live))
            .comparison.interior.median;
    };
    // Taken for sRGB
    EXPECT_THROW(median(), Refused);
    {
        CaptureBench opened = open_capture_bench(choice, nullptr, {});
        EXPECT_FALSE(opened.curve);
        const CameraCurve curve = fit_camera_curve(
            *opened.camera, ports_of_camera(*opened.camera), live.width, live.height, {});
        EXPECT_EQ(curve.file.parent_path(), home / "cameras");
        EXPECT_LT(curve.residual, 0.01);
    }
    // It is known the next time.
    EXPECT_TRUE(open_capture_bench(choice, nullptr, {}).curve);
    // Eight bits and a fitted curve against fourteen and none: as the video camera's.
    EXPECT_LT(median(), 0.76);
    ::unsetenv("LIVERY_HOME");
}

/// A bench whose photographs somebody spoils or interrupts, and all of them counted.
struct Interrupted {
    BenchDescription description = small_bench_description();
    Bench bench{description, small_bench_product()};
    int photographs = 0;
    std::function<void(Photograph&, int number)> happens = [](Photograph&, int) {};

    BenchPorts ports() {
        BenchPorts ports = bench.ports();
        ports.photograph = [this, take = ports.photograph](double exposure_s) {
            Photograph photograph = take(exposure_s);
            happens(photograph, photographs++);
            return photograph;
        };
        return ports;
    }
    CalibrationResult run(Recording& recording) {
        return calibrate_through_ports(ports(), live_settings(description), {}, &recording);
    }
};

TEST(Cameras, ARecordingReplaysToTheSameCalibration) {
    const TemporaryFolder folder;
    Interrupted room;
    ColourCalibration first;
    {
        Recording recording(folder.path(), "bench");
        first = room.run(recording).calibration;
    }
    Recording replay(folder.path(), "bench");
    BenchPorts nothing;
    nothing.show = [](const Image8&) {};
    nothing.measure_xyz = [](glm::dvec2) -> glm::dvec3 { throw std::runtime_error("read anew"); };
    const ColourCalibration second =
        calibrate_live(replay.ports(nothing), live_settings(room.description)).calibration;
    EXPECT_EQ(second.status.values, first.status.values);
    EXPECT_EQ(second.dark.values, first.dark.values);
    EXPECT_EQ(second.span.values, first.span.values);
    EXPECT_EQ(second.xyz_from_camera, first.xyz_from_camera);
    EXPECT_EQ(second.response[1].drive_from_n, first.response[1].drive_from_n);
    EXPECT_EQ(replay.taken(), 0);
}

TEST(Cameras, ACaptureThatWasKilledGoesOnWhereItStopped) {
    struct Killed {};
    for (const int killed_at : chosen<int>({30, 2, 9, 55}, 1)) {
        const TemporaryFolder folder;
        Interrupted room;
        room.happens = [&](Photograph&, int number) {
            if (number == killed_at) throw Killed();
        };
        {
            Recording recording(folder.path(), "bench");
            EXPECT_THROW(room.run(recording), Killed);
        }
        room.happens = [](Photograph&, int) {};
        Recording recording(folder.path(), "bench");
        const Comparison& seen = judged(room.bench, room.run(recording)).comparison;
        EXPECT_EQ(recording.answered(), killed_at) << "at most the one under way is lost";
        EXPECT_LT(seen.interior.median, 0.4) << killed_at;
    }
}

TEST(Cameras, AProjectorThatFellAsleepIsSaidAndNothingOfItsSleepIsKept) {
    for (const int asleep_from : chosen<int>({12, 4, 31, 50}, 1)) {
        SCOPED_TRACE(asleep_from);
        const TemporaryFolder folder;
        Interrupted room;
        const CameraDescription& camera = room.description.camera;
        Random noise(static_cast<std::uint64_t>(asleep_from));
        bool asleep = false;
        room.happens = [&](Photograph& photograph, int number) {
            asleep = asleep || number == asleep_from;
            if (!asleep) return;
            // A dark room
            for (float& value : photograph.image.values)
                value = static_cast<float>(camera.black_level_units +
                                           camera.read_noise_units * noise.normal());
        };
        int taken = 0;
        {
            Recording recording(folder.path(), "bench");
            const Refusal refusal = refusal_of([&] { room.run(recording); });
            EXPECT_TRUE(refusal.why.find("shows no change") != std::string::npos ||
                        refusal.why.find("sees no light") != std::string::npos)
                << refusal.why;
            EXPECT_NE(refusal.fix.find("projector"), std::string::npos) << refusal.fix;
            taken = recording.taken();
        }
        room.happens = [](Photograph&, int) {};
        Recording recording(folder.path(), "bench");
        const Comparison& seen = judged(room.bench, room.run(recording)).comparison;
        std::printf("    asleep from %d: %d taken, then %d kept and %d taken\n",
                    asleep_from,
                    taken,
                    recording.answered(),
                    recording.taken());
        EXPECT_LT(seen.interior.median, 0.4);
    }
}

TEST(Cameras, APhotographThatCannotBeUsedIsTakenAgain) {
    const std::vector<std::pair<std::function<void(Photograph&)>, const char*>> spoils{
        {[](Photograph& photograph) { photograph.image = ImageF(100, 70, 3); },
         "as the first photograph"},
        {[](Photograph& photograph) { photograph.exposure_s *= 1.4; }, "automatic exposure"},
        {[](Photograph& photograph) {
             photograph.image = ImageF(432, 288, 3, std::numeric_limits<float>::quiet_NaN());
         },
         "not finite"}};
    for (const auto& [spoil, said] : chosen(spoils, 1)) {
        const TemporaryFolder folder;
        Interrupted room;
        room.happens = [&, spoil = spoil](Photograph& photograph, int number) {
            if (number == 30) spoil(photograph);
        };
        Recording recording(folder.path(), "bench");
        EXPECT_NE(message_of([&] { room.run(recording); }).find(said), std::string::npos)
            << message_of([&] { room.run(recording); });
        const int taken = recording.taken();
        const CalibrationResult live = room.run(recording);
        EXPECT_GE(recording.answered(), taken - 1) << said;
        EXPECT_GT(live.calibration.valid_fraction, 0.95) << said;
    }
}

TEST(Cameras, AFullDiskIsSaidAndNothingIsLost) {
    const TemporaryFolder folder;
    Interrupted room;
    Recording recording(folder.path(), "bench");
    std::unique_ptr<FullDisk> disk;
    room.happens = [&](Photograph&, int number) {
        if (number == 20) disk = std::make_unique<FullDisk>(4096);
    };
    const std::string said = message_of([&] { room.run(recording); });
    disk.reset();
    EXPECT_NE(said.find(folder.path().string()), std::string::npos) << said;
    Recording again(folder.path(), "bench");
    const CalibrationResult live = room.run(again);
    EXPECT_GE(again.answered(), 18);
    EXPECT_GT(live.calibration.valid_fraction, 0.95);
}

TEST(Cameras, ACameraThatIsPulledIsWaitedFor) {
    const BenchDescription description = filmed_description();
    FilmedBench filmed(description);
    MjpegServer server([&] { return filmed.frame(); }, 60.0);
    VideoCameraOptions video;
    video.source = server.address();
    video.frames = 2;
    video.timeout_ms = 1500;
    const auto camera = open_video_camera(video);
    std::vector<CaptureWait> waits;
    BenchPorts ports;
    int shown = 0;
    ports.show = [&](const Image8& drive) {
        filmed.show(drive);
        if (++shown == 12) server.pull_cable(true);
    };
    ports.photograph = patient(*camera, {}, [&](const CaptureWait& wait) {
        waits.push_back(wait);
        if (waits.size() == 2) server.pull_cable(false);
    });
    ports.measure_xyz = filmed.colorimeter();
    const TemporaryFolder folder;
    Recording recording(folder.path(), "the bench, filmed");
    EXPECT_GT(calibrate_through_ports(ports, live_settings(description), {}, &recording)
                  .calibration.valid_fraction,
              0.85);
    ASSERT_GE(waits.size(), 3u);
    EXPECT_NE(waits.front().why.find(server.address()), std::string::npos);
    EXPECT_FALSE(waits.front().fix.empty());
    EXPECT_TRUE(waits.back().why.empty()) << "told that it goes on";
    // A stop is heard while the camera is away.
    server.pull_cable(true);
    std::atomic<bool> stop{true};
    Progress progress;
    progress.stop = &stop;
    EXPECT_THROW(patient(*camera, progress, [](const CaptureWait&) {})(0.0), Cancelled);
}

}  // namespace
}  // namespace livery
