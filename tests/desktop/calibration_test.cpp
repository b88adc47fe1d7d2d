// Calibrations loaded in the window, beside the one that the program makes by itself.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "desktop/two_monitors.h"
#include "session/session.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

class Calibrations : public TwoMonitors {
  protected:
    /// Answers the dialog that is open with a typed path.
    void answer(const fs::path& path) {
        program->click("file-dialog:path");
        program->press_key("ctrl+a");
        desktop->type(path.string());
        program->press_key("Return");
    }
};

TEST_F(Calibrations, NightlyOneOfPhotographsAsksForItsProjectorAndIsNotReplaced) {
    // As `livery calibrate color` leaves it when it is not told of the projector.
    const fs::path prepared = prepared_calibration(kFullProjector_px);
    auto running = std::make_shared<RunningStudio>();
    const fs::path loaded = running->folder / "loaded", camera = running->folder / "camera.json";
    fs::copy(prepared, loaded, fs::copy_options::recursive);
    fs::rename(loaded / "projector.json", camera);
    // A first start: nothing was calibrated, so the program begins to by itself.
    ::setenv("LIVERY_HOME", (running->folder / "home").c_str(), 1);
    Session::open(running->session_file());
    running->desktop = std::make_unique<Desktop>(DesktopOptions{.projector_px = kFullProjector_px});
    use(running);
    start_program();
    program->wait_for_state("calibrating", true);

    program->click("tab:Calibrate");
    program->click("load-calibration");
    answer(loaded);
    program->click("file-dialog:ok");
    // What is no camera file is refused by name, and nothing is loaded.
    program->click("file-dialog:calibration.json");
    program->click("file-dialog:ok");
    ASSERT_TRUE(wait_until([&] {
        const nlohmann::json notices = program->state("notices");
        return std::find(notices.begin(), notices.end(), "The calibration was not loaded.") !=
               notices.end();
    }));
    EXPECT_EQ(program->state("calibration"), "");
    EXPECT_FALSE(fs::exists(loaded / "projector.json"));

    program->click("load-calibration");
    answer(loaded);
    program->click("file-dialog:ok");
    answer(camera);
    program->wait_for_state("calibration", loaded.string());
    EXPECT_TRUE(fs::exists(loaded / "projector.json"));
    // The one that nobody asked for stops, and does not take its place.
    program->wait_for_state("calibrating", false);
    sleep_ms(500);
    EXPECT_EQ(program->state("calibration"), loaded.string());
}

}  // namespace
}  // namespace livery
