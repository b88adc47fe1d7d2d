// The window's capture, with the simulated bench as its camera.
#include <gtest/gtest.h>

#include "desktop/two_monitors.h"

namespace livery {
namespace {

class CaptureWindow : public TwoMonitors {};

TEST_F(CaptureWindow, NightlyShowsALiveViewAndLeavesNothingBehind) {
    start();
    program->click("menu:Projector");
    program->click("menu:capture");
    program->wait_for_state("capture", "nothing");
    program->click("camera");
    program->click("camera:bench:default");
    program->wait_for_state("capture", "watching");
    program->item("live-view");
    program->item("capture-start");
    // What is made next would say if a picture had gone while it was drawn.
    program->click("capture-close");
    program->wait_for_state("capture", "closed");
    program->click("menu:File");
    program->click("menu:ballot");
    program->item("ballot:start");
    EXPECT_EQ(program->quit(), 0) << program->words();
}

}  // namespace
}  // namespace livery
