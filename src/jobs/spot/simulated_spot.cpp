#include "jobs/spot/simulated_spot.h"

#include "core/json.h"
#include "core/paths.h"
#include "jobs/simulated_photographer.h"

namespace livery {

SimulatedSpot photograph_spot(const SimulatedSpotRequest& request, const Progress& progress) {
    const SpotStand& stand = request.stand;
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    const SpotScenes scenes = spot_scenes(stand, progress.part(0.0, 0.8));
    Photographer photographer(request.out, request.seed);
    const auto taken = [&](const ImageF& light, const std::vector<double>& exposures_s) {
        Json captures = Json::array();
        for (const double exposure_s : exposures_s) {
            captures.push_back(photographer.take(stand.camera, light, exposure_s));
        }
        return captures;
    };
    progress.update(0.8, "photographing");
    const auto sample_s = bracket_s(stand.camera, scenes.sample);
    const auto white_s = bracket_s(stand.camera, scenes.white);
    write_camera_file(request.out / "camera.json", stand.camera.view);
    Json manifest = {{"format_version", 1},
                     {"camera", "camera.json"},
                     {"plane", {{"point_mm", {0, 0, 0}}, {"normal", {0, 0, 1}}}},
                     {"projector_mm", json_from(stand.projector_mm)}};
    describe_encoding(stand.camera, manifest);
    manifest["captures"] = taken(scenes.sample, sample_s);
    manifest["black"] = taken(scenes.sample_black, sample_s);
    manifest["white_reference"] = {{"reflectance", stand.white},
                                   {"captures", taken(scenes.white, white_s)},
                                   {"black", taken(scenes.white_black, white_s)}};
    write_json_file(request.out / "manifest.json", manifest);
    return {photographer.taken()};
}

}  // namespace livery
