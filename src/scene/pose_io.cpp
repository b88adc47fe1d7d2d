#include "scene/pose_io.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "core/json.h"
#include "core/worst_error.h"

namespace livery {

glm::dmat3 read_rotation(const JsonReader& field) {
    const glm::dmat3 rotation = field.matrix3();
    const glm::dmat3 identity = rotation * glm::transpose(rotation);
    double worst = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            worst = worse_of(worst, std::abs(identity[column][row] - (row == column ? 1.0 : 0.0)));
        }
    }
    // Files carry six digits or more; a scale or a mirror is a mistake of another kind.
    if (!(worst <= 1e-4)) field.fail("rows that are not orthonormal", "a rotation");
    if (glm::determinant(rotation) < 0.0) field.fail("a mirror (determinant -1)", "a rotation");
    return rotation;
}

Rigid3 read_pose(const JsonReader& object) {
    return {read_rotation(object["rotation"]), place_mm(object["translation_mm"])};
}

Json json_of(const Rigid3& pose) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) rotation.push_back(pose.rotation[column][row]);
    }
    const glm::dvec3& t = pose.translation;
    return {{"rotation", rotation}, {"translation_mm", {t.x, t.y, t.z}}};
}

void read_lens(const JsonReader& object, View& view) {
    // From a fisheye on a sensor of few pixels to a telescope; coefficients grow with the power of
    // the focal length that they stand for.
    constexpr double kShortest_px = 0.1, kLongest_px = 1e6, kFarthest_px = 1e6, kStrongest = 1e6;
    const auto field = object["matrix"];
    if (field.is_array() && field.size() == 9) {
        field.at(0).number_between(kShortest_px, kLongest_px);
        field.at(4).number_between(kShortest_px, kLongest_px);
        field.at(2).number_between(-kFarthest_px, kFarthest_px);
        field.at(5).number_between(-kFarthest_px, kFarthest_px);
    }
    const glm::dmat3 matrix = field.matrix3();
    if (matrix[1][0] != 0.0 || matrix[0][1] != 0.0 || matrix[0][2] != 0.0 || matrix[1][2] != 0.0 ||
        matrix[2][2] != 1.0) {
        field.fail(field.found(), "fx, 0, cx, 0, fy, cy, 0, 0, 1");
    }
    view.focal_px = {matrix[0][0], matrix[1][1]};
    // OpenCV's pixel centres are at integers, ours at half integers.
    view.principal_px = glm::dvec2(matrix[2]) + 0.5;
    if (!object.has("distortion")) return;
    const auto lens = numbers_between(object["distortion"], 5, -kStrongest, kStrongest);
    std::copy(lens.begin(), lens.end(), view.distortion.begin());
}

DataSheets read_data_sheets(const JsonReader& json) {
    json.allow_only(
        {"throw_ratio", "lens_shift", "focal_mm", "sensor_width_mm", "lens_distance_mm"});
    DataSheets sheets;
    sheets.throw_ratio = json["throw_ratio"].number_between(0.1, 20.0);
    sheets.lens_shift = json["lens_shift"].number_between(-2.0, 2.0);
    sheets.focal_mm = json["focal_mm"].number_between(1.0, 5000.0);
    sheets.sensor_width_mm = json["sensor_width_mm"].number_between(1.0, 200.0);
    sheets.lens_distance_mm = json["lens_distance_mm"].number_between(1.0, 1e5);
    return sheets;
}

Json json_of(const DataSheets& sheets) {
    return {{"throw_ratio", sheets.throw_ratio},
            {"lens_shift", sheets.lens_shift},
            {"focal_mm", sheets.focal_mm},
            {"sensor_width_mm", sheets.sensor_width_mm},
            {"lens_distance_mm", sheets.lens_distance_mm}};
}

}  // namespace livery
