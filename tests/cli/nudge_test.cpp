// livery calibrate nudge as people call it.
#include <gtest/gtest.h>

#include "core/json.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/synthetic_calibration.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(Nudge, MovesTheMockUpOfACalibration) {
    const TemporaryFolder folder;
    const auto from = folder / "from", to = folder / "to", back = folder / "back";
    ColourCalibration calibration = synthetic_calibration(ImageF(32, 20, 1, 1.0f));
    seal(calibration);
    const View projector = look_at({0, 100, 900}, {0, 0, 0}, 0.4, 32, 20);
    write_setup(from, calibration, projector);
    const auto nudge = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"calibrate", "nudge", "--product", "sphere"});
        return run_program(LIVERY_PROGRAM, more);
    };
    const ProgramRun run = nudge({"--calibration",
                                  from.string(),
                                  "--right",
                                  "0.5",
                                  "--yaw",
                                  "-0.25",
                                  "--out",
                                  to.string(),
                                  "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json figures = Json::parse(run.out);
    EXPECT_NEAR(figures["moved_px"][0].get<double>(), 0.5, 1e-6);
    EXPECT_GT(figures["turned_deg"].get<double>(), 0.1);
    EXPECT_EQ(read_calibration(to).id, figures["id"].get<std::string>());
    EXPECT_NE(projector_view_of(to), projector);

    const ProgramRun text =
        nudge({"--calibration", to.string(), "--right", "-0.5", "--out", back.string()});
    ASSERT_EQ(text.exit_code, 0) << text.err;
    EXPECT_NE(text.out.find("0.50 px to the left"), std::string::npos) << text.out;

    std::filesystem::remove(from / "projector.json");
    const ProgramRun lost = nudge({"--calibration", from.string(), "--out", to.string()});
    EXPECT_NE(lost.exit_code, 0);
    EXPECT_NE(lost.err.find("projector.json"), std::string::npos) << lost.err;
    EXPECT_EQ(read_calibration(to).id, figures["id"].get<std::string>()) << "it stays";
}

}  // namespace
}  // namespace livery
