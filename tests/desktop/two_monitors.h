// A test with an operator's monitor, a projector and the running program.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/image.h"
#include "desktop/prepared.h"
#include "desktop/studio_program.h"
#include "support/desktop.h"
#include "support/temporary_folder.h"

namespace livery {

/// A desktop with the program on it. Starting both takes seconds, so tests share one as long as
/// each leaves it as it found it.
struct RunningStudio {
    TemporaryFolder folder;
    Document document;  ///< as the session starts with
    std::unique_ptr<Desktop> desktop;
    std::unique_ptr<StudioProgram> program;
    nlohmann::json first_undo;  ///< what undo would undo when everything is as at the start

    std::filesystem::path session_file() const { return folder / "session.livery"; }
};

/// Saves what was seen where the log of a test run can point to it; the file.
std::string saved(const Image8& picture, const std::string& name);

/// A desktop with the projector of prepare_session().
inline DesktopOptions small_projector() {
    DesktopOptions options;
    options.projector_px = kSmallProjector_px;
    return options;
}

class TwoMonitors : public ::testing::Test {
  protected:
    /// A program of the test's own; the projector is not picked yet.
    void start(const DesktopOptions& options = small_projector(),
               const std::vector<std::string>& arguments = {});
    void start_program(const std::vector<std::string>& arguments = {});
    /// The same in a home of its own with these settings (JSON): ballots are the user's. What is
    /// expected of pictures is made in another one.
    void start_at_home(const std::string& settings);
    void start_program_at_home();
    /// Another desktop and session from here on; its program is not started.
    void use(std::shared_ptr<RunningStudio> running);
    void pick_projector();
    /// Projects the first look, body selected, on a plain desktop: the shared program unless a
    /// test before this one failed.
    void use_shared();
    /// Puts the shared program back to how use_shared() gave it.
    void TearDown() override;
    static void TearDownTestSuite();

    /// Waits until the projector shows this picture.
    ::testing::AssertionResult projector_shows(const Image8& wanted);
    /// Looks once.
    ::testing::AssertionResult projector_shows_now(const Image8& wanted);
    ::testing::AssertionResult projector_is_black();
    Image8 projector_picture() { return desktop->read(desktop->projector_area()); }

    /// The picture in the middle of the operator's window.
    Image8 stage_picture();
    /// Mean colour of the car's painted part there.
    Rgb painted_colour();
    /// Waits until the paint in the operator's window has this hue: "red", "blue", "green" or
    /// "ivory".
    ::testing::AssertionResult operator_sees(const std::string& hue);

    /// What the projector should show for the prepared session's look with another body paint.
    Image8 drive_with_body(const std::string& paint);
    /// Look at this place of the list, as the session starts with.
    int look_at_place(std::size_t place) const { return document.looks.at(place).id; }
    Image8 drive_of_place(std::size_t place) {
        return expected_drive(document, look_at_place(place));
    }

    std::filesystem::path home;  ///< of start_at_home()
    bool refines = false;        ///< as StudioStart has it, from the next start on
    std::shared_ptr<RunningStudio> studio;
    // Shorthands for the studio's.
    Document document;
    Desktop* desktop = nullptr;
    StudioProgram* program = nullptr;
};

}  // namespace livery
