#include "ledger/drawn_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include "appearance/hard_cases.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "core/colour.h"
#include "core/worst_error.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "radiance/lanes/processor_shading.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "radiance/surface_map.h"

namespace livery {

namespace {

int rows_of(const LooseFragments& fragments) {
    const std::size_t row = kPackedWidth;
    return static_cast<int>(std::max<std::size_t>(1, (fragments.size() + row - 1) / row));
}

/// In the packed layout; after the last fragment its first one again, so that all of a row draws.
template <typename Value>
void upload(InputLayers& layers, const std::vector<Value>& values, int layer, int rows) {
    std::vector<float> rgba(4 * static_cast<std::size_t>(rows) * kPackedWidth, 1.0f);
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
        const Value& value = values[i < values.size() ? i : 0];
        for (int c = 0; c < Value::length(); ++c) {
            rgba[4 * i + static_cast<std::size_t>(c)] = value[c];
        }
    }
    layers.upload(rgba, layer);
}

ShadingInputs inputs_of(const LooseFragments& fragments, ShadingDevice device) {
    using enum InputLayers::Precision;
    const int rows = rows_of(fragments);
    ShadingInputs inputs;
    const auto one = [&](InputLayers& layers, const auto& values, InputLayers::Precision kind) {
        if (values.empty()) return;
        layers.make(device, rows, 0, kind);
        upload(layers, values, 0, rows);
    };
    one(inputs.lit, fragments.lit, half);
    one(inputs.eye, fragments.eye, full);
    one(inputs.sky, fragments.sky, half);
    one(inputs.places, fragments.places, full);
    if (!fragments.lights.empty()) {
        inputs.lights.make(device, rows, static_cast<int>(fragments.lights.size()), full);
        for (std::size_t k = 0; k < fragments.lights.size(); ++k) {
            upload(inputs.lights, fragments.lights[k], static_cast<int>(k), rows);
        }
    }
    if (!fragments.sky.empty()) {
        inputs.mirror.make(device, rows, static_cast<int>(kMirrorLayers), half);
        for (std::size_t k = 0; k < kMirrorLayers; ++k) {
            upload(inputs.mirror, fragments.mirror[k], static_cast<int>(k), rows);
        }
    }
    inputs.mirror_unit = fragments.mirror_unit;
    inputs.light_irradiance = fragments.light_irradiance;
    inputs.light_radius2 = fragments.light_radius2;
    inputs.product_scale = fragments.product_scale;
    return inputs;
}

std::vector<glm::vec3> colours_of(const ImageF& picture, std::size_t count) {
    std::vector<glm::vec3> colours(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* v = picture.values.data() + 4 * i;
        colours[i] = {v[0], v[1], v[2]};
    }
    return colours;
}

}  // namespace

std::vector<glm::vec3> shaded_in_lanes(const Material& material,
                                       const LooseFragments& fragments,
                                       double exposure_ev,
                                       const LaneFunctions& functions) {
    // A picture in which each fragment is a pixel
    SurfaceMap map;
    map.width = kPackedWidth;
    map.height = rows_of(fragments);
    map.samples_per_pixel = 1;
    map.coverage = ImageF(map.width, map.height, 1, 1.0f);
    map.part_begin = {0, static_cast<std::uint32_t>(fragments.size())};
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        Fragment& fragment = map.fragments.emplace_back();
        fragment.coverage = 1.0f;
        fragment.pixel = static_cast<std::uint32_t>(i);
    }
    const PackedLayout layout = layout_of(map);
    ProcessorShading shading(map, layout);
    shading.shade(
        material, inputs_of(fragments, ShadingDevice::processor), exposure_ev, 0, functions);
    ImageF picture(map.width, map.height, 4);
    shading.resolve(&picture);
    return colours_of(picture, fragments.size());
}

std::vector<glm::vec3> shaded_in_gl(const Material& material,
                                    const LooseFragments& fragments,
                                    double exposure_ev) {
    const int rows = rows_of(fragments);
    const ShadingInputs inputs = inputs_of(fragments, ShadingDevice::gl);
    const Texture2D target(kPackedWidth, rows, TexelFormat::rgba32f);
    const Framebuffer framebuffer({&target});
    ShadingPrograms programs;
    programs.shade(material, inputs, exposure_ev, {0, 0, kPackedWidth, rows}, framebuffer);
    return colours_of(read_floats(target), fragments.size());
}

