#include "capture/tethered_camera.h"

#include <atomic>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "capture/camera.h"
#include "capture/fault_of.h"
#include "capture/recording.h"
#include "core/colour.h"
#include "support/dng.h"
#include "support/jpeg.h"
#include "support/ptpip_camera.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::PtpIpCamera;
using testing::PtpMishap;
using testing::PtpPicture;
using testing::PtpSettings;

/// libgphoto2 writes its settings below HOME.
class OwnHome : public ::testing::Environment {
  public:
    void SetUp() override { ::setenv("HOME", folder_.path().c_str(), 1); }

  private:
    TemporaryFolder folder_;
};
[[maybe_unused]] const auto* const kHome =
    ::testing::AddGlobalTestEnvironment(new OwnHome);  // NOLINT: gtest's own

/// Red, green and blue of the sensor in proportion to the exposure, 64x48 of its pixels.
PtpPicture raw_picture(const PtpSettings& settings) {
    const auto level = [&](double per_s) {
        return static_cast<std::uint16_t>(
            std::min(65535.0, 1000.0 + per_s * settings.exposure_s * settings.iso / 100.0));
    };
    const auto red = level(40000.0), green = level(80000.0), blue = level(20000.0);
    return {"IMG_0007.DNG", testing::dng_of(64, 48, 1000, [=](int x, int y) {
                return testing::bayer(x, y, red, green, blue);
            })};
}

TetheredOptions quick(const PtpIpCamera& camera) {
    TetheredOptions options;
    options.port = camera.port();
    options.answer = std::chrono::milliseconds(1500);
    options.photograph = std::chrono::milliseconds(1500);
    return options;
}

const CameraSetting& setting(const CameraState& state, const std::string& name) {
    for (const CameraSetting& each : state.settings)
        if (each.name == name) return each;
    throw std::runtime_error("no setting " + name);
}

TEST(TetheredCamera, SaysHowItIsSet) {
    PtpIpCamera responder(raw_picture);
    const auto camera = open_tethered_camera(quick(responder));
    const CameraState state = camera->state();
    EXPECT_EQ(setting(state, "iso").value, "100");
    EXPECT_EQ(setting(state, "aperture").value, "f/8");
    EXPECT_EQ(seconds_of_shutter_speed(setting(state, "exposure").value), 0.125);
    EXPECT_GT(setting(state, "exposure").choices.size(), 20u);
    EXPECT_TRUE(setting(state, "exposure").can_be_set);
    EXPECT_EQ(state.shots_left, 600);
    EXPECT_EQ(state.battery, 0.8);
    EXPECT_TRUE(state.warnings.empty());
    camera->set("iso", "400");
    EXPECT_EQ(responder.settings().iso, 400);
    EXPECT_EQ(fault_of([&] { camera->set("iso", "123"); }).trouble(), CameraTrouble::refused);
    EXPECT_EQ(fault_of([&] { camera->set("mood", "sunny"); }).trouble(), CameraTrouble::refused);
}

TEST(TetheredCamera, PhotographsRawAsTheSensorHasIt) {
    PtpIpCamera responder(raw_picture);
    const auto camera = open_tethered_camera(quick(responder));
    for (const double asked_s : {0.0, 0.051, 0.5}) {
        const Photograph photograph = camera->photograph(asked_s);
        const double exposure_s = std::exp2(asked_s > 0.4   ? -1.0
                                            : asked_s > 0.0 ? -13.0 / 3.0
                                                            : -3.0);
        EXPECT_DOUBLE_EQ(photograph.exposure_s, exposure_s) << "the nearest that it has";
        EXPECT_EQ(photograph.image.width, 32) << "one pixel of each square of the filter";
        EXPECT_EQ(photograph.image.height, 24);
        const double scale = 65535.0 / 64535.0;
        EXPECT_NEAR(photograph.image.at(10, 10, 0), 40000.0 * exposure_s * scale, 2.0);
        EXPECT_NEAR(photograph.image.at(10, 10, 1), 80000.0 * exposure_s * scale, 2.0);
        EXPECT_NEAR(photograph.image.at(10, 10, 2), 20000.0 * exposure_s * scale, 2.0);
        EXPECT_NEAR(photograph.saturates_at, 0.95 * 65535.0, 1.0)
            << "of two greens one alone may be clipped";
        EXPECT_EQ(photograph.black_level, 0.0);
        ASSERT_TRUE(photograph.file);
        EXPECT_EQ(photograph.file->name, "IMG_0007.DNG");
    }
    EXPECT_EQ(responder.photographs(), 3);
    EXPECT_EQ(responder.on_card(), 0u) << "deleted once they are here";
    EXPECT_TRUE(camera->live_view().empty()) << "this one has none";
}

