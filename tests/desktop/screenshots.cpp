// Photographs every part of the operator's window, for the documentation and for looking at it:
//     desktop_screenshots FOLDER [vote|seats|report|calibrate]
// writes NAME-1280.png at 1280x800 and NAME-3840.png at 3840x2160; with "vote" those of a presented
// vote alone, with "seats" those of the room, with "report" that of a problem, with "calibrate"
// those of calibrating, at 1280x800.

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "core/image_io.h"
#include "core/paths.h"
#include "desktop/prepared.h"
#include "desktop/studio_program.h"

namespace livery {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class Photographer {
  public:
    Photographer(const fs::path& folder, glm::ivec2 size_px, double ui_scale)
        : folder_(folder), size_px_(size_px), desktop_({size_px, {1280, 800}, false}) {
        document_ = prepare_session(home_ / "session.livery", Quality::normal, kFullProjector_px);
        program_ = std::make_unique<StudioProgram>(
            desktop_, StudioStart{home_ / "session.livery", size_px, ui_scale, {}});
    }

    void take_all() {
        program().click("projector-monitor");
        settle();
        take("projector-choice");
        program().click("monitor:2");
        program().click("part:body");
        program().move_away();
        wait_for_rest();
        take("window");

        program().hover("paint:solid green");
        wait_for_rest();
        take("hover");
        program().move_away();
        program().click("paint-search");
        desktop_.type("1a4f9c");
        settle();
        take("search");
        desktop_.press_key("Escape");
        desktop_.press_key("Escape");

        for (const char* tab : {"Paint", "Light", "Calibrate", "Frame"}) {
            program().click(std::string("tab:") + tab);
            program().move_away();
            wait_for_rest();
            take(fmt::format("tab-{}", lower(tab)));
        }
        program().click("tab:Paints");
        for (const char* view : {"eye", "projector", "photograph"}) {
            program().click(std::string("view:") + view);
            program().move_away();
            wait_for_rest();
            if (view == std::string("photograph")) wait_for_photograph();
            take(fmt::format("view-{}", view));
        }
        program().click("view:preview");
        desktop_.press_key("4");
        desktop_.press_key("1");
        desktop_.press_key("w");
        program().move_away();
        wait_for_rest();
        take("wipe");
        write_png(folder_ / fmt::format("projector-wipe-{}.png", size_px_.x),
                  desktop_.read(desktop_.projector_area()));
        desktop_.press_key("w");
        wait_for_rest();
        desktop_.press_key("b");
        settle();
        take("black");
        desktop_.press_key("b");
        for (const char* menu : {"File", "Edit", "View", "Look", "Projector", "Help"}) {
            program().click(std::string("menu:") + menu);
            settle();
            take(fmt::format("menu-{}", lower(menu)));
            desktop_.press_key("Escape");
        }
        desktop_.press_key("F1");
        settle();
        take("keys");
        desktop_.press_key("Escape");
        desktop_.press_key("ctrl+s");
        settle();
        take("save-picture");
        program().click("file-dialog:cancel");
        settle();
        desktop_.press_key("ctrl+i");
        settle();
        take("import-look");
        program().click("file-dialog:cancel");
        program().click("menu:View");
        program().click("menu:accuracy-page");
        settle();
        program().hover("accuracy:quality:normal");
        settle();
        take("accuracy");
        desktop_.press_key("Escape");
        take_report();
        take_new_session();
        take_ballot();
        take_vote();
        take_calibrating();
        take_nudge();
        take_seats();
        take_capture();
        program().click("show-numbers");
        settle();
        take("monitor-numbers");
        write_png(folder_ / fmt::format("projector-number-{}.png", size_px_.x),
                  desktop_.read(desktop_.projector_area()));
        sleep_ms(5000);
        desktop_.unplug_projector();
        wait_for_rest();
        take("unplugged");
    }

    /// A problem report as it is read, then saved.
    void take_report() {
        program().click("menu:Help");
        program().click("menu:report-problem");
        program().wait_for_state("report", "ready");
        program().click("report:session");
        program().wait_for_state("report", "ready");
        program().move_away();
        settle();
        take("report");
        program().click("report:save");
        program().click("file-dialog:path");
        desktop_.press_key("ctrl+a");
        desktop_.type((home_ / "report.zip").string());
        program().click("file-dialog:ok");
        program().wait_for_state("report", "saved");
        program().move_away();
        settle();
        take("report-saved");
        program().press_key("Escape");
    }

