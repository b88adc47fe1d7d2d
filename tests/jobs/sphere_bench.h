// A painted sphere on the simulated stand, photographed and measured: the whole way of a paint.
#pragma once

#include <functional>
#include <vector>

#include "appearance/measured/measured_grid.h"
#include "appearance/measured/measured_reflectance.h"
#include "appearance/paint_bsdf.h"
#include "core/json.h"
#include "jobs/simulated_captures.h"
#include "jobs/sphere_measurement.h"
#include "support/temporary_folder.h"

namespace livery {

/// As the shipped bench's: 14 bit, shot and read noise.
inline CameraDescription noisy_camera() {
    CameraDescription camera;
    camera.electrons_per_unit = 10.0;
    camera.read_noise_units = 4.0;
    return camera;
}

inline Material lambert_paint() {
    Material paint;
    paint.name = "chalk";
    paint.model = ReflectanceModel::lambert;
    paint.diffuse = {0.5, 0.3, 0.2};
    return paint;
}

inline Material matte_paint() {
    Material paint;
    paint.name = "matte ochre";
    paint.model = ReflectanceModel::eon;
    paint.diffuse = {0.45, 0.28, 0.09};
    paint.diffuse_roughness = 0.5;
    return paint;
}

inline Material solid_paint() {
    Material paint;
    paint.name = "glossy green";
    paint.model = ReflectanceModel::clearcoat;
    paint.diffuse = {0.04, 0.33, 0.1};
    paint.f0 = glm::dvec3(0.0);
    paint.alpha = glm::dvec2(0.4);
    paint.coat_alpha = 0.05;
    return paint;
}

inline Material metallic_paint() {
    Material paint;
    paint.name = "coarse silver";
    paint.model = ReflectanceModel::ggx;
    paint.diffuse = {0.05, 0.05, 0.052};
    paint.f0 = {0.55, 0.56, 0.6};
    paint.alpha = glm::dvec2(0.3);
    return paint;
}

inline ReflectanceFunction value_of(const MeasuredReflectance& measured) {
    return [&measured](const glm::dvec3& wi, const glm::dvec3& wo) {
        return evaluate(measured, wi, wo);
    };
}

/// A folder of photographs of a paint; its manifest can be changed.
class SphereBench {
  public:
    SphereBench(const Material& paint,
                int size_px,
                const CameraDescription& camera = noisy_camera(),
                const std::function<void(SphereStand&)>& change = {}) {
        SimulatedSphereRequest request;
        request.stand = usual_sphere_stand(camera, size_px, size_px);
        if (change) change(request.stand);
        request.paint = paint;
        request.out = captures();
        taken = photograph_sphere(request);
        manifest = read_json_file(captures() / "manifest.json");
    }

    std::filesystem::path captures() const { return folder / "captures"; }
    std::filesystem::path out() const { return folder / "paint.csv"; }
    void rewrite() const { write_json_file(captures() / "manifest.json", manifest); }
    SphereMeasurement measure() const { return measure_sphere({captures(), {}, out()}); }
    MeasuredReflectance measured() const { return read_measured_file(out()); }

    TemporaryFolder folder;
    SimulatedSphere taken;
    Json manifest;
};

}  // namespace livery
