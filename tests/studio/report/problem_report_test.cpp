// What a problem report holds and what it must not hold, also where everything is broken.
#include "studio/report/problem_report.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "core/paths.h"
#include "evaluation/ballots.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/synthetic_calibration.h"
#include "studio/report/redaction.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const char* kLog =
    "2026-11-28T22:30:00.000Z info Livery opens\n"
    "2026-11-28T22:30:01.000Z info command: {\"set-paint\": {\"look\": 1, \"paint\": \"secret "
    "gold\"}}\n"
    "2026-11-28T22:30:02.000Z info undo: Paint body secret gold\n"
    "2026-11-28T22:30:03.000Z warning the projector's picture: lost\n";

/// A user's folder with a session, a calibration, artwork, a vote and a log.
class ProblemReport : public ::testing::Test {
  protected:
    ProblemReport() {
        ::setenv("LIVERY_HOME", home_.path().c_str(), 1);
        std::filesystem::create_directory(home_ / "log");
        home_.write("log/livery.log", kLog);
        home_.write("desktop.json", R"({"format_version": 1, "settings": {"folder": "/tmp"}})");
        ColourCalibration calibration = synthetic_calibration(ImageF(32, 20, 1, 1.0f));
        calibration.made_with = "a camera of this test";
        seal(calibration);
        View projector;
        projector.width = 32;
        projector.height = 20;
        write_setup(home_ / "calibration", calibration, projector);
        write_png(home_ / "logo.png", Image8(4, 4, 3));
        Document document;
        document.calibration = (home_ / "calibration").string();
        SessionLook look;
        look.id = document.next_look_id++;
        look.look.name = "secret look";
        look.look.artwork.emplace_back();
        look.look.artwork.back().picture = (home_ / "logo.png").string();
        document.looks.push_back(look);
        request_.document = std::make_shared<const Document>(document);
    }

    std::vector<ReportFile> make() { return make_problem_report(request_, {}); }

    static const ReportFile* find(const std::vector<ReportFile>& report, const std::string& name) {
        const auto found = std::find_if(report.begin(), report.end(), [&](const ReportFile& file) {
            return file.name == name;
        });
        return found == report.end() ? nullptr : &*found;
    }
    static std::string text_of(const std::vector<ReportFile>& report, const std::string& name) {
        const ReportFile* file = find(report, name);
        EXPECT_TRUE(file) << name;
        return file ? file->bytes : "";
    }
    /// Every byte of the report, to look for what must not be in it.
    static std::string all_of(const std::vector<ReportFile>& report) {
        std::string text;
        for (const ReportFile& file : report) {
            text += file.name + "\n" + file.what + "\n" + file.problem + "\n" + file.bytes + "\n";
        }
        return text;
    }
    static bool holds(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }

    TemporaryFolder home_;
    ReportRequest request_;
};

TEST_F(ProblemReport, HasNeitherSessionNorPicturesNorVotesUnlessAskedFor) {
    {
        BallotStore ballots(home_ / "ballots.sqlite");
        const int round = ballots.open_round({"secret look", "another"}, "");
        ballots.vote(round, "Erika", {0, 1});
        ballots.close_round(round);
    }
    const auto report = make();
    std::vector<std::string> names;
    for (const ReportFile& file : report) names.push_back(file.name);
    EXPECT_EQ(names,
              (std::vector<std::string>{"README.txt",
                                        "version.txt",
                                        "machine.txt",
                                        "calibration.txt",
                                        "settings.json",
                                        "log.txt"}));
    for (const char* secret : {"secret", "Erika", "logo.png"}) {
        EXPECT_FALSE(holds(all_of(report), secret)) << secret;
    }
    for (const ReportFile& file : report) EXPECT_EQ(file.problem, "") << file.name;

    request_.with_session = request_.with_pictures = request_.with_votes = true;
    const auto whole = make();
    EXPECT_TRUE(holds(text_of(whole, "session.json"), "secret look"));
    EXPECT_TRUE(holds(text_of(whole, "log.txt"), "secret gold"));
    EXPECT_TRUE(holds(text_of(whole, "votes/round-1.csv"), "secret look"));
    EXPECT_EQ(text_of(whole, "pictures/artwork/logo.png"), read_text_file(home_ / "logo.png"));
    EXPECT_TRUE(find(whole, "pictures/calibration/status.png"));
    EXPECT_FALSE(holds(all_of(whole), "Erika")) << "who voted is never told";
}

