#include "scene/mockup_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/pose_io.h"

namespace livery {

namespace {

constexpr int kPoseVersion = 1;

}  // namespace

MockupPose read_pose_file(const std::filesystem::path& file) {
    return parse_mockup_pose(read_text_file(file), file);
}

MockupPose parse_mockup_pose(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(kPoseVersion);
    root.allow_only({"format_version",
                     "kind",
                     "product",
                     "method",
                     "rotation",
                     "translation_mm",
                     "mesh_scale",
                     "rms_px",
                     "rms_mm",
                     "inliers",
                     "covariance",
                     "warnings"});
    root["kind"].one_of({"pose"});
    MockupPose pose;
    pose.product = root["product"].text();
    pose.method = root["method"].one_of({"scan", "points"}) == 0 ? "scan" : "points";
    pose.camera_from_product = read_pose(root);
    pose.mesh_scale = root["mesh_scale"].number_between(1e-6, 1e6);
    pose.rms_px = root["rms_px"].number_between(0.0, 1e6);
    pose.rms_mm = root["rms_mm"].number_between(0.0, 1e6);
    pose.inliers =
        static_cast<std::size_t>(root["inliers"].integer(0, std::numeric_limits<int>::max()));
    const std::vector<double> covariance = root["covariance"].numbers(36);
    std::copy(covariance.begin(), covariance.end(), pose.covariance.begin());
    const JsonReader warnings = root["warnings"];
    for (std::size_t k = 0; k < warnings.size(); ++k)
        pose.warnings.push_back(warnings.at(k).text());
    return pose;
}

void write_pose_file(const std::filesystem::path& file, const MockupPose& pose) {
    Json json = json_of(pose.camera_from_product);
    json["format_version"] = kPoseVersion;
    json["kind"] = "pose";
    json["product"] = pose.product;
    json["method"] = pose.method;
    json["mesh_scale"] = pose.mesh_scale;
    json["rms_px"] = pose.rms_px;
    json["rms_mm"] = pose.rms_mm;
    json["inliers"] = pose.inliers;
    json["covariance"] = pose.covariance;
    json["warnings"] = pose.warnings;
    write_json_file(file, json);
}

namespace {

glm::dmat3 turn_about(int axis, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    glm::dmat3 rotation(1.0);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    rotation[u][u] = rotation[v][v] = c;
    rotation[u][v] = s;
    rotation[v][u] = -s;
    return rotation;
}

glm::dvec3 middle_of(const Bounds& bounds) { return 0.5 * (bounds.low + bounds.high); }

}  // namespace

View nudged(const View& projector, const Bounds& mockup, const Nudge& by) {
    const glm::dvec3 middle = projector.view_from_world * middle_of(mockup);
    const double radius_mm = std::max(0.5 * glm::distance(mockup.low, mockup.high), 1e-6);
    check_argument(middle.z > radius_mm * 1e-3, "the projector does not see the mock-up's middle");
    // A pixel at the middle's distance
    const glm::dvec2 mm_per_px = middle.z / projector.focal_px;
    const double rad_per_px = mm_per_px.x / radius_mm;
    glm::dvec3 to(middle.x + by.right_px * mm_per_px.x,
                  middle.y + by.down_px * mm_per_px.y,
                  middle.z / std::max(1.0 + by.nearer_px * rad_per_px, 0.1));
    // Nearer along the line of sight: its picture grows where it is.
    to.x *= to.z / middle.z;
    to.y *= to.z / middle.z;
    // The view's axes: right, down, away. What faces the projector lies before the middle.
    const glm::dmat3 turned = turn_about(2, by.roll_px * rad_per_px) *
                              turn_about(0, by.pitch_px * rad_per_px) *
                              turn_about(1, -by.yaw_px * rad_per_px);
    View view = projector;
    view.view_from_world = Rigid3{turned, to - turned * middle} * projector.view_from_world;
    check_argument(project(view, middle_of(mockup)).has_value(),
                   "the projector would not see the mock-up's middle");
    return view;
}

MockupMotion motion_between(const View& before, const View& after, const Bounds& mockup) {
    const glm::dvec3 middle = middle_of(mockup);
    MockupMotion motion;
    motion.moved_mm = after.view_from_world * middle - before.view_from_world * middle;
    const glm::dmat3 turned =
        after.view_from_world.rotation * glm::transpose(before.view_from_world.rotation);
    // The antisymmetric part is exact where the trace is flat.
    const glm::dvec3 axis(
        turned[1][2] - turned[2][1], turned[2][0] - turned[0][2], turned[0][1] - turned[1][0]);
    const double trace = turned[0][0] + turned[1][1] + turned[2][2];
    motion.turned_deg = glm::degrees(std::atan2(glm::length(axis), trace - 1.0));
    const auto from = project(before, middle), to = project(after, middle);
    if (from && to) motion.moved_px = *to - *from;
    return motion;
}

std::string in_words(const MockupMotion& motion) {
    constexpr double kNothing_px = 0.005, kNothing_mm = 0.005, kNothing_deg = 0.0005;
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    const auto across = [&](double px, double mm, const char* more, const char* less) {
        if (std::abs(px) >= kNothing_px)
            add(fmt::format(
                "{:.2f} px {} ({:.2f} mm)", std::abs(px), px > 0.0 ? more : less, std::abs(mm)));
    };
    across(motion.moved_px.x, motion.moved_mm.x, "to the right", "to the left");
    across(motion.moved_px.y, motion.moved_mm.y, "down", "up");
    if (std::abs(motion.moved_mm.z) >= kNothing_mm)
        add(fmt::format("{:.2f} mm {}",
                        std::abs(motion.moved_mm.z),
                        motion.moved_mm.z < 0.0 ? "nearer" : "farther"));
    if (motion.turned_deg >= kNothing_deg)
        add(fmt::format("turned by {:.2f} degrees", motion.turned_deg));
    return text.empty() ? "not moved" : text;
}

}  // namespace livery
