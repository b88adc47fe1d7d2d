// Captures with a still camera that photographs what stands on the projector's monitor: in the
// window, and in a terminal.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/comparison.h"
#include "live/projector_setup.h"
#include "mesh/ply_write.h"
#include "scene/mockup_mask.h"
#include "session/commands.h"
#include "session/session.h"
#include "session/small_session.h"
#include "support/kept_light.h"
#include "support/monitor_bench.h"
#include "support/run_program.h"

namespace livery {
namespace {

using namespace std::chrono_literals;
using testing::MonitorBench;
using testing::PtpMishap;
using testing::small_bench_description;
using testing::small_bench_product;
using testing::smooth_colours;

constexpr int pause_ms = 1500;        ///< the pictures before it have long been photographed
constexpr int most_of_a_picture = 2;  ///< photographs of it
constexpr int settling = 6;           ///< photographs of a picture that is shown anew

const BenchDescription& description() {
    static const BenchDescription small = small_bench_description();
    return small;
}

CalibrationSettings request() {
    CalibrationSettings request;
    request.made_with = "the bench directly";
    request.product = small_bench_product();
    request.projector = description().projector.view;
    request.width = request.projector->width;
    request.height = request.projector->height;
    return request;
}

/// Two that differ in their noise.
struct DirectCalibrations {
    ColourCalibration first, again;
};
const DirectCalibrations& directly() {
    static const DirectCalibrations made = [] {
        Bench bench = testing::bench_on_kept_light(description(), small_bench_product());
        BenchPorts ports = bench.ports();
        ports.measure_xyz = {};  // Nobody in the window has a colorimeter either.
        const auto calibrate = [&] {
            return calibrate_through_ports(ports, request(), {}).calibration;
        };
        DirectCalibrations calibrations{calibrate(), {}};
        calibrations.again = calibrate();
        return calibrations;
    }();
    return made;
}

class CameraBeforeMonitor : public TwoMonitors {
  protected:
    /// A session that was calibrated on the bench directly, the small projector picked.
    void SetUp() override {
        auto running = std::make_shared<RunningStudio>();
        home_ = running->folder / "home";
        ::setenv("LIVERY_HOME", home_.c_str(), 1);
        ::setenv("HOME", home_.c_str(), 1);  // libgphoto2 writes there
        Session session = Session::open(running->session_file());
        session.execute(SetQuality{Quality::draft});
        CalibrationResult kept;
        kept.calibration = directly().first;
        kept.projector = request().projector;
        session.execute(SetCalibration{keep_calibration(kept, request()).string()});
        running->document = session.document();
        DesktopOptions options;
        options.projector_px = {request().width, request().height};
        running->desktop = std::make_unique<Desktop>(options);
        use(running);
        room = std::make_unique<MonitorBench>(*desktop, description(), small_bench_product());
    }
    void TearDown() override {
        if (HasFailure() && program)
            std::printf("%s\n%s\n",
                        saved(desktop->read(desktop->operator_area()), "operator").c_str(),
                        program->words().c_str());
        ::unsetenv("LIVERY_HOME");
    }

    /// Opens the capture and connects to the camera by its address.
    void connect() {
        program->click("menu:Projector");
        program->click("menu:capture");
        program->click("camera-address");
        program->press_key("ctrl+a");
        desktop->type(room->camera().port());
        program->click("camera-connect");
        program->wait_for_state("capture", "watching");
    }
    void type_data_sheets() {
        const DataSheets sheets = description().data_sheets.value();
        const auto type = [&](const char* item, double value) {
            program->click(item);
            program->press_key("ctrl+a");
            desktop->type(fmt::format("{}", value));
            program->press_key("Return");
        };
        type("sheet-throw", sheets.throw_ratio);
        type("sheet-shift", sheets.lens_shift);
        type("sheet-focal", sheets.focal_mm);
        type("sheet-sensor", sheets.sensor_width_mm);
        type("sheet-distance", sheets.lens_distance_mm);
    }
    bool done(const std::string& step) {
        return program->state("capture_steps").contains(step) &&
               program->state("capture") != "capturing";
    }
    std::string says() { return program->state("capture_says").get<std::string>(); }
    /// Waits until the column says something with these words in it.
    ::testing::AssertionResult says(const std::string& words) {
        std::string said;
        const bool right = wait_until([&] {
            said = says();
            return said.find(words) != std::string::npos;
        });
        if (right) return ::testing::AssertionSuccess();
        return ::testing::AssertionFailure() << "it says \"" << said << "\", not " << words;
    }
    bool photographed(int count) {
        return wait_until([&] { return room->camera().photographs() >= count; });
    }
    /// Photographs of the capture that are on the disk.
    int kept() const {
        const std::filesystem::directory_iterator one(home_ / "captures");
        const Json recording = read_json_file(one->path() / "recording.json");
        std::size_t count = 0;
        for (const Json& showing : recording["showings"]) count += showing["photographs"].size();
        return static_cast<int>(count);
    }