namespace {

constexpr std::size_t kFragments = 1u << 14u, kQuickFragments = 1u << 10u;
constexpr std::size_t kMeasuredPairs = 2000;
constexpr double kThickest_nm = 2000.0;

/// A power of two, so that nothing is rounded: peaks of 1e11 end below what a picture holds.
constexpr double kExposure_ev = -24.0;

float half_rounded(double value) {
    return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value)));
}

double between(Random& random, double low, double high) {
    return low * std::pow(high / low, random.uniform());
}

bool has_disc(DrawnLight light) {
    return light == DrawnLight::disc || light == DrawnLight::disc_relief ||
           light == DrawnLight::film || light == DrawnLight::glints;
}

bool has_relief(DrawnLight light) {
    return light == DrawnLight::relief || light == DrawnLight::disc_relief;
}

void add_light(LooseFragments& fragments,
               DrawnLight light,
               const std::vector<RoundedPair>& pairs,
               Random& random) {
    std::vector<glm::vec4>& toward = fragments.lights.emplace_back();
    for (const RoundedPair& pair : pairs) {
        const double visible = random.uniform() < 0.5 ? 1.0 : random.uniform();
        toward.emplace_back(pair.wi, static_cast<float>(visible));
    }
    // An uneven light would hide no error of a colour.
    fragments.light_irradiance = {glm::vec3(3.0f, 2.5f, 2.0f)};
    constexpr double kLeast = 1e-3, kWidest = 5.0 * std::numbers::pi / 180.0;
    const double radius = has_disc(light) ? between(random, kLeast, kWidest) : 0.0;
    fragments.light_radius2 = {static_cast<float>(radius * radius)};
}

/// A sky that changes from lobe to lobe as a real one's does, no more than twice as bright.
void add_environment(LooseFragments& fragments, std::size_t count, Random& random) {
    const auto colour = [&](double low, double high) {
        return glm::vec3(half_rounded(low + (high - low) * random.uniform()),
                         half_rounded(low + (high - low) * random.uniform()),
                         half_rounded(low + (high - low) * random.uniform()));
    };
    for (std::size_t i = 0; i < count; ++i) {
        fragments.sky.push_back(colour(0.1, 2.0));
        const glm::vec3 narrow = colour(0.5, 1.5), wide = colour(0.5, 1.5);
        for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
            const float share = static_cast<float>(k) / (kMirrorAlphas.size() - 1);
            const glm::vec3 mixed = narrow + share * (wide - narrow);
            fragments.mirror[k].emplace_back(half_rounded(static_cast<double>(mixed.x)),
                                             half_rounded(static_cast<double>(mixed.y)),
                                             half_rounded(static_cast<double>(mixed.z)));
        }
        for (std::size_t k = kMirrorAlphas.size(); k < kMirrorLayers; ++k) {
            fragments.mirror[k].push_back(colour(0.5, 1.5));
        }
    }
    fragments.mirror_unit = 1.25f;
}

/// Saturated colours, lobes of `alpha` and stretched across.
Material material_of(ReflectanceModel model, DrawnLight light, double alpha, double stretch) {
    Material material;
    material.name = model_info(model).name;
    material.model = model;
    const glm::dmat3 rec709 = rec709_from_working();
    material.diffuse = rec709 * glm::dvec3(0.8, 0.3, 0.05);
    material.f0 = rec709 * glm::dvec3(0.7, 0.25, 0.03);
    material.specular = rec709 * glm::dvec3(0.5, 0.2, 0.1);
    material.flake_f0 = rec709 * glm::dvec3(0.1, 0.4, 0.6);
    material.coat_transmittance = rec709 * glm::dvec3(0.95, 0.7, 0.3);
    material.alpha = {alpha, std::min(alpha * stretch, 1.0)};
    for (int k = 0; k < 2; ++k) {
        material.exponent[k] = std::clamp(exponent_of(material.alpha[k]), 1.0, 1e6);
    }
    material.flake_alpha = std::min(2.5 * alpha, 1.0);
    material.coat_alpha = alpha;
    material.diffuse_roughness = 0.7;
    if (light == DrawnLight::film || light == DrawnLight::glints) {
        // The flakes alone: what lies over and under them would hide where they turn dark.
        material.diffuse = material.f0 = glm::dvec3(0.0);
        material.coat_f0 = 0.0;
    }
    if (light == DrawnLight::glints) material.glint_density_per_mm2 = 150.0;
    return material;
}

