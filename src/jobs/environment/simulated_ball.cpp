#include "jobs/environment/simulated_ball.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "jobs/simulated_photographer.h"

namespace livery {

SimulatedBall photograph_ball(const SimulatedBallRequest& request, const Progress& progress) {
    const MirrorBallStand& stand = request.stand;
    check_argument(!stand.cameras.empty(), "photograph_ball: no camera");
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    Photographer photographer(request.out, request.seed);
    Json views = Json::array();
    for (const CameraDescription& camera : stand.cameras) {
        progress.update(
            static_cast<double>(views.size()) / static_cast<double>(stand.cameras.size()),
            fmt::format("photographing from place {}", views.size() + 1));
        const ImageF light =
            mirror_ball_light(stand, camera, request.light_from, request.samples_a_side, progress);
        Json captures = Json::array();
        for (const double exposure_s :
             request.exposures_s.empty() ? bracket_s(camera, light) : request.exposures_s) {
            captures.push_back(photographer.take(camera, light, exposure_s));
        }
        const std::string name = fmt::format("camera-{}.json", views.size() + 1);
        write_camera_file(request.out / name, camera.view);
        views.push_back({{"camera", name}, {"captures", captures}});
    }
    write_camera_matrix(request.out, stand.camera_from_working);
    Json manifest = {
        {"format_version", 1},
        {"environment", "ball"},
        {"camera_to_xyz", "camera-to-xyz.json"},
        {"sphere", {{"centre_mm", {0.0, 0.0, 0.0}}, {"diameter_mm", stand.diameter_mm}}}};
    // A perfect mirror shows at its rim what stands behind it: where it is, the stand knows
    if (!stand.metal) manifest["fit_outline"] = false;
    if (stand.metal) manifest["reflectance"] = json_from(metal_reflectance(*stand.metal, 1.0));
    describe_encoding(stand.cameras.front(), manifest);
    manifest["views"] = views;
    write_json_file(request.out / "manifest.json", manifest);
    return {photographer.taken(), stand.cameras.size()};
}

}  // namespace livery