    /// CIEDE2000 between what an observer sees of colours on the mock-up that are corrected
    /// with this calibration and with the one that was made on the bench directly.
    ErrorStatistics difference(const ColourCalibration& calibration) const {
        const Image8 mockup = mockup_mask(request().product->mesh, *request().projector);
        ImageF wanted = smooth_colours(mockup.width, mockup.height, 7);
        for (std::size_t i = 0; i < mockup.values.size(); ++i)
            wanted.values[4 * i + 3] = mockup.values[i] ? 1.0f : 0.0f;
        const Bench& bench = room->bench();
        ComparisonMasks masks{bench.truth().lit,
                              bench.truth().edge,
                              mockup,
                              Image8(mockup.width, mockup.height, 1, 255)};
        const auto seen = [&](const ColourCalibration& one) {
            for (std::size_t i = 0; i < mockup.values.size(); ++i)
                if (!is_valid(static_cast<PixelStatus>(one.status.values[i])))
                    masks.valid.values[i] = 0;
            const double white_y = design_white_luminance(one, 20.0, mockup);
            return bench.observe_xyz(compensate(bake(one, white_y), wanted));
        };
        const ImageF of_direct = seen(directly().first), of_this = seen(calibration);
        float white_y = 0.0f;
        for (std::size_t i = 0; i < mockup.values.size(); ++i)
            white_y = std::max(white_y, of_direct.values[3 * i + 1]);
        const Comparison comparison =
            compare_xyz(of_direct, of_this, static_cast<double>(white_y) * d65_xyz(), masks);
        EXPECT_GT(comparison.interior.pixels, 1000u);
        return comparison.interior;
    }

    /// It corrects as well as that of the bench itself.
    void expect_close(const ColourCalibration& captured) const {
        const ErrorStatistics noise = difference(directly().again), seen = difference(captured);
        std::printf(
            "    CIEDE2000 from the bench directly: mean %.4f, p95 %.4f; of its noise %.4f, %.4f\n",
            seen.mean,
            seen.p95,
            noise.mean,
            noise.p95);
        // Besides the noise: the nearest shutter speed, which is a shorter one
        EXPECT_LT(seen.mean, 2.0 * noise.mean);
    }

    /// Waits for the end of the capture; its calibration is then the session's, and corrects as
    /// well as that of the bench itself.
    void expect_as_direct() {
        const std::string before = document.calibration;
        ASSERT_TRUE(wait_until([&] { return program->has_item("accept"); })) << says();
        EXPECT_EQ(program->state("calibration"), before) << "nobody has accepted the new one";
        program->click("accept");
        ASSERT_TRUE(wait_until([&] { return program->state("calibration") != before; }));
        document.calibration = program->state("calibration").get<std::string>();
        EXPECT_EQ(says(), "");
        expect_close(read_calibration(document.calibration));
    }

    /// A button that moves away under the pointer, as words above it come and go, is clicked again.
    void pause_or_go_on(bool paused) {
        const auto done = [&] { return program->state("capture_paused") == paused; };
        for (int attempt = 0; attempt < 3 && !done(); ++attempt) {
            program->click("capture-pause");
            wait_until(done, std::chrono::seconds(5));
        }
        program->wait_for_state("capture_paused", paused);
    }

    std::unique_ptr<MonitorBench> room;