/// What an instrument would have found on a GGX surface.
std::shared_ptr<const MeasuredPaint> measured_table(double alpha) {
    const f64::BsdfParameters p = ledger_parameters(alpha, 1.0);
    MeasuredSamples samples;
    Random random(17);
    for (const RoundedPair& pair : ledger_directions(alpha, kMeasuredPairs, random)) {
        const glm::dvec3 wi(pair.wi), wo(pair.wo);
        const glm::dvec3 xyz =
            glm::inverse(working_from_xyz()) * evaluate(ReflectanceModel::ggx, p, wi, wo);
        if (!(std::min({xyz.x, xyz.y, xyz.z}) >= 0.0)) continue;
        samples.pairs.push_back({wi, wo});
        for (int c = 0; c < 3; ++c) samples.values.push_back(xyz[c]);
    }
    return std::make_shared<const MeasuredPaint>(
        measured_paint(measured_from(std::move(samples), MeasuredFormat::csv, "ggx.csv")));
}

/// What errors are told as shares of: see DrawnError.
std::vector<glm::dvec3> scales_of(DrawnLight light,
                                  const Material& material,
                                  const LooseFragments& fragments,
                                  const std::vector<glm::dvec3>& truth) {
    std::vector<glm::dvec3> scales = truth;
    if (light == DrawnLight::film) {
        for (glm::dvec3& scale : scales) {
            scale = glm::dvec3(std::max({scale.x, scale.y, scale.z}));
        }
    } else if (light == DrawnLight::glints) {
        Material smooth = material;
        smooth.glint_density_per_mm2 = 0.0;
        const auto mean = shaded_in_double(smooth, fragments, kExposure_ev);
        for (std::size_t i = 0; i < scales.size(); ++i) scales[i] += mean[i];
    }
    return scales;
}

struct Compared {
    double worst = 0.0;
    std::size_t invalid = 0;
};

template <typename Values>
Compared compared(const Values& values,
                  const std::vector<glm::dvec3>& truth,
                  const std::vector<glm::dvec3>& scales) {
    const double unit = std::exp2(-kExposure_ev);
    Compared result;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const auto value = static_cast<double>(values[i][c]);
            result.invalid += std::isfinite(value) && value >= 0.0 ? 0u : 1u;
            const double scale = scales[i][c];
            const double off = worst_if_nan(std::abs(value - truth[i][c]));
            const bool dark = unit * scale <= kLeastComparedValue && std::isfinite(off);
            result.worst = worse_of(result.worst, dark ? 0.0 : off / scale);
        }
    }
    return result;
}

void add_errors(DrawnError& row, const Material& material, const LooseFragments& fragments) {
    const auto truth = shaded_in_double(material, fragments, kExposure_ev);
    const auto scales = scales_of(row.light, material, fragments, truth);
    const Compared lanes =
        compared(shaded_in_lanes(material, fragments, kExposure_ev), truth, scales);
    const Compared gl = compared(shaded_in_gl(material, fragments, kExposure_ev), truth, scales);
    row.values += 3 * truth.size();
    row.invalid += lanes.invalid + gl.invalid + compared(truth, truth, scales).invalid;
    row.in_lanes = worse_of(row.in_lanes, lanes.worst);
    row.in_gl = worse_of(row.in_gl, gl.worst);
}

std::vector<double> alphas_of(ReflectanceModel model, bool quick) {
    if (model == ReflectanceModel::measured) {
        return quick ? std::vector<double>{0.1} : std::vector<double>{0.03, 0.1, 0.3};
    }
    std::vector<double> alphas = ledger_alphas(model);
    if (quick) alphas = {alphas.front(), 0.01, 1.0};
    return model_info(model).mirrors() ? alphas : std::vector<double>{1.0};
}

}  // namespace

