// What an older Livery wrote beside a calibration, and what `livery check` says of all its files.

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/calibrate/calibration_folder.h"
#include "jobs/file_check.h"
#include "support/old_files.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(OldOrigin, TellsWhatACalibrationWasMadeFor) {
    const TemporaryFolder folder;
    const auto origin = read_origin(testing::unpacked_old_files(folder) / "calibration");
    ASSERT_TRUE(origin);
    EXPECT_EQ(origin->product, "Car");
    EXPECT_EQ(origin->shape, "ea91b9ecd9a197a483d0bdf49745a686");
    EXPECT_EQ(origin->made_with, "camera of bench small, its own projector");
    EXPECT_EQ(origin->capture_seconds, 10.059191592);
    EXPECT_EQ(origin->solve_seconds, 3.933046961);
    EXPECT_FALSE(origin->room);
    ASSERT_TRUE(origin->ends);
    EXPECT_EQ(origin->ends->exposure_s, 0.11666666666666667);
    EXPECT_EQ(origin->ends->light,
              glm::dvec3(7765.0066663684265, 19107.548297615438, 13088.102187821623));
}

TEST(OldFiles, AreGood) {
    const TemporaryFolder folder;
    const auto old = testing::unpacked_old_files(folder);
    for (const auto& [name, kind] : {std::pair{"session.livery", "session"},
                                     {"calibration", "calibration"},
                                     {"calibration/origin.json", "origin of a calibration"},
                                     {"calibration/projector.json", "camera"}}) {
        const FileCheck check = check_file(old / name);
        EXPECT_EQ(check.kind, kind);
        EXPECT_EQ(check.problems, std::vector<std::string>{}) << name;
    }
}

}  // namespace
}  // namespace livery
