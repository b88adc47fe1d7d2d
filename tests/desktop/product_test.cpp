// A product of one's own, from a scan on the disk to the mock-up, and other sessions in the same
// window.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "core/json.h"
#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "mesh/scan_writer.h"
#include "session/session.h"
#include "support/child_process.h"
#include "support/screen_watch.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// A body with a cabin, as a scanner gives it: in metres, z up, somewhere in the room, no normals.
/// About 2 `rings`^2 triangles.
ScanWriter car_scan(int rings) {
    ScanWriter scan;
    const double pi = std::numbers::pi;
    for (int i = 0; i <= rings; ++i) {
        const double along = pi * i / rings;
        for (int k = 0; k < rings; ++k) {
            const double around = 2.0 * pi * k / rings;
            const double x = -std::cos(along),
                         round = std::pow(std::max(0.0, std::sin(along)), 0.4);
            const double cabin = std::exp(-6.0 * (x + 0.1) * (x + 0.1));
            const double up = std::sin(around) * round;
            const double z = 0.45 + 0.4 * up + (up > 0.0 ? 0.65 * cabin * up : 0.0);
            scan.positions.emplace_back(12.0 + 2.3 * x, -3.0 + 0.95 * std::cos(around) * round, z);
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < rings; ++k) {
            const int next = (k + 1) % rings;
            const int a = i * rings + k, b = i * rings + next;
            scan.faces.push_back({a, b, b + rings});
            scan.faces.push_back({a, b + rings, a + rings});
        }
    }
    return scan;
}

class OwnProduct : public TwoMonitors {
  protected:
    std::filesystem::path write_scan(int rings) {
        const auto file = studio->folder / "carscan.ply";
        std::ofstream(file, std::ios::binary) << car_scan(rings).binary_ply(std::endian::little);
        return file;
    }
    std::filesystem::path made_session() { return program->state("session").get<std::string>(); }
    /// Made by a test: gone when it starts.
    void start_afresh() {
        start();
        std::filesystem::remove_all(default_session_file().parent_path());
        pick_projector();
        ASSERT_TRUE(projector_shows(drive_of_place(0)));
    }
    bool projector_is_lit() {
        const Image8 seen = projector_picture();
        std::size_t lit = 0;
        for (const auto value : seen.values) lit += value > 30 ? 1 : 0;
        return lit > seen.values.size() / 200;
    }
    void type_into_dialog(const std::filesystem::path& file) {
        program->item("file-dialog:path");
        desktop->type(file.string());
        desktop->press_key("Return");
    }
    bool is_told(const std::string& words) {
        return wait_until(
            [&] { return program->state("notices").dump().find(words) != std::string::npos; });
    }
    bool goes_on_with(const std::filesystem::path& file) {
        return wait_until([&] { return made_session() == file; });
    }
    void open(const std::filesystem::path& file) {
        program->press_key("ctrl+o");
        type_into_dialog(file);
    }
    /// Nothing of the desktop behind has this colour otherwise.
    void paint_desktop_red() {
        ChildOptions options;
        options.arguments = {"xsetroot", "-solid", "#ff0000"};
        options.output = studio->folder / "xsetroot";
        ASSERT_EQ(ChildProcess(options).wait(20s), 0) << tail_of(options.output);
    }
};

bool has_red(const Image8& picture) {
    for (std::size_t k = 0; k < picture.pixel_count(); ++k) {
        const auto* rgb = &picture.values[3 * k];
        if (rgb[0] == 255 && rgb[1] == 0 && rgb[2] == 0) return true;
    }
    return false;
}

TEST_F(OwnProduct, OtherSessionsComeInTheSameWindowWhileTheProjectorStaysDark) {
    start_afresh();
    paint_desktop_red();
    const auto first = studio->session_file(), second = studio->folder / "second.livery";
    const auto broken = studio->folder / "broken.livery";
    prepare_session(second);
    std::ofstream(broken) << "not a session";

    open(broken);
    EXPECT_TRUE(is_told("The session broken.livery was not opened."));
    EXPECT_EQ(made_session(), first);
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    {
        const Session elsewhere = Session::open(second);
        open(second);
        EXPECT_TRUE(is_told("The session second.livery was not opened."));
        EXPECT_EQ(made_session(), first);
    }
    const auto windows_before = desktop->windows();
    ScreenWatch watch(*desktop, desktop->projector_area(), has_red);
    open(second);
    ASSERT_TRUE(goes_on_with(second));
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    const auto seen = watch.stop();
    EXPECT_GT(seen.looks, 10);
    EXPECT_EQ(seen.wrong, 0) << "the desktop was on the projector";
    // What kept the projector dark goes when the window has heard of the picture.
    EXPECT_TRUE(wait_until([&] { return desktop->windows().size() == windows_before.size(); }));

    // What is done now belongs to the second.
    program->press_key("ctrl+d");
    program->wait_for_state("looks", document.looks.size() + 1);
    program->press_key("b");
    program->wait_for_state("black", true);
    program->click("menu:File");
    program->click("menu:recent");
    program->click("recent:session");
    ASSERT_TRUE(goes_on_with(first));
    program->wait_for_state("looks", document.looks.size());
    EXPECT_EQ(program->state("black"), true) << "it was black before";
    EXPECT_TRUE(projector_is_black());
    program->press_key("b");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    EXPECT_EQ(program->quit(), 0);
    EXPECT_EQ(Session::open(second).document().looks.size(), document.looks.size() + 1);
}