  private:
    std::filesystem::path home_;
};

TEST_F(CameraBeforeMonitor, NightlyCalibratesAsTheBenchDoes) {
    start_program();
    pick_projector();
    connect();
    program->click("preflight");
    ASSERT_TRUE(photographed(15));
    program->wait_for_state("capture", "watching");
    EXPECT_EQ(says(), "");
    const nlohmann::json preflight = program->state("preflight");
    EXPECT_GT(preflight.size(), 8u);
    for (const auto& [line, grade] : preflight.items()) EXPECT_NE(grade, "Bad") << line;

    const int before = room->camera().photographs();
    const double shutter_s = room->shutter_s();
    program->click("capture-next-step");
    expect_as_direct();
    EXPECT_EQ(room->camera().on_card(), 0u);
    const auto times = program->state("capture_times").get<std::vector<double>>();
    std::printf(
        "    %d photographs in %.2f s: %.2f s in the camera (%.2f s its shutter), %.2f s in the "
        "projector, %.0f%% more\n",
        room->camera().photographs() - before,
        times[0],
        times[1],
        room->shutter_s() - shutter_s,
        times[2],
        100.0 * (times[0] / (times[1] + times[2]) - 1.0));

    // The mock-up is lit with it.
    program->click("capture-close");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    EXPECT_EQ(program->quit(), 0) << program->words();
}

TEST_F(CameraBeforeMonitor, CalibratesFromTheTerminalAsTheBenchDoes) {
    const auto calibration = studio->folder / "calibration";
    const ProgramRun run =
        run_program(LIVERY_PROGRAM,
                    {"capture",
                     "--camera",
                     "tethered:" + room->camera().port(),
                     "--monitor",
                     "2",
                     "--product",
                     "car",
                     "--pose",
                     (std::filesystem::path(document.calibration) / "projector.json").string(),
                     "--no-preflight",
                     "--out",
                     (studio->folder / "captures").string(),
                     "--calibration",
                     calibration.string()});
    ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
    expect_close(read_calibration(calibration));
    EXPECT_EQ(room->camera().on_card(), 0u);
}

/// How far a calibration draws the mock-up from where it stands, in projector pixels.
ErrorStatistics off_its_place(const std::filesystem::path& calibration, const Bench& bench) {
    const Mesh& mesh = small_bench_product()->mesh;
    return picture_offset(*request().projector,
                          mesh,
                          projector_view_of(calibration).value(),
                          mesh,
                          bench.truth().lit);
}

// docs/first-session.md, "In the window": where everything stands is found from photographs.
TEST_F(CameraBeforeMonitor, FirstSessionInTheWindowTakesFivePresses) {
    start_program();
    pick_projector();
    connect();
    program->click("place-found");
    type_data_sheets();
    const std::string before = document.calibration;
    // Five presses of one button: it names what comes next.
    double wizard_s = 0.0, photographing_s = 0.0;
    for (const char* step : {"look", "geometry", "colour", "check"}) {
        SCOPED_TRACE(step);
        program->wait_for_state("capture_next", step);
        const auto pressed = std::chrono::steady_clock::now();
        program->click("capture-next-step");
        ASSERT_TRUE(wait_until([&] { return program->state("capture_next") != step; }, 120s))
            << says();
        program->wait_for_state("capture", "watching");
        ASSERT_EQ(says(), "");
        const double step_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - pressed).count();
        const auto times = program->state("capture_times").get<std::vector<double>>();
        std::printf("    %s %.1f s, captured %.1f s so far\n", step, step_s, times.at(0));
        wizard_s += step_s;
        photographing_s = times.at(0);
    }
    std::printf("    wizard %.1f s, of which capture %.1f s\n", wizard_s, photographing_s);
    EXPECT_EQ(program->state("calibration"), before) << "nobody has accepted the new one";
    program->click("accept");
    ASSERT_TRUE(wait_until([&] { return program->state("calibration") != before; }));
    const auto accepted = program->state("calibration").get<std::string>();
    const ErrorStatistics off = off_its_place(accepted, room->bench());
    std::printf("    picture off its place %.3f / %.3f px\n", off.median, off.p95);
    EXPECT_LT(off.median, 0.5);
    EXPECT_LT(off.p95, 1.0);
    const nlohmann::json steps = program->state("capture_steps");
    for (const auto& [step, grade] : steps.items()) EXPECT_NE(grade, "Bad") << step;

