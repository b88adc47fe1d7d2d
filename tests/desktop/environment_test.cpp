// A map of a room from a file, as `livery measure environment` writes it: chosen in the window, and
// turned while the mock-up follows.
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "desktop/two_monitors.h"
#include "session/session.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

class RoomMap : public TwoMonitors {
  protected:
    /// A dim room with one bright wall.
    std::filesystem::path written_map() {
        ImageF map(64, 32, 3);
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                const bool wall = x >= 8 && x < 20 && y >= 8 && y < 18;
                for (int c = 0; c < 3; ++c) {
                    map.values[3 * (static_cast<std::size_t>(y) * 64 +
                                    static_cast<std::size_t>(x)) +
                               static_cast<std::size_t>(c)] = wall ? 6.0f : 0.15f;
                }
            }
        }
        const auto file = studio->folder / "room.exr";
        write_exr(file, map);
        return file;
    }
    EnvironmentReference kept() {
        return Session::open(studio->session_file()).document().looks.front().look.environment;
    }
    Image8 drive_in(const EnvironmentReference& environment) {
        Document other = document;
        other.looks.front().look.environment = environment;
        return expected_drive(other, look_at_place(0));
    }
};

TEST_F(RoomMap, NightlyIsChosenFromAFileAndTurnsWhileTheMouseMoves) {
    start();
    pick_projector();
    ASSERT_TRUE(projector_shows(drive_of_place(0)));
    const std::filesystem::path file = written_map();
    program->click("tab:Light");
    program->click("environment");
    program->click("environment:file");
    program->click("file-dialog:path");
    desktop->press_key("ctrl+a");
    desktop->type(file.string());
    program->click("file-dialog:ok");
    program->wait_for_state("undo", "Change environment of " + document.looks.front().look.name);
    program->move_away();
    EnvironmentReference chosen = document.looks.front().look.environment;
    chosen.file = file.string();
    const Image8 before = drive_in(chosen);
    EXPECT_TRUE(projector_shows(before));

    // --- held, every step shows ---
    const glm::ivec2 tab = middle(program->item("tab:Light"));
    program->scroll({tab.x, tab.y + 200}, -40);
    const glm::ivec2 slider = middle(program->item("environment-rotation"));
    desktop->move_pointer(slider.x, slider.y);
    desktop->press_button();
    Image8 seen = projector_picture();
    for (int step = 1; step <= 4; ++step) {
        desktop->move_pointer(slider.x + 12 * step, slider.y);
        Image8 now;
        EXPECT_TRUE(wait_until([&] {
            now = projector_picture();
            return fraction_different(now, seen, 2) > 1e-3;
        })) << "step "
            << step;
        seen = now;
    }
    desktop->release_button();
    // Coarser while it moved: let go, it is drawn as the session has it.
    Image8 turned;
    ASSERT_TRUE(wait_until([&] {
        turned = projector_picture();
        sleep_ms(2000);
        return program->state("shown_number") == program->state("asked_number") &&
               fraction_different(projector_picture(), turned, 0) == 0.0;
    }));

    // --- one drag is one step back ---
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(before));
    desktop->press_key("ctrl+shift+z");
    EXPECT_TRUE(projector_shows(turned));
    EXPECT_EQ(program->quit(), 0);
    EXPECT_EQ(kept().file, chosen.file);
    EXPECT_GT(std::abs(kept().rotation_rad), 0.05);
    EXPECT_LE(fraction_different(turned, drive_in(kept()), 2), 2e-3);
}

}  // namespace
}  // namespace livery
