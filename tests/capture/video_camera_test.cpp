#include "capture/video_camera.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "capture/fault_of.h"
#include "core/colour.h"
#include "support/jpeg.h"
#include "support/message_of.h"
#include "support/mjpeg_server.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::MjpegServer;

std::string uniform_jpeg(int red, int green, int blue, int width = 64, int height = 48) {
    Image8 picture(width, height, 3);
    for (std::size_t k = 0; k < picture.values.size(); k += 3) {
        picture.values[k] = static_cast<std::uint8_t>(red);
        picture.values[k + 1] = static_cast<std::uint8_t>(green);
        picture.values[k + 2] = static_cast<std::uint8_t>(blue);
    }
    return testing::jpeg_of(picture);
}

VideoCameraOptions stream_of(const MjpegServer& server) {
    VideoCameraOptions options;
    options.source = server.address();
    options.frames = 3;
    options.timeout_ms = 1500;
    return options;
}

TEST(VideoCamera, PhotographsWhatTheStreamShowsNow) {
    std::atomic<int> level{40};
    const MjpegServer server([&] { return uniform_jpeg(level, level / 2, 10); });
    const auto camera = open_video_camera(stream_of(server));
    for (const int shown : {40, 200, 120, 255, 0}) {
        level = shown;
        const Photograph photograph = camera->photograph(0.0);
        ASSERT_EQ(photograph.image.width, 64);
        EXPECT_NEAR(photograph.image.at(20, 20, 0), 255.0 * srgb_decode(shown / 255.0), 2.5)
            << shown;
        EXPECT_NEAR(photograph.image.at(20, 20, 1), 255.0 * srgb_decode((shown / 2) / 255.0), 2.5)
            << shown;
        EXPECT_EQ(photograph.saturates_at, 255.0);
        EXPECT_EQ(photograph.black_level, 0.0);
        EXPECT_GT(photograph.exposure_s, 0.0);
    }
    EXPECT_EQ(camera->live_view().at(5, 5, 1), 0);
    const CameraState state = camera->state();
    ASSERT_EQ(state.warnings.size(), 1u);
    EXPECT_NE(state.warnings[0].find("exposure cannot be set from here"), std::string::npos);
}

// A network that stands still for a moment sends what it kept all at once, and it is of before.
TEST(VideoCamera, PassesOverFramesThatLayInABuffer) {
    constexpr int kKept = 20;
    std::atomic<int> level{40}, kept{0};
    std::atomic<bool> hold{false};
    const MjpegServer server([&] {
        if (hold.exchange(false)) {
            kept = kKept;
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
        }
        const int shown = kept > 0 ? 40 : level.load();
        if (kept > 0) --kept;
        return uniform_jpeg(shown, shown, shown);
    });
    const auto camera = open_video_camera(stream_of(server));
    camera->photograph(0.0);
    hold = true;
    while (kept == 0) std::this_thread::yield();
    level = 200;
    EXPECT_NEAR(camera->photograph(0.0).image.at(20, 20, 0), 255.0 * srgb_decode(200 / 255.0), 2.5);
    EXPECT_EQ(kept, 0);
}

TEST(VideoCamera, AveragesFrames) {
    std::atomic<int> count{0};
    const MjpegServer server([&] {
        const int level = 100 + 10 * (count++ % 2);
        return uniform_jpeg(level, level, level);
    });
    VideoCameraOptions options = stream_of(server);
    options.frames = 8;
    const auto camera = open_video_camera(options);
    EXPECT_THROW(camera->use_transfer("no such response.json"), FileError);
    camera->use_transfer("linear");
    // A frame may be passed over when this machine is busy: not always four of each.
    EXPECT_NEAR(camera->photograph(0.0).image.at(9, 9, 1), 105.0, 3.0);
    camera->set("frames", "1");
    const float one = camera->photograph(0.0).image.at(9, 9, 1);
    EXPECT_NEAR(std::abs(one - 105.0f), 5.0f, 1.1f);
    EXPECT_EQ(fault_of([&] { camera->set("frames", "0"); }).trouble(), CameraTrouble::refused);
    EXPECT_EQ(fault_of([&] { camera->set("exposure", "1/60 s"); }).trouble(),
              CameraTrouble::refused);
}