TEST_F(ProblemReport, ArtworkOfAnyNameGoesIntoTheArchive) {
    Document document = *request_.document;
    for (const char* name : {"a\\b.png", "\xff.png", "elsewhere/a\\b.png"}) {
        const auto file = home_ / name;
        std::filesystem::create_directories(file.parent_path());
        write_png(file, Image8(4, 4, 3));
        document.looks.front().look.artwork.emplace_back();
        document.looks.front().look.artwork.back().picture = file.string();
    }
    request_.document = std::make_shared<const Document>(document);
    request_.with_session = request_.with_pictures = true;
    const auto report = make();
    for (const char* name : {"a_b.png", "?.png", "2-a_b.png"}) {
        EXPECT_TRUE(find(report, std::string("pictures/artwork/") + name)) << name;
    }
    EXPECT_NO_THROW(write_problem_report(home_ / "r.zip", report, 0));
}

TEST_F(ProblemReport, TheReadmeNamesEveryFile) {
    request_.with_session = request_.with_votes = true;
    const auto report = make();
    ASSERT_EQ(report.front().name, "README.txt");
    for (std::size_t k = 1; k < report.size(); ++k) {
        EXPECT_TRUE(holds(report.front().bytes, report[k].name + ", ")) << report[k].name;
        EXPECT_TRUE(holds(report.front().bytes, report[k].what)) << report[k].name;
    }
}

TEST_F(ProblemReport, TellsOfTheCalibrationInFigures) {
    const std::string text = text_of(make(), "calibration.txt");
    for (const char* part : {"32x20", "a camera of this test", "Valid pixels", "status.png, "}) {
        EXPECT_TRUE(holds(text, part)) << part << " in " << text;
    }
    EXPECT_TRUE(holds(text, "What is wrong with it\nNothing.")) << text;
}

TEST_F(ProblemReport, LeavesOutTheHomeFolderAndTheUsersName) {
    const char* home = std::getenv("HOME");
    const char* user = std::getenv("USER");
    ::setenv("HOME", home_.path().c_str(), 1);
    ::setenv("USER", "erika", 1);
    home_.write("log/livery.log",
                "2026-11-28T22:30:00.000Z info read erika's " + home_.path().string() + "/x\n");
    request_.with_session = request_.with_pictures = request_.with_votes = true;
    const std::string all = all_of(make());
    home ? ::setenv("HOME", home, 1) : ::unsetenv("HOME");
    user ? ::setenv("USER", user, 1) : ::unsetenv("USER");
    EXPECT_FALSE(holds(all, home_.path().string()));
    EXPECT_FALSE(holds(all, "erika"));
    EXPECT_TRUE(holds(all, "read USER's ~/x"));
    EXPECT_TRUE(holds(all, "~/calibration"));
}