std::string to_string(DrawnLight light) {
    switch (light) {
        case DrawnLight::even:
            return "light on a diffuser";
        case DrawnLight::point:
            return "point";
        case DrawnLight::disc:
            return "disc";
        case DrawnLight::relief:
            return "relief";
        case DrawnLight::disc_relief:
            return "disc, relief";
        case DrawnLight::environment:
            return "environment";
        case DrawnLight::film:
            return "film";
        case DrawnLight::glints:
            return "glints";
    }
    return {};
}

std::vector<DrawnLight> drawn_lights(ReflectanceModel model) {
    if (model == ReflectanceModel::lambert) return {DrawnLight::even};
    std::vector<DrawnLight> lights{DrawnLight::point,
                                   DrawnLight::disc,
                                   DrawnLight::relief,
                                   DrawnLight::disc_relief,
                                   DrawnLight::environment};
    if (model == ReflectanceModel::car_paint) {
        lights.push_back(DrawnLight::film);
        lights.push_back(DrawnLight::glints);
    }
    return lights;
}

LooseFragments drawn_fragments(DrawnLight light, double alpha, std::size_t count, Random& random) {
    std::vector<RoundedPair> pairs = ledger_directions(alpha, count, random);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        auto& [wi, wo] = pairs[k];
        if (k % 10 == 0) wi = {-wo.x, -wo.y, wo.z};
        if (k % 10 == 1) {
            const double low = between(random, 1.745e-4, 1e-2),
                         other = between(random, 1.745e-4, 1e-2);
            const double phi = 2.0 * std::numbers::pi * random.uniform();
            const double turn = phi + std::numbers::pi + 1e-3 * random.normal();
            wi = {glm::dvec3(std::sqrt(1.0 - low * low) * std::cos(phi),
                             std::sqrt(1.0 - low * low) * std::sin(phi),
                             low)};
            wo = {glm::dvec3(std::sqrt(1.0 - other * other) * std::cos(turn),
                             std::sqrt(1.0 - other * other) * std::sin(turn),
                             other)};
        }
    }
    LooseFragments fragments;
    for (const RoundedPair& pair : pairs) {
        const double slope2 = has_relief(light) ? between(random, 1e-8, 0.1) : 0.0;
        fragments.eye.emplace_back(pair.wo, static_cast<float>(slope2));
        if (light == DrawnLight::even) {
            fragments.lit.emplace_back(half_rounded(random.uniform()));
        } else if (light == DrawnLight::glints) {
            fragments.places.emplace_back(500.0 * random.normal(),
                                          500.0 * random.normal(),
                                          500.0 * random.normal(),
                                          between(random, 0.1, 4.0));
        }
    }
    if (light == DrawnLight::environment) {
        add_environment(fragments, pairs.size(), random);
    } else if (light != DrawnLight::even) {
        add_light(fragments, light, pairs, random);
    }
    return fragments;
}

std::vector<DrawnError> drawn_errors(ReflectanceModel model,
                                     bool quick,
                                     std::uint64_t seed,
                                     const Progress& progress) {
    const std::size_t count = quick ? kQuickFragments : kFragments;
    std::vector<DrawnError> rows;
    std::vector<double> stretches = {1.0};
    if (model != ReflectanceModel::measured) stretches = ledger_stretches(model);
    for (const double alpha : alphas_of(model, quick)) {
        const auto table = model == ReflectanceModel::measured ? measured_table(alpha) : nullptr;
        for (const DrawnLight light : drawn_lights(model)) {
            progress.check_stop();
            Random random(seed, rows.size());
            DrawnError& row = rows.emplace_back();
            row.paint = model_info(model).name;
            row.light = light;
            row.alpha = alpha;
            row.allowed = std::max(1e-4, 4e-7 / alpha);
            for (const double stretch : stretches) {
                Material material = material_of(model, light, alpha, stretch);
                material.measured = table;
                const std::size_t sizes = has_disc(light) ? 16 : 1;  // of the disc
                for (std::size_t k = 0; k < sizes; ++k) {
                    if (light == DrawnLight::film) {
                        material.film_nm = kThickest_nm * (static_cast<double>(k) + 0.5) /
                                           static_cast<double>(sizes);
                    }
                    add_errors(row, material, drawn_fragments(light, alpha, count / sizes, random));
                }
            }
        }
    }
    return rows;
}

}  // namespace livery
