#include "scene/pose_io.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

namespace livery {

glm::dmat3 read_rotation(const JsonReader& field) {
    const glm::dmat3 rotation = field.matrix3();
    const glm::dmat3 identity = rotation * glm::transpose(rotation);
    double worst = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            worst = std::max(worst, std::abs(identity[column][row] - (row == column ? 1.0 : 0.0)));
        }
    }
    // Files carry six digits or more; a scale or a mirror is a mistake of another kind.
    if (!(worst <= 1e-4)) field.fail("rows that are not orthonormal", "a rotation");
    if (glm::determinant(rotation) < 0.0) field.fail("a mirror (determinant -1)", "a rotation");
    return rotation;
}

Rigid3 read_pose(const JsonReader& object) {
    return {read_rotation(object["rotation"]), object["translation_mm"].vec3()};
}

}  // namespace livery