TEST(VideoCamera, ComesBackWhenItsCableDoes) {
    MjpegServer server([] { return uniform_jpeg(90, 90, 90); });
    const auto camera = open_video_camera(stream_of(server));
    camera->photograph(0.0);
    server.pull_cable(true);
    const CameraFault fault = fault_of([&] { camera->photograph(0.0); });
    EXPECT_EQ(fault.trouble(), CameraTrouble::gone);
    EXPECT_NE(fault.why().find(server.address()), std::string::npos) << fault.why();
    EXPECT_FALSE(fault.fix().empty());
    EXPECT_EQ(fault_of([&] { camera->photograph(0.0); }).trouble(), CameraTrouble::gone);
    server.pull_cable(false);
    EXPECT_NEAR(camera->photograph(0.0).image.at(3, 3, 0), 255.0 * srgb_decode(90 / 255.0), 2.0);
}

TEST(VideoCamera, GivesUpOnAStreamThatStandsStill) {
    MjpegServer server([] { return uniform_jpeg(90, 90, 90); });
    VideoCameraOptions options = stream_of(server);
    options.timeout_ms = 400;
    const auto camera = open_video_camera(options);
    camera->photograph(0.0);
    server.freeze(true);
    EXPECT_EQ(fault_of([&] { camera->photograph(0.0); }).trouble(), CameraTrouble::gone);
    server.freeze(false);
    camera->photograph(0.0);
}

TEST(VideoCamera, KeepsItsSizeWhenTheStreamChangesIts) {
    std::atomic<int> width{64};
    const MjpegServer server([&] { return uniform_jpeg(90, 90, 90, width); });
    const auto camera = open_video_camera(stream_of(server));
    EXPECT_EQ(camera->photograph(0.0).image.width, 64);
    width = 80;
    // FFmpeg scales what comes in another size; a camera that does not is refused by its own check.
    EXPECT_EQ(camera->photograph(0.0).image.width, 64);
}

TEST(VideoCamera, TakesTheFramesOfAFileInTheirOrder) {
    const TemporaryFolder folder;
    const auto file = folder / "frames.avi";
    {
        cv::VideoWriter writer(
            file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0, {64, 48});
        ASSERT_TRUE(writer.isOpened());
        for (const int level : {50, 50, 150, 150, 250})
            writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar(level, level, level)));
    }
    VideoCameraOptions options;
    options.source = file.string();
    options.frames = 2;
    const auto camera = open_video_camera(options);
    camera->use_transfer("linear");
    EXPECT_NEAR(camera->photograph(0.0).image.at(30, 30, 0), 50.0, 2.0);
    EXPECT_NEAR(camera->photograph(0.0).image.at(30, 30, 0), 150.0, 2.0);
    EXPECT_EQ(fault_of([&] { camera->photograph(0.0); }).trouble(), CameraTrouble::gone);
    EXPECT_TRUE(open_video_camera(options)->live_view().empty());
}

TEST(VideoCamera, SaysWhatDoesNotOpen) {
    const TemporaryFolder folder;
    const auto text = folder.write("not a video.avi", "twelve letters");
    const std::vector<std::string> sources{
        text.string(), (folder / "none.avi").string(), "http://127.0.0.1:1/video.mjpg", "997"};
    for (const std::string& source : sources) {
        VideoCameraOptions options;
        options.source = source;
        options.timeout_ms = 1000;
        const CameraFault fault = fault_of([&] { open_video_camera(options); });
        EXPECT_EQ(fault.trouble(), CameraTrouble::gone) << source;
        EXPECT_NE(fault.why().find(source), std::string::npos) << fault.why();
    }
    VideoCameraOptions options;
    options.frames = 0;
    EXPECT_THROW(open_video_camera(options), std::invalid_argument);
}

}  // namespace
}  // namespace livery
