#include "jobs/simulated_sphere.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/json.h"
#include "core/paths.h"
#include "jobs/simulated_photographer.h"

namespace livery {

namespace {

constexpr double kWhite = 0.95;
constexpr double kWhiteLampAngle_deg = 30.0;

/// The lamp that stands nearest to 30 degrees from the camera's direction.
glm::dvec3 lamp_for_white(const SphereStand& stand) {
    const double wanted = std::cos(kWhiteLampAngle_deg / 180.0 * 3.14159265358979323846);
    const auto off = [&](const glm::dvec3& lamp) {
        return std::abs(lamp.z / glm::length(lamp) - wanted);
    };
    return *std::min_element(stand.lamps_mm.begin(),
                             stand.lamps_mm.end(),
                             [&](const auto& a, const auto& b) { return off(a) < off(b); });
}

}  // namespace

SimulatedSphere photograph_sphere(const SimulatedSphereRequest& request, const Progress& progress) {
    const SphereStand& stand = request.stand;
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    Photographer photographer(request.out, request.seed);
    SimulatedSphere result;
    Json captures = Json::array();
    for (const glm::dvec3& lamp_mm : stand.lamps_mm) {
        progress.update(
            static_cast<double>(result.lamps) / static_cast<double>(stand.lamps_mm.size()),
            fmt::format("photographing under lamp {}", result.lamps + 1));
        const ImageF light = sphere_light(stand, request.paint, lamp_mm, progress);
        for (const double exposure_s : bracket_s(stand.camera, light)) {
            Json entry = photographer.take(stand.camera, light, exposure_s);
            entry["light_position_mm"] = json_from(lamp_mm);
            captures.push_back(std::move(entry));
        }
        ++result.lamps;
    }
    Material white;
    white.model = ReflectanceModel::lambert;
    white.diffuse = glm::dvec3(kWhite);
    const glm::dvec3 lamp_mm = lamp_for_white(stand);
    const ImageF light = sphere_light(stand, white, lamp_mm, progress);
    Json white_reference =
        photographer.take(stand.camera, light, bracket_s(stand.camera, light).front());
    white_reference["light_position_mm"] = json_from(lamp_mm);
    white_reference["reflectance"] = kWhite;
    result.photographs = photographer.taken();

    write_camera_file(request.out / "camera.json", stand.camera.view);
    write_camera_matrix(request.out, stand.camera_from_working);
    Json manifest = {
        {"format_version", 1},
        {"camera", "camera.json"},
        {"camera_to_xyz", "camera-to-xyz.json"},
        {"sphere", {{"centre_mm", {0.0, 0.0, 0.0}}, {"diameter_mm", stand.diameter_mm}}},
        {"white_reference", white_reference}};
    describe_encoding(stand.camera, manifest);
    manifest["captures"] = captures;
    write_json_file(request.out / "manifest.json", manifest);
    return result;
}

}  // namespace livery
