// A spot of light on a translucent sample on the simulated stand, photographed and measured.
#pragma once

#include <array>
#include <functional>

#include "core/json.h"
#include "jobs/simulated_captures.h"
#include "jobs/spot/spot_measurement.h"
#include "support/temporary_folder.h"

namespace livery {

/// As the shipped bench's: 14 bit, shot and read noise.
inline CameraDescription noisy_spot_camera() {
    CameraDescription camera;
    camera.electrons_per_unit = 10.0;
    camera.read_noise_units = 4.0;
    return camera;
}

/// A folder of photographs of a medium, the same in all channels; its manifest can be changed.
class SpotBench {
  public:
    SpotBench(const std::array<ScatteringMedium, 3>& media,
              int size_px,
              std::uint64_t photons,
              const std::function<void(SpotStand&)>& change = {}) {
        SimulatedSpotRequest request;
        request.stand = usual_spot_stand(noisy_spot_camera(), media, size_px);
        request.stand.photons = photons;
        if (change) change(request.stand);
        request.out = captures();
        eta = media[1].eta;
        taken = photograph_spot(request);
        manifest = read_json_file(captures() / "manifest.json");
    }

    std::filesystem::path captures() const { return folder / "captures"; }
    std::filesystem::path out() const { return folder / "sample.csv"; }
    void rewrite() const { write_json_file(captures() / "manifest.json", manifest); }
    SpotMeasurement measure() const { return measure_profile({captures(), eta, out()}); }

    TemporaryFolder folder;
    SimulatedSpot taken;
    Json manifest;
    double eta = 1.5;
};

}  // namespace livery
