#include "scene/mockup_pose.h"

#include <algorithm>
#include <limits>

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

}  // namespace livery
