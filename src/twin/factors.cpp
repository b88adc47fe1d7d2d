#include "twin/factors.h"

#include "core/error.h"
#include "core/mutation.h"

namespace livery {

namespace {

double luminance(const Spectrum& power) { return xyz_from_power(power).y; }

Spectrum product(const Spectrum& a, const Spectrum& b) {
    Spectrum result{};
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = a[k] * b[k];
    return result;
}

glm::dvec3 reading(const Spectrum& power, const Sensor& sensor) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < power.size(); ++k) {
        sum += power[k] * glm::dvec3(sensor[0][k], sensor[1][k], sensor[2][k]);
    }
    return sum;
}

Factors::PerChannel per_channel(const std::array<Spectrum, kLightChannels>& lights,
                                const Spectrum& reflectance,
                                const Sensor& sensor) {
    Factors::PerChannel result{};
    for (std::size_t k = 0; k < lights.size(); ++k) {
        result[k] = reading(product(lights[k], reflectance), sensor);
    }
    return result;
}

}  // namespace

std::array<Spectrum, kLightChannels> scaled_lights(const ProjectorSpectra& spectra) {
    Spectrum white{};
    for (std::size_t k = 0; k < white.size(); ++k) {
        white[k] = spectra.primaries[0][k] + spectra.primaries[1][k] + spectra.primaries[2][k];
    }
    const double white_y = luminance(white), clear_y = luminance(spectra.clear);
    check_argument(white_y > 0.0 && clear_y > 0.0, "bench: a projector without light");
    std::array<Spectrum, kLightChannels> lights{
        spectra.primaries[0], spectra.primaries[1], spectra.primaries[2], spectra.clear};
    for (std::size_t c = 0; c < lights.size(); ++c) {
        for (double& value : lights[c]) {
            value /= LIVERY_MUTATED(twin_projector_white, c < 3 ? white_y : clear_y);
        }
    }
    return lights;
}

Spectrum scaled_ambient(const BenchDescription& bench) {
    Spectrum ambient = bench.ambient_spectrum;
    const double y = luminance(ambient);
    check_argument(y > 0.0, "bench: an ambient spectrum without light");
    for (double& value : ambient) value *= LIVERY_MUTATED(twin_ambient, bench.ambient / y);
    return ambient;
}

Sensor observer_sensor() {
    Sensor sensor{cie1931_x(), cie1931_y(), cie1931_z()};
    for (Spectrum& curve : sensor) {
        for (double& value : curve) value *= kSpectrumStep_nm;
    }
    return sensor;
}

Sensor camera_sensor(const BenchDescription& bench) {
    Sensor sensor = bench.camera.sensitivities;
    Spectrum white{};
    const auto lights = scaled_lights(bench.projector.spectra);
    for (std::size_t k = 0; k < white.size(); ++k) {
        white[k] = lights[0][k] + lights[1][k] + lights[2][k];
    }
    const double green = reading(white, sensor).y;
    check_argument(green > 0.0, "bench: a camera that is blind to the projector");
    for (Spectrum& curve : sensor) {
        for (double& value : curve) {
            value *= LIVERY_MUTATED(twin_sensitivity, bench.camera.sensitivity_units_per_s / green);
        }
    }
    return sensor;
}

Factors fold(const BenchDescription& bench, const SurfaceSet& surfaces, const Sensor& sensor) {
    const auto lights = scaled_lights(bench.projector.spectra);
    const Spectrum ambient = scaled_ambient(bench);
    Factors factors;
    for (const Spectrum& seen : surfaces.reflectances) {
        factors.direct.push_back(per_channel(lights, seen, sensor));
        factors.ambient.push_back(reading(product(ambient, seen), sensor));
        auto& row = factors.bounce.emplace_back();
        for (const Spectrum& lit : surfaces.reflectances) {
            row.push_back(per_channel(lights, product(seen, lit), sensor));
        }
    }
    return factors;
}

}  // namespace livery
