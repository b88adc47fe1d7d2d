// `livery session seats`: seats are placed, the eye is chosen, and what seats miss is told.

#include <gtest/gtest.h>

#include "cli/session_run.h"
#include "core/image_io.h"
#include "core/paths.h"

namespace livery {
namespace {

ProgramRun run_seats(const std::filesystem::path& file, std::vector<std::string> more = {}) {
    return session_run("seats", file, std::move(more));
}

class SeatsCommand : public ::testing::Test {
  protected:
    SeatsCommand() {
        answer(run_program(LIVERY_PROGRAM,
                           {"session", "new", file_.string(), "--product", "sphere", "--json"}));
        answer(run_program(LIVERY_PROGRAM,
                           {"session",
                            "apply",
                            file_.string(),
                            "--command",
                            R"({"set-quality": {"quality": "draft"}})",
                            "--json"}));
    }
    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "s.livery";
};

TEST_F(SeatsCommand, PlacesSeatsAndChoosesTheEyeInStepsThatCanBeUndone) {
    Json now = answer(run_seats(file_));
    EXPECT_EQ(now["eye"]["of"], "set by hand");
    EXPECT_TRUE(now["seats"].empty());
    now = answer(run_seats(file_, {"--arc", "3", "--eye", "mean"}));
    EXPECT_EQ(now["eye"]["of"], "in the mean of 3 seats");
    ASSERT_EQ(now["seats"].size(), 3u);
    EXPECT_EQ(now["seats"][1]["seat"], 2);
    double mean = 0.0;
    for (const Json& seat : now["seats"]) mean += seat["eye_mm"][0].get<double>() / 3.0;
    EXPECT_NEAR(now["eye"]["eye_mm"][0].get<double>(), mean, 1e-9);
    answer(
        run_program(LIVERY_PROGRAM, {"session", "undo", file_.string(), "--steps", "2", "--json"}));
    EXPECT_TRUE(answer(run_seats(file_))["seats"].empty());
}

TEST_F(SeatsCommand, TellsWhatEachSeatMissesAndDrawsIt) {
    answer(run_seats(file_, {"--arc", "3", "--eye", "2"}));
    const auto maps = folder_ / "maps";
    const Json told = answer(run_seats(file_, {"--look", "1", "--maps", maps.string()}));
    ASSERT_EQ(told["seats"].size(), 3u);
    const auto figure = [&](int seat, const char* name) {
        return told["seats"][static_cast<std::size_t>(seat)]["looks"][0][name].get<double>();
    };
    EXPECT_EQ(figure(1, "de00_p95"), 0.0) << "the eye is its own";
    EXPECT_GT(figure(0, "de00_p95"), 0.0);
    EXPECT_GE(figure(0, "de00_p95"), figure(0, "de00_median"));
    EXPECT_TRUE(std::filesystem::is_regular_file(maps / "look-1-seat-3.png"));
    EXPECT_TRUE(told["unfair_seats"].is_array());
}

TEST_F(SeatsCommand, NightlyALookIsDrawnForAnySeat) {
    answer(run_seats(file_, {"--arc", "2"}));
    const auto draw = [&](const std::string& name, std::vector<std::string> more) {
        const auto file = folder_ / name;
        std::vector<std::string> words = {
            "session", "render", file_.string(), "--look", "1", "--out", file.string()};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramRun run = run_program(LIVERY_PROGRAM, words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        // Files have the time of their writing in them
        return read_image(file).image.values;
    };
    EXPECT_TRUE(draw("1.exr", {"--seat", "1"}) != draw("2.exr", {"--seat", "2"}));
    EXPECT_TRUE(draw("hand.exr", {}) == draw("by-name.exr", {"--seat", "hand"}));
}

TEST_F(SeatsCommand, SaysWhatIsWrong) {
    const auto refused = [&](std::vector<std::string> more, const std::string& part) {
        const ProgramRun run = run_seats(file_, std::move(more));
        EXPECT_EQ(run.exit_code, part.starts_with("no seats") ? 1 : 2) << run.err;
        EXPECT_NE((run.err + run.out).find(part), std::string::npos) << run.err << run.out;
    };
    refused({"--arc", "41"}, "--arc: found 41, expected 1 to 40");
    refused({"--eye", "you"}, "--eye: found \"you\", expected hand, mean or a seat's number");
    refused({"--eye", "4"}, "there is no seat 4");
    refused({"--eye", "mean"}, "no seat counts");
    refused({"--look", "99"}, "--look: found \"99\"");
    refused({"--maps", "x"}, "--maps: found no --look");
    refused({"--look", "all"}, "no seats");
    EXPECT_TRUE(answer(run_seats(file_))["seats"].empty());
}

}  // namespace
}  // namespace livery