TEST_F(ProblemReport, SaysInItsPlaceWhatCannotBeFoundOut) {
    std::filesystem::remove_all(home_ / "log");
    std::filesystem::remove(home_ / "desktop.json");
    std::filesystem::create_directory(home_ / "desktop.json");
    std::filesystem::remove(home_ / "logo.png");
    home_.write("ballots.sqlite", "no ballots");
    home_.write("calibration/span.exr", "no picture");
    request_.with_session = request_.with_pictures = request_.with_votes = true;
    const auto report = make();
    EXPECT_TRUE(holds(text_of(report, "log.txt"), "no such file"));
    EXPECT_TRUE(holds(text_of(report, "settings.json"), "a folder"));
    EXPECT_TRUE(holds(text_of(report, "pictures/artwork/logo.png.txt"), "no such file"));
    EXPECT_TRUE(holds(text_of(report, "votes/rounds.txt"), "ballots.sqlite"));
    const std::string calibration = text_of(report, "calibration.txt");
    EXPECT_TRUE(holds(calibration, "32x20")) << "the figures are whole: " << calibration;
    EXPECT_TRUE(holds(calibration, "span.exr")) << calibration;
    EXPECT_FALSE(holds(calibration, "What is wrong with it\nNothing.")) << calibration;
    for (const char* name : {"log.txt", "settings.json", "votes/rounds.txt"}) {
        EXPECT_NE(find(report, name)->problem, "") << name;
    }
    EXPECT_TRUE(holds(report.front().bytes, "Missing in it: "));

    home_.write("calibration/calibration.json", "{\"id\": ");
    EXPECT_TRUE(holds(text_of(make(), "calibration.txt"), "Figures\nNot found out: "));
    std::filesystem::remove_all(home_ / "calibration");
    EXPECT_TRUE(holds(text_of(make(), "calibration.txt"), "calibration.json"));
}

TEST_F(ProblemReport, ReadsADamagedSessionAsFarAsItGoes) {
    request_.document = nullptr;
    request_.session = home_.write("broken.livery", "this is no session");
    request_.with_session = request_.with_pictures = true;
    const auto report = make();
    EXPECT_TRUE(holds(text_of(report, "session.json"), "Not found out: "));
    EXPECT_TRUE(holds(text_of(report, "calibration.txt"), "Not found out: "));
    request_.session.clear();
    EXPECT_TRUE(holds(text_of(make(), "calibration.txt"), "no session yet"));
}

TEST_F(ProblemReport, OfALongLogItsEndIsKept) {
    std::string many;
    for (int k = 0; k < 1000; ++k)
        many += "2026-11-28T22:30:00.000Z info old " + std::to_string(k) + "\n";
    home_.write("log/livery.log.1", many);
    const std::string end = log_part(home_.path(), true, 1000);
    EXPECT_LE(end.size(), 1000u);
    EXPECT_TRUE(holds(end, "old 999\n2026-11-28T22:30:00.000Z info Livery opens\n"));
    EXPECT_TRUE(end.starts_with("2026-")) << "in whole lines: " << end.substr(0, 40);
    EXPECT_EQ(log_part(home_.path(), false, 200),
              "2026-11-28T22:30:02.000Z info undo:\n"
              "2026-11-28T22:30:03.000Z warning the projector's picture: lost\n");
    EXPECT_TRUE(holds(log_part(home_.path(), false), "info command: set-paint\n"));
}

TEST_F(ProblemReport, TheArchiveHoldsWhatWasShown) {
    const auto report = make();
    const auto file = home_ / report_name(1'795'905'000);
    EXPECT_EQ(file.extension(), ".zip");
    write_problem_report(file, report, 1'795'905'000);
    const ProgramRun opened =
        run_program("python3", {"-m", "zipfile", "-e", file.string(), (home_ / "opened").string()});
    ASSERT_EQ(opened.exit_code, 0) << opened.err;
    for (const ReportFile& each : report) {
        EXPECT_EQ(read_text_file(home_.path() / "opened" / each.name), each.bytes) << each.name;
    }
}

TEST_F(ProblemReport, DevicesAnswerFromProcessesOfTheirOwn) {
    // No display is there, whatever the test is run in.
    const char* display = std::getenv("DISPLAY");
    const std::string before = display ? display : "";
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    const auto devices = ask_devices(GlDevice::software);
    if (!before.empty()) ::setenv("DISPLAY", before.c_str(), 1);
    EXPECT_TRUE(holds(text_of(devices, "opengl.txt"), "Renderer: ")) << all_of(devices);
    EXPECT_NE(find(devices, "display.txt")->problem, "");
    EXPECT_EQ(find(devices, "cameras.txt")->problem, "") << all_of(devices);
}

}  // namespace
}  // namespace livery
