#include "twin/received.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "twin/place.h"

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

Observer make_observer(const TracedObserver& traced,
                       Factors factors,
                       const Gathers& gathers,
                       const ImageF& dark) {
    Observer observer;
    const int width = traced.receivers.width, height = traced.receivers.height;
    observer.receivers = {&traced.receivers, std::move(factors)};
    observer.truth.lit = traced.lit;
    observer.truth.edge = traced.edge;
    observer.truth.seen_by_eye = traced.seen_by_eye;
    observer.truth.black_xyz = observe(observer, gathers, dark, true);
    observer.truth.primary_xyz = ImageF(width, height, 9);
    observer.clear_xyz = ImageF(width, height, 3);
    const LightPaths& lists = observer.receivers.traced->paths;
    parallel_for(lists.receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = lists.receiver[i];
            for (std::uint32_t t = lists.term_begin[i]; t < lists.term_begin[i + 1]; ++t) {
                const auto& direct = observer.receivers.factors.direct[lists.terms[t].surface];
                for (std::size_t k = 0; k < direct.size(); ++k) {
                    float* out = k < 3
                                     ? observer.truth.primary_xyz.values.data() + 9 * pixel + 3 * k
                                     : observer.clear_xyz.values.data() + 3 * pixel;
                    for (int c = 0; c < 3; ++c) {
                        out[c] += static_cast<float>(lists.terms[t].weight * direct[k][c]);
                    }
                }
            }
        }
    });
    return observer;
}

ImageF observe(const Observer& observer,
               const Gathers& gathers,
               const ImageF& light,
               bool ambient) {
    ImageF xyz = receive_all(observer.receivers, gathers, light);
    if (ambient) {
        const ImageF room = receive_ambient(observer.receivers);
        for (std::size_t k = 0; k < xyz.values.size(); ++k) xyz.values[k] += room.values[k];
    }
    return xyz;
}

Image8 reachable(const Observer& observer, const ImageF& wanted_xyz, double clear_strength) {
    const ObserverTruth& truth = observer.truth;
    const auto& receiver = observer.receivers.traced->paths.receiver;
    check_argument(wanted_xyz.width == truth.lit.width && wanted_xyz.height == truth.lit.height &&
                       wanted_xyz.channels == 3,
                   fmt::format("bench: a wanted picture of {}x{}x{} where {}x{} pixels are seen",
                               wanted_xyz.width,
                               wanted_xyz.height,
                               wanted_xyz.channels,
                               truth.lit.width,
                               truth.lit.height));
    constexpr double kTolerance = 1e-4;
    Image8 answer(wanted_xyz.width, wanted_xyz.height, 1);
    parallel_for(receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = receiver[i];
            glm::dmat3 xyz_from_light;
            glm::dvec3 wanted, clear;
            for (int c = 0; c < 3; ++c) {
                const auto channel = static_cast<std::size_t>(c);
                wanted[c] = double(wanted_xyz.values[3 * pixel + channel]) -
                            truth.black_xyz.values[3 * pixel + channel];
                clear[c] = clear_strength * observer.clear_xyz.values[3 * pixel + channel];
                for (int k = 0; k < 3; ++k) {
                    xyz_from_light[k][c] =
                        truth.primary_xyz
                            .values[9 * pixel + 3 * static_cast<std::size_t>(k) + channel];
                }
            }
            if (!(std::abs(glm::determinant(xyz_from_light)) > 0.0)) continue;
            const glm::dmat3 light_from_xyz = glm::inverse(xyz_from_light);
            glm::dvec3 light = light_from_xyz * wanted;
            // With a clear segment the light is l = light - m d, where m = min(l) >= 0 is what
            // the channels have in common and d what the segment adds for it, in units of the
            // primaries. min(light - m d) - m falls with m (1 + d > 0), so its root is unique.
            if (clear_strength > 0.0) {
                const glm::dvec3 d = light_from_xyz * clear;
                double common = 1e30;
                for (int k = 0; k < 3; ++k) common = std::min(common, light[k] / (1.0 + d[k]));
                light -= std::max(0.0, common) * d;
            }
            bool inside = true;
            for (int k = 0; k < 3; ++k) {
                inside = inside && light[k] >= -kTolerance && light[k] <= 1.0 + kTolerance;
            }
            answer.values[pixel] = inside ? 255 : 0;
        }
    });
    return answer;
}

Image8 mostly_lit_by(const Observer& observer, const Image8& mask) {
    const LightPaths& paths = observer.receivers.traced->paths;
    Image8 answer(observer.receivers.traced->width, observer.receivers.traced->height, 1);
    for (std::size_t i = 0; i < paths.receiver.size(); ++i) {
        double all = 0.0, from_mask = 0.0;
        for (std::uint32_t t = paths.term_begin[i]; t < paths.term_begin[i + 1]; ++t) {
            const PathTerm& term = paths.terms[t];
            all += term.weight;
            if (mask.values[term.pixel]) from_mask += term.weight;
        }
        if (all > 0.0 && 2.0 * from_mask >= all) answer.values[paths.receiver[i]] = 255;
    }
    return answer;
}

View eye_view(const glm::dvec3& eye_mm, const View& projector, const Mesh& mockup) {
    const Bounds bounds = bounds_of(mockup);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double radius = 0.5 * glm::distance(bounds.low, bounds.high);
    const double distance = glm::distance(eye_mm, middle);
    check_argument(distance > radius, "bench: the eye is inside the mock-up's box");
    const double pixel_mm =
        glm::distance(centre_in_world(projector), middle) / projector.focal_px.x;
    const double focal_px = distance / pixel_mm;

    // A picture that holds the ball around the mock-up, then what the mock-up needs of it.
    constexpr int kLargest = 8192, kMargin = 4;
    const double half = focal_px * radius / std::sqrt(distance * distance - radius * radius);
    const int side = std::min(kLargest, 2 * (static_cast<int>(std::ceil(half)) + kMargin));
    const View whole = look_at(eye_mm, middle, 2.0 * std::atan(0.5 * side / focal_px), side, side);
    const PixelRectangle box = pixels_that_see(whole, mockup, kMargin);
    return cropped(whole, box.left, box.top, box.right - box.left, box.bottom - box.top);
}

}  // namespace livery
