// The window of a problem report, drawn without a window.
#include "studio/report/report_window.h"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>
#include <imgui.h>

#include "core/paths.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/folders.h"
#include "studio/panels_fixture.h"
#include "support/child_process.h"

namespace livery {
namespace {

void draw_with_dialog(Studio& studio) {
    draw_report_window(studio);
    studio.file_dialog->draw();
}

class ReportWindow : public Panels {
  protected:
    ReportWindow() { use_scale(1.0f); }

    bool comes_to(Studio& studio, const std::string& state) {
        return wait_until([&] {
            frame(studio, draw_with_dialog);
            return state_of_report(studio) == state;
        });
    }
    std::vector<std::string> files(const Studio& studio) const {
        std::vector<std::string> names;
        for (const ReportFile& file : *studio.panels.of<ReportWindowState>().report)
            names.push_back(file.name);
        return names;
    }
    static bool has(const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    }
};

TEST_F(ReportWindow, IsReadTickedAndSaved) {
    Studio studio = make_studio();
    studio.file_dialog = std::make_unique<FileDialog>(studio.settings);
    EXPECT_FALSE(is_gathering_report(studio)) << "nothing is asked before somebody wants it";
    studio.drawn_with = "a card of this test";
    show_report_window(studio, true);
    EXPECT_STREQ(state_of_report(studio), "gathering");
    ASSERT_TRUE(comes_to(studio, "ready"));
    ReportWindowState& window = studio.panels.of<ReportWindowState>();
    EXPECT_EQ(window.problem, "");
    for (const char* name :
         {"README.txt", "opengl.txt", "display.txt", "cameras.txt", "window.txt"}) {
        EXPECT_TRUE(has(files(studio), name)) << name;
    }
    EXPECT_FALSE(has(files(studio), "session.json"));

    click(studio, draw_with_dialog, "report:file:window.txt");
    EXPECT_EQ(window.chosen, "window.txt");
    click(studio, draw_with_dialog, "report:session");
    ASSERT_TRUE(comes_to(studio, "ready"));
    EXPECT_TRUE(has(files(studio), "session.json"));
    EXPECT_FALSE(has(files(studio), "votes/rounds.txt"));
    click(studio, draw_with_dialog, "report:votes");
    ASSERT_TRUE(comes_to(studio, "ready"));
    EXPECT_TRUE(has(files(studio), "votes/rounds.txt"));
    click(studio, draw_with_dialog, "report:session");
    ASSERT_TRUE(comes_to(studio, "ready"));
    EXPECT_FALSE(has(files(studio), "session.json"));

    setenv("HOME", home_.path().c_str(), 1);
    click(studio, draw_with_dialog, "report:save");
    ASSERT_TRUE(studio.file_dialog->is_open());
    click(studio, draw_with_dialog, "file-dialog:ok");
    ASSERT_TRUE(comes_to(studio, "saved")) << window.problem;
    EXPECT_TRUE(read_text_file(window.saved).starts_with("PK"));
    EXPECT_TRUE(frames(studio, draw_with_dialog, 2).contains("report:open-folder"));
}

TEST_F(ReportWindow, SaysWhyItWasNotSaved) {
    Studio studio = make_studio();
    studio.file_dialog = std::make_unique<FileDialog>(studio.settings);
    show_report_window(studio, true);
    ASSERT_TRUE(comes_to(studio, "ready"));
    ReportWindowState& window = studio.panels.of<ReportWindowState>();
    window.saving = std::async(std::launch::async, [report = window.report]() {
        write_problem_report("/proc/report.zip", *report, 0);
        return std::filesystem::path("/proc/report.zip");
    });
    ASSERT_TRUE(comes_to(studio, "ready"));
    EXPECT_NE(window.problem.find("/proc/report.zip"), std::string::npos) << window.problem;
    EXPECT_FALSE(frames(studio, draw_with_dialog, 2).contains("report:open-folder"));
}

TEST_F(ReportWindow, ClosesWhileItGathers) {
    Studio studio = make_studio();
    studio.file_dialog = std::make_unique<FileDialog>(studio.settings);
    show_report_window(studio, true);
    show_report_window(studio, false);
    EXPECT_STREQ(state_of_report(studio), "closed");
    frames(studio, draw_with_dialog, 2);
}

TEST(OpenFolder, AsksTheDesktopsOwnProgram) {
    const TemporaryFolder folder;
    const std::string said = (folder / "said").string(), path = std::getenv("PATH");
    folder.write(
        "xdg-open",
        "#!/bin/sh\nprintf %s \"$1\" >'" + said + ".new'; mv '" + said + ".new' '" + said + "'\n");
    std::filesystem::permissions(folder / "xdg-open", std::filesystem::perms::owner_all);
    ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
    EXPECT_TRUE(open_folder("/tmp/it's a \"folder\""));
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(said); }));
    EXPECT_EQ(read_text_file(said), "/tmp/it's a \"folder\"");
    std::filesystem::remove(folder / "xdg-open");
    std::filesystem::create_symlink("/bin/sh", folder / "sh");
    ::setenv("PATH", folder.path().c_str(), 1);
    EXPECT_FALSE(open_folder("/tmp"));
    ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace livery