    /// From the looks that are ticked to the lock.
    void take_vote() {
        if (program().state("projector") != "showing") {
            program().click("projector-monitor");
            program().click("monitor:2");
            program().move_away();
            wait_for_rest();
        }
        program().click("menu:File");
        program().click("menu:ballot");
        program().double_click("present:passes");
        desktop_.type("1");
        desktop_.press_key("Tab");
        program().click("phones:start");
        settle();
        program().move_away();
        take("vote-edit");
        program().click("ballot:present");
        wait_for_vote("vote_loaded", true);
        settle();
        take("vote-adapting");
        program().press_key("Next");
        sleep_ms(2000);
        program().move_away();
        take("vote-presenting");
        write_png(folder_ / fmt::format("projector-vote-{}.png", size_px_.x),
                  desktop_.read(desktop_.projector_area()));
        program().press_key("space");
        while (program().state("vote") == "presenting") program().press_key("Next");
        for (int seat = 0; seat < 3; ++seat) {
            program().click("ballot:type-in");
            program().click("ballot:name");
            desktop_.type(fmt::format("Seat {}", seat + 1));
            program().click(fmt::format("ballot:best:{}", seat == 2 ? 3 : 1));
            program().click(fmt::format("ballot:second:{}", seat == 0 ? 3 : 2));
            if (seat == 1) take("vote-typed");
            program().click("ballot:confirm");
            program().click("ballot:overview");
        }
        program().move_away();
        settle();
        take("vote-voting");
        program().click("phones:stop");
        program().click("vote:lock");
        program().click("vote:confirm");
        wait_until([&] { return program().has_item("ballot:verdict"); }, 300s);
        program().item("ballot:verdict");
        program().move_away();
        settle();
        take("vote-locked");
        program().click("vote:done");
        program().click("ballot:close-panel");
        wait_for_rest();
    }

    /// Five in an arc, looked at by the last one.
    void take_seats() {
        program().click("menu:Projector");
        program().click("menu:seats");
        program().click("seats:arc");
        program().click("seats:eye");
        program().click("seats:eye:mean");
        program().click("plan:seat:5");
        if (!wait_until([&] { return program().state("seat_errors") == true; }, 300s)) {
            throw std::runtime_error("what seats miss is not found");
        }
        program().move_away();
        settle();
        take("seats");
        program().click("seats:map");
        program().wait_for_state("seat_map", true);
        program().move_away();
        settle();
        take("seats-map");
        program().click("view:preview");
        program().click("seats:close");
        for (int k = 0; k < 2; ++k) program().press_key("ctrl+z");
        wait_for_rest();
    }

    /// The panel, a calibration under way, the mock-up's lines and the steps with a camera.
    void take_calibrations() {
        program().click("projector-monitor");
        settle();
        program().click("monitor:2");
        program().click("part:body");
        wait_for_rest();
        program().click("tab:Calibrate");
        program().move_away();
        wait_for_rest();
        take("tab-calibrate");
        take_calibrating();
        take_nudge();
        take_capture();
    }

  private:
    StudioProgram& program() { return *program_; }

    void wait_for_vote(const std::string& name, const nlohmann::json& value) {
        if (!wait_until([&] { return program().state(name) == value; }, 300s)) {
            throw std::runtime_error("the vote does not come to " + name);
        }
    }

    void take_new_session() {
        desktop_.press_key("ctrl+n");
        program().item("file-dialog:path");
        desktop_.type(shipped_path("assets/car.glb").string());
        desktop_.press_key("Return");
        program().wait_for_state("new_session_pictured", true);
        program().click("new-session:front:+x");
        program().click("new-session:scale:25");
        // Not where the pictures are taken
        program().click("new-session:file");
        desktop_.press_key("ctrl+a");
        desktop_.type("~/Documents/car.livery");
        desktop_.press_key("Tab");
        program().move_away();
        settle();
        take("new-session");
        program().click("new-session:cancel");
    }