    // The next day, and back.
    program->click("look-for-drift");
    ASSERT_TRUE(wait_until([&] { return program->has_item("drift"); })) << says();
    EXPECT_NE(program->state("capture_drift"), "Bad");
    program->click("revert");
    ASSERT_TRUE(wait_until([&] { return program->state("calibration") == before; }));
    EXPECT_EQ(program->quit(), 0) << program->words();
}

/// Presses of mouse buttons by which a person gets there; what is typed is not counted.
class Presses {
  public:
    explicit Presses(StudioProgram& program) : program_(program) {}
    void operator()(const char* item) {
        program_.click(item);
        ++count_;
    }
    int count() const { return count_; }

  private:
    StudioProgram& program_;
    int count_ = 0;
};

// Another camera beside the first has a geometry and colours of its own, and so has a third, whose
// photographs are copied into a folder.
TEST_F(CameraBeforeMonitor, NightlyAnotherCameraTakesEightPressesToTheColours) {
    constexpr int most_presses = 8;
    start_program();
    pick_projector();
    connect();
    program->click("place-found");
    type_data_sheets();
    program->click("capture-geometry");
    ASSERT_TRUE(wait_until([&] { return done("geometry"); }, 120s)) << says();
    EXPECT_EQ(program->state("capture_next"), "colour") << "nobody asks for a look any more";
    program->click("capture-close");

    MonitorBench beside(*desktop, description(), small_bench_product());
    Presses press(*program);
    press("menu:Projector");
    press("menu:capture");
    program->click("camera-address");
    program->press_key("ctrl+a");
    desktop->type(beside.camera().port());
    press("camera-connect");
    program->wait_for_state("capture", "watching");
    for (const char* step : {"look", "geometry", "colour"}) {
        program->wait_for_state("capture_next", step);
        press("capture-next-step");
        ASSERT_TRUE(wait_until([&] { return done(step); }, 120s)) << says();
    }
    EXPECT_LE(press.count(), most_presses);
    EXPECT_GT(beside.camera().photographs(), 90);
    program->click("capture-close");

    const auto card = studio->folder / "card";
    std::filesystem::create_directories(card);
    Presses by_hand(*program);
    by_hand("menu:Projector");
    by_hand("menu:capture");
    by_hand("camera");
    by_hand("camera:folder");
    program->click("file-dialog:path");
    program->press_key("ctrl+a");
    desktop->type(card.string());
    by_hand("file-dialog:ok");
    // Its geometry comes of the same photographs.
    program->wait_for_state("capture_next", "colour");
    by_hand("capture-next-step");
    const auto ended = [&] { return done("colour") || !says().empty(); };
    std::string last;
    for (;;) {
        std::string stage;
        ASSERT_TRUE(wait_until(
            [&] {
                stage = program->state("capture_stage").get<std::string>();
                return ended() || (stage.starts_with("shoot") && stage != last);
            },
            120s));
        if (ended()) break;
        last = stage;
        const testing::PtpPicture picture =
            beside.photograph({.exposure_s = beside.bench().default_exposure_s()});
        write_text_file(card / picture.name, picture.bytes);
        program->click("capture-next");
    }
    EXPECT_EQ(says(), "");
    EXPECT_TRUE(done("colour"));
    EXPECT_LE(by_hand.count(), most_presses);
    EXPECT_EQ(program->quit(), 0) << program->words();
}

/// The commands of a page, by words.
std::vector<std::vector<std::string>> commands_of(const std::string& page) {
    std::vector<std::vector<std::string>> commands;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("    livery ")) continue;
        std::istringstream words(line.substr(11));
        commands.emplace_back();
        for (std::string word; words >> word;) commands.back().push_back(word);
    }
    return commands;
}