TEST_F(OwnProduct, AMeshOnTheCommandLineBeginsANewSession) {
    start();
    const auto kept = studio->session_file();
    start_program({write_scan(20).string()});
    ASSERT_TRUE(wait_until([&] { return program->state("new_session") == "asking"; }));
    program->press_key("Escape");
    program->wait_for_state("new_session", "closed");
    EXPECT_EQ(made_session(), kept);
    EXPECT_EQ(program->quit(), 0);

    // One that is not there yet is made of the mesh, not of the shipped car.
    studio->program.reset();
    StudioStart how;
    how.session = studio->folder / "van.livery";
    how.more_arguments = {write_scan(20).string()};
    studio->program = std::make_unique<StudioProgram>(*desktop, how);
    program = studio->program.get();
    ASSERT_TRUE(wait_until([&] { return program->state("new_session") == "asking"; }));
    EXPECT_FALSE(std::filesystem::exists(how.session));
    program->click("new-session:front:+x");
    program->click("new-session:turn");
    program->click("new-session:scale:10");
    program->click("new-session:of:model");
    program->click("new-session:create");
    ASSERT_TRUE(goes_on_with(how.session));
    const Json product = read_json_file(studio->folder / "van.product.json");
    EXPECT_EQ(product["product_scale"], 10);
    EXPECT_EQ(product["mesh_scale"], 1);
    EXPECT_EQ(product["front"], "-z");
    EXPECT_EQ(product["mesh"], "carscan.ply");
    EXPECT_EQ(program->quit(), 0);
}

TEST_F(OwnProduct, NightlyNothingRunsBehindThePageOfAMeshAndWhatRunsIsNotStoppedUnasked) {
    auto running = std::make_shared<RunningStudio>();
    const auto first = running->session_file(), second = running->folder / "second.livery";
    // A first start: nothing was calibrated.
    ::setenv("LIVERY_HOME", (running->folder / "home").c_str(), 1);
    Session::open(first);
    Session::open(second);
    running->desktop = std::make_unique<Desktop>(DesktopOptions{.projector_px = kFullProjector_px});
    use(running);
    const auto scan = write_scan(20);
    start_program({scan.string()});
    ASSERT_TRUE(wait_until([&] { return program->state("new_session") == "asking"; }));
    program->wait_for_state("new_session_pictured", true);
    program->wait_for_state("busy", false);
    sleep_ms(1500);
    EXPECT_EQ(program->state("asked_number"), 0);
    EXPECT_EQ(program->state("preview_number"), 0);
    EXPECT_EQ(program->state("calibrating"), false);
    program->press_key("Escape");
    program->wait_for_state("calibrating", true);
    EXPECT_NE(program->state("asked_number"), 0);

    const char* const asked = "A calibration is running";
    for (const bool by_key : {false, true}) {
        open(second);
        program->wait_for_state("question", asked);
        if (by_key) {
            program->press_key("Escape");
        } else {
            program->item("question:cancel");
            saved(desktop->read(desktop->operator_area()), "question");
            program->click("question:cancel");
        }
        program->wait_for_state("question", "");
        EXPECT_EQ(made_session(), first);
        EXPECT_EQ(program->state("calibrating"), true);
    }
    open(second);
    program->click("question:ok");
    ASSERT_TRUE(goes_on_with(second));

    program->wait_for_state("calibrating", true);
    program->press_key("ctrl+n");
    type_into_dialog(scan);
    program->click("new-session:create");
    program->wait_for_state("question", asked);
    program->click("question:cancel");
    program->wait_for_state("question", "");
    EXPECT_EQ(program->state("new_session"), "asking") << "the answers are still there";
    EXPECT_EQ(program->state("calibrating"), true);
    program->click("new-session:create");
    program->click("question:ok");
    ASSERT_TRUE(wait_until([&] { return made_session().filename() == "carscan.livery"; }));
    EXPECT_EQ(program->quit(), 0);
}

TEST_F(OwnProduct, NightlyAScanOfAMillionTrianglesIsOnTheMockUpInAFewClicks) {
    start_afresh();
    const auto scan = write_scan(708);
    const auto began = std::chrono::steady_clock::now();
    const int clicks_before = program->state("clicks");
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    program->click("menu:File");
    program->click("menu:new-session");
    type_into_dialog(scan);
    ASSERT_TRUE(wait_until([&] { return program->state("new_session") == "asking"; }))
        << program->state("new_session_says");
    std::cout << "the scan is read after " << seconds() << " s\n";
    program->wait_for_state("new_session_pictured", true);
    program->item("new-session:create");
    EXPECT_TRUE(program->has_item("new-session:lit"));
    saved(desktop->read(desktop->operator_area()), "page");
    program->click("new-session:part:0");
    desktop->press_key("ctrl+a");
    desktop->type("body");
    program->click("new-session:create");
    ASSERT_TRUE(wait_until([&] { return made_session().filename() == "carscan.livery"; }));
    std::cout << "its session is open after " << seconds() << " s\n";
    ASSERT_TRUE(wait_until([&] { return program->state("shown_number") != 0; }));
    EXPECT_TRUE(wait_until([&] { return projector_is_lit(); }));
    std::cout << "it is on the mock-up after " << seconds() << " s and "
              << program->state("clicks").get<int>() - clicks_before << " clicks\n";
    EXPECT_TRUE(program->has_item("part:body"));
    EXPECT_TRUE(wait_until([&] { return program->state("preview_number") != 0; }));
    std::cout << "and in the window after " << seconds() << " s\n";
    sleep_ms(1000);
    saved(desktop->read(desktop->operator_area()), "window");
    saved(projector_picture(), "projector");

    const Json product = read_json_file(made_session().replace_extension(".product.json"));
    EXPECT_EQ(product["unit"], "m");
    EXPECT_EQ(product["product_scale"], 25);
    EXPECT_EQ(product["part_names"], Json::object({{"scan", "body"}}));
    EXPECT_EQ(program->quit(), 0);
}

}  // namespace
}  // namespace livery
