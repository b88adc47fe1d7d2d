// Cameras as people name them.
#include <gtest/gtest.h>

#include "jobs/capture_bench.h"
#include "support/message_of.h"

namespace livery {
namespace {

TEST(CameraChoices, AnAddressSaysWhichKindOfCameraItIs) {
    EXPECT_EQ(camera_at_address("ptpip:192.168.1.5"),
              (CameraChoice{"tethered", "ptpip:192.168.1.5"}));
    EXPECT_EQ(camera_at_address("ptpip:127.0.0.1:15741"),
              (CameraChoice{"tethered", "ptpip:127.0.0.1:15741"}));
    for (const char* video : {"http://a/b", "https://a", "rtsp://user@a:554/1"})
        EXPECT_EQ(camera_at_address(video), (CameraChoice{"video", video}));
    for (const char* none : {"", "192.168.1.5", "ptpip:", "http://", "ftp://a", "file.avi"}) {
        const std::string message = message_of([&] { camera_at_address(none); });
        EXPECT_NE(message.find("found \"" + std::string(none) + "\""), std::string::npos);
        EXPECT_NE(message.find("ptpip:HOST"), std::string::npos) << message;
    }
}

TEST(CameraChoices, TheAddressOfOneIsReadBackAsItself) {
    for (const char* address : {"ptpip:host:1", "rtsp://host/video"}) {
        const CameraChoice choice = camera_at_address(address);
        EXPECT_EQ(parse_camera_choice(text_of(choice)), choice);
    }
}

}  // namespace
}  // namespace livery
