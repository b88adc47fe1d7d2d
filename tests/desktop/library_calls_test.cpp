// While somebody works, the window asks nothing of the paint library's files; what is put there is
// found when the window gets the focus back.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "appearance/material.h"
#include "desktop/two_monitors.h"
#include "support/run_program.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

constexpr int kClicks = 60, kBetweenClicks_ms = 60;

class LibraryFiles : public TwoMonitors {
  protected:
    LibraryFiles() { std::filesystem::create_directories(home_ / "materials"); }

    void write_paint(const std::string& name) {
        Material paint;
        paint.name = name;
        paint.diffuse = {0.4, 0.1, 0.2};
        write_material_file(home_ / ("materials/" + name + ".json"), paint);
    }
    void write_measured_paint(const std::string& name) {
        std::ofstream samples(home_ / ("materials/" + name + ".csv"));
        samples << "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
        for (int k = 0; k < 12; ++k) {
            samples << 0.1 * k << ",0," << 0.5 << ',' << k << ",.1,.05,.02\n";
        }
        std::ofstream(home_ / ("materials/" + name + ".json"))
            << R"({"format_version": 1, "name": ")" << name
            << R"(", "model": "measured", "parameters": {"file": ")" << name << R"(.csv"}})";
    }
    /// A program of this test's own user, whose calls on the library's files are written down.
    void start_watched() {
        DesktopOptions options = small_projector();
        options.window_manager = true;
        start(options);
        studio->program.reset();
        StudioStart how;
        how.session = studio->session_file();
        how.environment = {{"LD_PRELOAD", LIVERY_PATH_CALLS},
                           {"LIVERY_PATH_CALLS", (home_ / "calls").string()},
                           {"LIVERY_PATH_PART", "/materials"},
                           {"LIVERY_HOME", home_.path().string()}};
        studio->program = std::make_unique<StudioProgram>(*desktop, how);
        program = studio->program.get();
    }
    std::vector<std::string> calls() const {
        std::vector<std::string> lines;
        std::ifstream log(home_ / "calls");
        for (std::string line; std::getline(log, line);) lines.push_back(line);
        return lines;
    }
    std::ptrdiff_t calls_on(const std::string& part) const {
        const auto all = calls();
        return std::count_if(all.begin(), all.end(), [&](const std::string& line) {
            return line.find(part) != std::string::npos;
        });
    }
    std::ptrdiff_t told(const std::string& event) const {
        const auto lines = program->trace();
        return std::count_if(
            lines.begin(), lines.end(), [&](const TraceLine& line) { return line.event == event; });
    }
    std::vector<glm::ivec2> swatches_in_sight() {
        std::vector<glm::ivec2> places;
        for (const auto& [name, place] : program->items()) {
            if (name.starts_with("paint:") && place.height > 20) places.push_back(middle(place));
        }
        return places;
    }

    TemporaryFolder home_;
};

TEST_F(LibraryFiles, NightlyAreLeftAloneWhileSomebodyClicks) {
    write_paint("house red");
    write_measured_paint("tile");
    start_watched();
    pick_projector();
    program->click("part:body");
    ASSERT_TRUE(wait_until([&] { return program->has_item("paint:tile"); }));
    EXPECT_GT(calls_on("solid-red.json"), 0) << "the calls are not seen";
    EXPECT_GT(calls_on("house red.json"), 0);
    EXPECT_GT(calls_on("tile.csv"), 0);
    program->click("paint:tile");
    const auto swatches = swatches_in_sight();
    ASSERT_GE(swatches.size(), 6u);

    const std::size_t before = calls().size();
    const std::ptrdiff_t commits = told("commit"), asked = told("frame-asked");
    const int clicks = program->state("clicks");
    for (int k = 0; k < kClicks; ++k) {
        const glm::ivec2 at = swatches[static_cast<std::size_t>(k) % swatches.size()];
        desktop->click(at.x, at.y);
        sleep_ms(kBetweenClicks_ms);
    }
    program->wait_for_state("clicks", clicks + kClicks);
    for (const char* keys : {"ctrl+z", "ctrl+z", "ctrl+y"}) program->press_key(keys);
    program->click("tab:Paint");
    program->click("tab:Paints");
    program->move_away();
    const auto after = calls();
    EXPECT_EQ(after.size(), before)
        << "the first: " << after.at(std::min(before, after.size() - 1));
    EXPECT_GE(told("commit") - commits, kClicks / 2) << "nobody clicked";
    EXPECT_GE(told("frame-asked") - asked, kClicks / 2);

    // Whoever puts a file there comes back from another window.
    write_paint("house blue");
    sleep_ms(500);
    EXPECT_FALSE(program->has_item("paint:house blue"));
    desktop->minimise_active_window();
    const ProgramRun again = run_program("/usr/bin/env",
                                         {"LIVERY_HOME=" + home_.path().string(),
                                          LIVERY_PROGRAM,
                                          "desktop",
                                          "--session",
                                          studio->session_file().string()});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(wait_until([&] { return program->has_item("paint:house blue"); }));
    EXPECT_EQ(program->quit(), 0);
}

}  // namespace
}  // namespace livery