TEST(TetheredCamera, TakesJpegForSrgb) {
    PtpIpCamera responder([](const PtpSettings&) {
        return PtpPicture{"IMG_1.JPG", testing::jpeg_of(Image8(40, 30, 3, 128))};
    });
    const Photograph photograph = open_tethered_camera(quick(responder))->photograph(0.1);
    EXPECT_NEAR(photograph.image.at(5, 5, 1), 255.0 * srgb_decode(128 / 255.0), 1.0);
    EXPECT_FALSE(photograph.file) << "its numbers are kept, not its bytes";
}

TEST(TetheredCamera, IsRecordedByItsOwnFiles) {
    PtpIpCamera responder(raw_picture);
    const auto camera = open_tethered_camera(quick(responder));
    const TemporaryFolder folder;
    BenchPorts ports;
    ports.show = [](const Image8&) {};
    ports.photograph = [&](double exposure_s) { return camera->photograph(exposure_s); };
    ImageF seen;
    {
        Recording recording(folder.path(), "camera");
        const BenchPorts recorded = recording.ports(ports);
        recorded.show(Image8(4, 4, 3));
        seen = recorded.photograph(0.25).image;
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "0000.DNG"));
    Recording replay(folder.path(), "camera");
    const BenchPorts again = replay.ports({});
    again.show(Image8(4, 4, 3));
    EXPECT_EQ(again.photograph(0.25).image.values, seen.values);
}

struct Mishap {
    PtpMishap mishap;
    CameraTrouble trouble;
    const char* said;
};

class TetheredMishaps : public ::testing::TestWithParam<Mishap> {};

TEST_P(TetheredMishaps, AreNamedAndGoneWhenTheyAre) {
    const Mishap& what = GetParam();
    PtpIpCamera responder(raw_picture);
    const auto camera = open_tethered_camera(quick(responder));
    camera->photograph(0.1);
    responder.set(what.mishap);
    const CameraFault fault = fault_of([&] { camera->photograph(0.2); });
    EXPECT_EQ(fault.trouble(), what.trouble) << fault.why();
    EXPECT_NE(fault.why().find(what.said), std::string::npos) << fault.why();
    EXPECT_NE(fault.why().find(responder.port()), std::string::npos) << "which camera";
    // And again: it stays as it is, it does not hang.
    const CameraFault again = fault_of([&] { camera->photograph(0.2); });
    EXPECT_EQ(again.trouble(), what.trouble) << again.why();
    responder.set(PtpMishap::none);
    if (what.trouble == CameraTrouble::refused || what.trouble == CameraTrouble::unusable) {
        // libgphoto2 believes a setting that it has read for two seconds.
        bool works = false;
        for (int k = 0; k < 100 && !works; ++k) {
            try {
                works = camera->photograph(0.25).exposure_s == 0.25;
            } catch (const CameraFault&) {
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            }
        }
        EXPECT_TRUE(works);
    } else {
        int waits = 0;
        const TakePhotograph port = patient(*camera, {}, [&](const CaptureWait&) { ++waits; });
        EXPECT_EQ(port(0.25).exposure_s, 0.25);
    }
}

INSTANTIATE_TEST_SUITE_P(
    All,
    TetheredMishaps,
    ::testing::Values(
        Mishap{PtpMishap::unplugged, CameraTrouble::gone, "not there any more"},
        Mishap{PtpMishap::asleep, CameraTrouble::silent, "answer"},
        Mishap{PtpMishap::never_photographs, CameraTrouble::silent, "no photograph came"},
        Mishap{PtpMishap::card_full, CameraTrouble::card_full, "card is full"},
        Mishap{PtpMishap::busy, CameraTrouble::silent, "busy"},
        Mishap{PtpMishap::automatic_exposure, CameraTrouble::refused, "automatic exposure"},
        Mishap{PtpMishap::half_a_file, CameraTrouble::unusable, "cannot be read"}));

