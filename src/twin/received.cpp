#include "twin/received.h"

#include <algorithm>

#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"

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

namespace {

/// Sum of weight x light over terms [begin, end), then the surface's factors on the sum: the terms
/// of one surface lie together.
template <typename FactorsOfSurface>
glm::vec3 sum_terms(const PathTerm* term,
                    const PathTerm* end,
                    const float* light,
                    const FactorsOfSurface& factors_of) {
    glm::vec3 reading(0.0f);
    while (term != end) {
        const std::uint16_t surface = term->surface;
        float sum[kLightChannels] = {};
        for (; term != end && term->surface == surface; ++term) {
            const float* source = light + static_cast<std::size_t>(term->pixel) * kLightChannels;
            for (int k = 0; k < kLightChannels; ++k) sum[k] += term->weight * source[k];
        }
        const Factors::PerChannel& factors = factors_of(surface);
        for (std::size_t k = 0; k < factors.size(); ++k) reading += sum[k] * glm::vec3(factors[k]);
    }
    return reading;
}

template <typename Body>
ImageF picture(const Receivers& receivers, const Body& reading_of) {
    const std::vector<std::uint32_t>& pixels = receivers.traced->paths.receiver;
    ImageF image(receivers.traced->width, receivers.traced->height, 3);
    parallel_for(pixels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 reading = reading_of(i);
            float* out = image.values.data() + 3 * static_cast<std::size_t>(pixels[i]);
            for (int c = 0; c < 3; ++c) out[c] = reading[c];
        }
    });
    return image;
}

}  // namespace

std::vector<glm::vec3> bounced_light(const Gathers& gathers,
                                     const Factors& factors,
                                     const ImageF& light) {
    if (gathers.begin.empty()) return {};
    const std::size_t places = gathers.begin.size() - 1, surfaces = factors.bounce.size();
    std::vector<glm::vec3> bounced(places * surfaces);
    parallel_for(places, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const PathTerm* first = gathers.terms.data() + gathers.begin[p];
            const PathTerm* last = gathers.terms.data() + gathers.begin[p + 1];
            for (std::size_t seen = 0; seen < surfaces; ++seen) {
                bounced[p * surfaces + seen] = sum_terms(
                    first, last, light.values.data(), [&](std::uint16_t lit) -> auto& {
                        return factors.bounce[seen][lit];
                    });
            }
        }
    });
    return bounced;
}

glm::vec3 receive(const Receivers& receivers,
                  const std::vector<glm::vec3>& bounced,
                  const ImageF& light,
                  std::size_t i) {
    const LightPaths& paths = receivers.traced->paths;
    glm::vec3 reading = sum_terms(
        paths.terms.data() + paths.term_begin[i],
        paths.terms.data() + paths.term_begin[i + 1],
        light.values.data(),
        [&](std::uint16_t surface) -> auto& { return receivers.factors.direct[surface]; });
    const std::vector<Gathers::Blend>& blends = receivers.traced->blends;
    if (blends.empty()) return reading;
    const Gathers::Blend& blend = blends[i];
    const std::size_t surfaces = receivers.factors.bounce.size();
    for (std::uint32_t c = paths.cover_begin[i]; c < paths.cover_begin[i + 1]; ++c) {
        const CoverTerm& cover = paths.covers[c];
        for (std::size_t k = 0; k < blend.place.size() && blend.weight[k] > 0.0f; ++k) {
            reading +=
                cover.share * blend.weight[k] * bounced[blend.place[k] * surfaces + cover.surface];
        }
    }
    return reading;
}

ImageF receive_all(const Receivers& receivers, const Gathers& gathers, const ImageF& light) {
    const auto bounced = bounced_light(gathers, receivers.factors, light);
    return picture(receivers, [&](std::size_t i) { return receive(receivers, bounced, light, i); });
}

glm::vec3 receive_ambient(const Receivers& receivers, std::size_t i) {
    const LightPaths& paths = receivers.traced->paths;
    glm::dvec3 reading(0.0);
    for (std::uint32_t c = paths.cover_begin[i]; c < paths.cover_begin[i + 1]; ++c) {
        reading += static_cast<double>(paths.covers[c].share) *
                   receivers.factors.ambient[paths.covers[c].surface];
    }
    return glm::vec3(reading);
}

ImageF receive_ambient(const Receivers& receivers) {
    return picture(receivers, [&](std::size_t i) { return receive_ambient(receivers, i); });
}

}  // namespace livery
