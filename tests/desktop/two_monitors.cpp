#include "desktop/two_monitors.h"

#include <algorithm>
#include <sstream>

#include "core/image_io.h"
#include "core/paths.h"

namespace livery {
namespace {

/// The program's OpenGL compensation may round a level differently from the command line's.
constexpr int level_tolerance = 2;
constexpr double pixels_that_may_differ = 2e-3;

bool has_hue(const Rgb& c, const std::string& hue) {
    if (hue == "red") return c.r > std::max(c.g, c.b) + 15;
    if (hue == "green") return c.g > c.r + 5 && c.g > c.b + 3;
    if (hue == "blue") return c.b > c.r + 15 && c.b > c.g + 5;
    if (hue == "ivory") return c.r > 90 && c.r - c.b > 5 && c.r - c.b < 90 && c.r - c.g < 40;
    throw std::invalid_argument(hue);
}

::testing::AssertionResult same(const Image8& seen, const Image8& wanted) {
    const double different = fraction_different(seen, wanted, level_tolerance);
    if (different <= pixels_that_may_differ) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << 100.0 * different
           << "% of the projector's pixels are wrong; seen: " << saved(seen, "seen")
           << ", wanted: " << saved(wanted, "wanted");
}

std::shared_ptr<RunningStudio> shared_studio;

}  // namespace

std::string saved(const Image8& picture, const std::string& name) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const auto file = std::filesystem::path(::testing::TempDir()) /
                      ("livery-" + std::string(test->name()) + "-" + name + ".png");
    write_png(file, picture);
    return file.string();
}

void TwoMonitors::use(std::shared_ptr<RunningStudio> running) {
    studio = std::move(running);
    document = studio->document;
    desktop = studio->desktop.get();
    program = studio->program.get();
}

void TwoMonitors::start(const DesktopOptions& options, const std::vector<std::string>& arguments) {
    auto running = std::make_shared<RunningStudio>();
    running->document =
        prepare_session(running->session_file(), Quality::draft, options.projector_px);
    // The user's settings outlive a session: nobody has picked a projector yet.
    std::filesystem::remove(user_folder() / "desktop.json");
    running->desktop = std::make_unique<Desktop>(options);
    use(running);
    start_program(arguments);
}

void TwoMonitors::start_program(const std::vector<std::string>& arguments) {
    studio->program.reset();
    StudioStart how;
    how.more_arguments = arguments;
    how.session = studio->session_file();
    how.refines = refines;
    studio->program = std::make_unique<StudioProgram>(*desktop, how);
    program = studio->program.get();
}

void TwoMonitors::start_at_home(const std::string& settings) {
    auto running = std::make_shared<RunningStudio>();
    running->document = prepare_session(running->session_file());
    home = running->folder / "home";
    make_output_folder(home);
    write_text_file(home / "desktop.json", settings);
    running->desktop = std::make_unique<Desktop>(small_projector());
    use(running);
    start_program_at_home();
}

void TwoMonitors::start_program_at_home() {
    ::setenv("LIVERY_HOME", home.c_str(), 1);
    start_program();
}

void TwoMonitors::pick_projector() {
    program->click("projector-monitor");
    program->click("monitor:2");
    program->move_away();
}

void TwoMonitors::use_shared() {
    if (shared_studio) {
        use(shared_studio);
    } else {
        start();
        pick_projector();
        program->click("part:body");
        program->move_away();
        studio->first_undo = program->state("undo");
        shared_studio = studio;
    }
    ASSERT_TRUE(projector_shows(drive_of_place(0)));
}

void TwoMonitors::TearDown() {
    if (!studio || studio != shared_studio) return;
    if (HasFailure()) {
        shared_studio.reset();
        return;
    }
    // The mock-up comes first, the window's map follows: what it says may be of before the test's
    // last key, and one undo too many would take the calibration away.
    program->press_key("Escape");
    if (program->has_item("paint-search-clear")) program->click("paint-search-clear");
    program->move_away();
    while (program->state("undo") != shared_studio->first_undo) program->press_key("ctrl+z");
    desktop->press_key("1");
}

void TwoMonitors::TearDownTestSuite() { shared_studio.reset(); }

::testing::AssertionResult TwoMonitors::projector_shows_now(const Image8& wanted) {
    return same(projector_picture(), wanted);
}

::testing::AssertionResult TwoMonitors::projector_shows(const Image8& wanted) {
    Image8 seen;
    wait_until([&] {
        seen = projector_picture();
        return fraction_different(seen, wanted, level_tolerance) <= pixels_that_may_differ;
    });
    return same(seen, wanted);
}

::testing::AssertionResult TwoMonitors::projector_is_black() {
    const Rectangle area = desktop->projector_area();
    return projector_shows(Image8(area.width, area.height, 3));
}

Image8 TwoMonitors::stage_picture() { return desktop->read(program->item("stage")); }

Rgb TwoMonitors::painted_colour() {
    const Rectangle stage = program->item("stage");
    // The car's door, where the preview's camera starts.
    return mean_colour(
        desktop->read({stage.x + stage.width / 2 - 8, stage.y + stage.height / 2 - 8, 16, 16}),
        {0, 0, 16, 16});
}

::testing::AssertionResult TwoMonitors::operator_sees(const std::string& hue) {
    Rgb seen;
    const bool right = wait_until([&] {
        seen = painted_colour();
        return has_hue(seen, hue);
    });
    if (right) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << "the operator sees " << seen << " instead of " << hue << ": "
           << saved(desktop->read(desktop->operator_area()), "operator");
}

Image8 TwoMonitors::drive_with_body(const std::string& paint) {
    return expected_drive(document, look_at_place(0), "body", paint);
}

}  // namespace livery