TEST(TetheredCamera, ThatEndsItsLibraryIsAskedAgain) {
    // A file name of 254 characters, all that PTP can say, is longer than libgphoto2's own buffer.
    std::atomic<int> shots{0};
    PtpIpCamera responder([&](const PtpSettings& settings) {
        PtpPicture picture = raw_picture(settings);
        if (++shots == 2) picture.name = std::string(250, 'x') + ".DNG";
        return picture;
    });
    const auto camera = open_tethered_camera(quick(responder));
    std::vector<std::string> waits;
    const TakePhotograph port = patient(*camera, {}, [&](const CaptureWait& wait) {
        if (!wait.why.empty()) waits.push_back(wait.why);
    });
    for (int k = 0; k < 3; ++k) EXPECT_EQ(port(0.25).exposure_s, 0.25) << k;
    // A libgphoto2 that can hold it gives nothing to wait for.
    for (const std::string& why : waits)
        EXPECT_NE(why.find("has ended the camera's library"), std::string::npos) << why;
}

TEST(TetheredCamera, WarnsOfAutomaticExposureAndAFullCard) {
    PtpIpCamera responder(raw_picture);
    const auto camera = open_tethered_camera(quick(responder));
    responder.set(PtpMishap::automatic_exposure);
    std::vector<std::string> warnings;
    for (int k = 0; k < 100 && warnings.empty(); ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        warnings = camera->state().warnings;
    }
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("turn it to M"), std::string::npos);
    responder.set(PtpMishap::card_full);
    EXPECT_EQ(open_tethered_camera(quick(responder))->state().warnings,
              std::vector<std::string>{"its card is full"});
}

TEST(TetheredCamera, SaysWhatIsNotThere) {
    TetheredOptions options;
    options.answer = std::chrono::milliseconds(3000);
    options.port = "ptpip:127.0.0.1:1";
    EXPECT_EQ(fault_of([&] { open_tethered_camera(options); }).trouble(), CameraTrouble::gone);
    options.port = "usb:255,255";
    const CameraFault fault = fault_of([&] { open_tethered_camera(options); });
    EXPECT_EQ(fault.trouble(), CameraTrouble::gone);
    EXPECT_NE(fault.why().find("usb:255,255"), std::string::npos);
    for (const FoundCamera& camera : list_tethered_cameras())
        EXPECT_FALSE(camera.model.empty() || camera.port.empty());
}

TEST(TetheredCamera, ReadsShutterSpeeds) {
    EXPECT_DOUBLE_EQ(seconds_of_shutter_speed("1/60"), 1.0 / 60.0);
    EXPECT_DOUBLE_EQ(seconds_of_shutter_speed("0.1000s"), 0.1);
    EXPECT_DOUBLE_EQ(seconds_of_shutter_speed("0.4"), 0.4);
    EXPECT_DOUBLE_EQ(seconds_of_shutter_speed("2\""), 2.0);
    EXPECT_DOUBLE_EQ(seconds_of_shutter_speed("10/13"), 10.0 / 13.0);
    for (const char* none : {"bulb", "auto", "", "1/", "1/0", "-1", "0"})
        EXPECT_LT(seconds_of_shutter_speed(none), 0.0) << none;
}

TEST(TetheredCamera, KnowsHowLongARoundNumberIs) {
    const CameraSetting thirds{
        "exposure", "", {"bulb", "1/125", "1/100", "1/80", "1/60", "1/30", "0.3", "1", "15"}, true};
    EXPECT_DOUBLE_EQ(open_time_s(thirds, "1/60"), 1.0 / 64.0);
    EXPECT_DOUBLE_EQ(open_time_s(thirds, "1/100"), std::exp2(-20.0 / 3.0));
    EXPECT_DOUBLE_EQ(open_time_s(thirds, "0.3"), std::exp2(-5.0 / 3.0));
    EXPECT_DOUBLE_EQ(open_time_s(thirds, "15"), 16.0);
    EXPECT_LT(open_time_s(thirds, "bulb"), 0.0);
    const CameraSetting halves{"exposure", "", {"1/125", "1/90", "1/60", "1/45", "1/30"}, true};
    EXPECT_DOUBLE_EQ(open_time_s(halves, "1/90"), std::exp2(-6.5));
    // A camera that counts in frames means what it says.
    const CameraSetting frames{"exposure", "", {"0.0167s", "0.0333s", "0.0500s", "0.0667s"}, true};
    EXPECT_DOUBLE_EQ(open_time_s(frames, "0.0500s"), 0.05);
    EXPECT_EQ(nearest_time(thirds, 0.0156), "1/60");
}

}  // namespace
}  // namespace livery
