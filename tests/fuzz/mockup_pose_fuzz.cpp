#include <cmath>

#include <glm/matrix.hpp>

#include "fuzz/fuzz.h"
#include "scene/mockup_pose.h"

LIVERY_FUZZ(text) {
    const livery::MockupPose pose = livery::parse_mockup_pose(text, "pose.json");
    livery::fuzz::require(
        std::abs(glm::determinant(pose.camera_from_product.rotation) - 1.0) < 1e-3, "a rotation");
    livery::fuzz::require(pose.mesh_scale > 0.0, "a scale above 0");
}
