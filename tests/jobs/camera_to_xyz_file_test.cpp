#include <gtest/gtest.h>

#include "calibration/settings.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::filesystem::path written(const TemporaryFolder& folder, const std::string& text) {
    return folder.write("camera-to-xyz.json", text);
}

TEST(CameraToXyzFile, ReadsBothForms) {
    const TemporaryFolder folder;
    const CameraToXyz matrix =
        read_camera_to_xyz(written(folder, R"({"matrix": [1,2,0, 0,1,0, 0,0,3]})"));
    EXPECT_DOUBLE_EQ(matrix.xyz_from_camera[1][0], 2.0);
    EXPECT_EQ(matrix.origin, "matrix");
    const CameraToXyz primaries = read_camera_to_xyz(
        written(folder,
                R"({"primaries_xyz": {"red": [3,1,0], "green": [1,4,1], "blue": [1,1,5],
                    "black": [0.1,0.1,0.1]}, "measured_at_px": [10.5, 20.5]})"));
    EXPECT_TRUE(primaries.has_primaries);
    EXPECT_DOUBLE_EQ(primaries.primaries_xyz[2][2], 5.0);
    EXPECT_DOUBLE_EQ(primaries.measured_at_px->y, 20.5);
}

TEST(CameraToXyzFile, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& message) {
        const auto file = written(folder, text);
        EXPECT_TRUE(fails_with([&] { read_camera_to_xyz(file); }, {"camera-to-xyz.json", message}));
    };
    EXPECT_TRUE(fails_with([&] { read_camera_to_xyz(folder / "none.json"); },
                           {"none.json", "no such file"}));
    refused("", "an empty file");
    refused(R"({"matrix": [1,0,0)", "text that is not JSON");
    refused("[1,2,3]", "a JSON object");
    refused("{}", "neither, expected either matrix or primaries_xyz");
    refused(R"({"matrix": [1,0,0,0,1,0,0,0]})", "matrix: found 8 elements, expected 9 numbers");
    refused(R"({"matrix": [1,0,0,0,1,0,0,0,"x"]})", "matrix[8]: found \"x\", expected a number");
    refused(R"({"matrix": [1,0,0,0,1,0,0,0,1e999]})", "camera-to-xyz.json");
    refused(R"({"matrix": [1,0,0,2,0,0,0,0,1]})", "a singular matrix");
    refused(R"({"matrix": [1,0,0,0,1,0,0,0,1], "matrx": 1})", "the unknown field \"matrx\"");
    refused(R"({"format_version": 99, "matrix": [1,0,0,0,1,0,0,0,1]})", "newer Livery");
    refused(R"({"primaries_xyz": {"red": [3,1,0], "green": [1,4,1], "blue": [1,1,5]}})",
            "primaries_xyz.black: found nothing");
    refused(R"({"primaries_xyz": {"red": [1,1,1], "green": [1,1,1], "blue": [1,1,5],
                "black": [0,0,0]}})",
            "a singular matrix");
}

}  // namespace
}  // namespace livery