// docs/first-session.md, "In the terminal": every command as it stands there, but for the camera's
// address and where files lie.
TEST_F(CameraBeforeMonitor, NightlyFirstSessionInTheTerminalIsAsItsPageSays) {
    const auto& folder = studio->folder;
    folder.write("mockup.ply", ply_bytes(small_bench_product()->mesh));
    folder.write("first.json",
                 R"({"format_version": 1, "name": "first", "parts": {}, "lights": [],
                     "environment": {"file": "assets/environments/overcast.hdr"}})");
    const auto commands = commands_of(read_text_file(LIVERY_SOURCE "/docs/first-session.md"));
    ASSERT_GE(commands.size(), 7u);
    for (std::vector<std::string> words : commands) {
        std::string whole;
        for (std::string& word : words) {
            if (word == "tethered") word += ":" + room->camera().port();
            for (const char* name :
                 {"mockup.ply", "first.json", "first.png", "captures", "again", "calibration"})
                if (word == name || word.starts_with(std::string(name) + "/"))
                    word = (folder / word).string();
            whole += " " + word;
        }
        const ProgramRun run = run_program(LIVERY_PROGRAM, words);
        ASSERT_EQ(run.exit_code, 0) << whole << "\n" << run.out << run.err;
    }
    const ErrorStatistics off = off_its_place(folder / "calibration", room->bench());
    std::printf("    picture off its place %.3f / %.3f px\n", off.median, off.p95);
    EXPECT_LT(off.median, 0.5);
    EXPECT_LT(off.p95, 1.0);
    const ImageF first = read_image(folder / "first.png").image;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < first.values.size(); i += 3) lit += first.values[i] > 20.0f;
    EXPECT_GT(lit, first.pixel_count() / 50) << "the mock-up is lit";
}

TEST_F(CameraBeforeMonitor, NightlyWhateverHappensOnTheWayLosesOnePhotographAtMost) {
    const auto taken = [&] { return room->camera().photographs(); };
    start_program();
    pick_projector();
    connect();

    // Projector in standby from the start, which looks like a lens cap.
    room->sleep_from(0);
    program->click("capture-start");
    EXPECT_TRUE(says("sees no light of the projector"));
    EXPECT_EQ(kept(), 0) << "nobody knows what they show";
    room->wake();
    const int first = taken();
    program->click("capture-start");
    ASSERT_TRUE(photographed(first + 24));

    // The cable: goes on by itself
    room->camera().set(PtpMishap::unplugged);
    EXPECT_TRUE(says("not there any more"));
    const int pulled = taken();
    room->camera().set(PtpMishap::none);
    ASSERT_TRUE(photographed(pulled + 3));
    EXPECT_EQ(says(), "");

    // The projector unplugged during a pause: waited for
    pause_or_go_on(true);
    sleep_ms(pause_ms);
    const int unplugged = taken();
    desktop->unplug_projector();
    program->wait_for_state("projector", "waiting");
    pause_or_go_on(false);
    EXPECT_TRUE(says("the projector does not show the picture"));
    EXPECT_EQ(taken(), unplugged);
    desktop->plug_projector();
    ASSERT_TRUE(photographed(unplugged + 3));
    EXPECT_EQ(says(), "");

    // Standby again: the pictures between which nothing changed are lost, not those before.
    room->sleep_from(taken());
    const int asleep = taken();
    EXPECT_TRUE(says("shows no change from the picture before"));
    program->wait_for_state("capture", "watching");
    EXPECT_GE(kept(), asleep - first - 1 - 2 * most_of_a_picture);
    room->wake();
    const int kept_asleep = kept(), awake = taken();
    program->click("capture-start");
    ASSERT_TRUE(photographed(awake + 10));

    program->process().send(SIGKILL);
    program->process().wait(patience);
    const int killed = taken(), kept_killed = kept();
    EXPECT_GE(kept_killed, kept_asleep + killed - awake - 1) << "one at most";
    start_program();
    connect();
    program->click("capture-start");
    expect_as_direct();
    EXPECT_LE(taken() - killed, kept() - kept_killed + settling);
    std::printf("    %d on the disk of %d when it was killed, %d and %d in the end\n",
                kept_killed,
                killed,
                kept(),
                taken());
    EXPECT_EQ(program->quit(), 0) << program->words();
}

}  // namespace
}  // namespace livery
