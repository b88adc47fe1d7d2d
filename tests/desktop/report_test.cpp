// A problem report from the running window.
#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"

namespace livery {
namespace {

using ReportTest = TwoMonitors;

TEST_F(ReportTest, IsMadeAndSavedWhileTheMockUpIsShown) {
    use_shared();
    program->click("menu:Help");
    program->click("menu:report-problem");
    program->wait_for_state("report", "ready");
    EXPECT_TRUE(program->has_item("report:file:opengl.txt"));
    program->click("report:file:display.txt");
    program->click("report:pictures");
    program->wait_for_state("report", "ready");
    EXPECT_TRUE(
        wait_until([&] { return program->has_item("report:file:pictures/projector.png"); }));
    EXPECT_FALSE(program->has_item("report:file:session.json"));
    const std::filesystem::path file = studio->folder / "report.zip";
    program->click("report:save");
    program->click("file-dialog:path");
    desktop->press_key("ctrl+a");
    desktop->type(file.string());
    program->click("file-dialog:ok");
    program->wait_for_state("report", "saved");
    EXPECT_TRUE(read_text_file(file).starts_with("PK"));
    EXPECT_TRUE(projector_shows(drive_of_place(0))) << "the mock-up is left alone";
    program->press_key("Escape");
    program->wait_for_state("report", "closed");
}

}  // namespace
}  // namespace livery