    void take_ballot() {
        program().click("menu:File");
        program().click("menu:ballot");
        settle();
        take("ballot-start");
        program().click("ballot:start");
        settle();
        for (int seat = 0; seat < 3; ++seat) {
            program().click("ballot:name");
            desktop_.type(fmt::format("Seat {}", seat + 1));
            program().click(fmt::format("ballot:best:{}", seat == 2 ? 3 : 1));
            program().click(fmt::format("ballot:second:{}", seat == 0 ? 3 : 2));
            settle();
            if (seat == 0) take("ballot");
            program().click("ballot:confirm");
            settle();
            if (seat == 0) take("ballot-thanks");
            program().click("ballot:next");
            settle();
        }
        program().click("ballot:close");
        settle();
        program().click("ballot:close-confirmed");
        settle();
        take("ballot-result");
        program().click("ballot:close-panel");
    }

    void take_calibrating() {
        program().click("tab:Calibrate");
        settle();
        program().click("calibrate");
        program().move_away();
        sleep_ms(2500);
        take("calibrating");
        program().click("cancel-calibration");
        wait_for_rest();
        program().click("tab:Paints");
    }

    void take_nudge() {
        program().click("menu:Projector");
        program().click("menu:nudge");
        for (int k = 0; k < 3; ++k) program().press_key("Right");
        program().press_key("ctrl+Up");
        program().wait_for_state("nudge_drawn", true);
        settle();
        take("nudge");
        program().click("nudge:start-over");
        program().click("nudge:close");
        program().click("view:preview");
    }

    /// The simulated bench's geometry is found; that takes a minute.
    void take_capture() {
        program().click("menu:Projector");
        program().click("menu:capture");
        program().click("camera");
        program().click("camera:bench:default");
        program().item("capture-geometry");
        program().click("capture-geometry");
        const bool found =
            wait_until([&] { return program().state("capture_steps").contains("geometry"); }, 300s);
        if (!found) throw std::runtime_error("the geometry is not found");
        program().move_away();
        settle();
        take("capture");
        program().click("capture-close");
        wait_for_rest();
    }

    static std::string lower(std::string word) {
        for (char& c : word) c = static_cast<char>(std::tolower(c));
        return word;
    }

    void settle() { sleep_ms(600); }

    /// Until nothing is solved or drawn any more.
    void wait_for_rest() {
        settle();
        const bool rested = wait_until(
            [&] {
                return program().state("finished_number") == program().state("asked_number") &&
                       program().state("unfinished") == "" && program().state("solving") == false &&
                       program().state("busy") == false;
            },
            600s);
        if (!rested) {
            throw std::runtime_error("the program does not come to rest: it " +
                                     program().state("unfinished").dump() + ", frame " +
                                     program().state("finished_number").dump() + " of " +
                                     program().state("asked_number").dump());
        }
        sleep_ms(1500);
    }

    void wait_for_photograph() {
        const bool taken = wait_until(
            [&] {
                return program().state("photograph_number") == program().state("finished_number");
            },
            120s);
        if (!taken) throw std::runtime_error("no photograph was taken");
        settle();
    }

    void take(const std::string& name) {
        const Image8 picture = desktop_.read(desktop_.operator_area());
        write_png(folder_ / fmt::format("{}-{}.png", name, size_px_.x), picture);
        std::cout << name << " " << size_px_.x << std::endl;
    }

    TemporaryFolder home_;
    fs::path folder_;
    glm::ivec2 size_px_;
    Desktop desktop_;
    Document document_;
    std::unique_ptr<StudioProgram> program_;
};

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    const std::string only = argc == 3 ? argv[2] : "";
    if (argc < 2 || argc > 3 ||
        (argc == 3 && only != "vote" && only != "seats" && only != "report" &&
         only != "calibrate")) {
        std::fputs("desktop_screenshots FOLDER [vote|seats|report|calibrate]\n", stderr);
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        const auto at_1280 = [&] { return livery::Photographer(folder, {1280, 800}, 1.0); };
        if (only == "vote") {
            at_1280().take_vote();
        } else if (only == "seats") {
            at_1280().take_seats();
        } else if (only == "report") {
            at_1280().take_report();
        } else if (only == "calibrate") {
            at_1280().take_calibrations();
        } else {
            at_1280().take_all();
            livery::Photographer(folder, {3840, 2160}, 2.0).take_all();
        }
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
