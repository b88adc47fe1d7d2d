#include "radiance/lanes/processor_shading.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include "appearance/model_table.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "radiance/glints.h"
#include "radiance/light/mirror_quadrature.h"

// What shade.glsl is written in, as plain floats.
#define REAL float
#define VEC2 glm::vec2
#define VEC3 glm::vec3
#define VEC4 glm::vec4
#define R(x) static_cast<float>(x)
#define FN
#define UNIFORM
#define IS_NAN(x) ((x) != (x))
#define ANY_MODEL
#define LIGHTS 1
#define LIGHT_COUNT job.light_count
#define ENVIRONMENT 1
#define MIRRORED 1
#define MIRRORS 1
#define WEIGHTS kEnvironmentWeights
#define BSDF_TURN2 turn2

namespace livery {

namespace {

/// Small enough that two threads end together, large enough that starting one is nothing.
constexpr std::size_t kBlocksAtOnce = 64, kPixelsAtOnce = 2048;

using f32::BsdfParameters, f32::bsdf_widen;
using glm::clamp, glm::dot, glm::max, glm::min, glm::mix, std::sqrt;

/// An array of uniforms, by light.
struct LampRadiance {
    const float* of_light;
    glm::vec3 operator[](int k) const {
        return {of_light[3 * k], of_light[3 * k + 1], of_light[3 * k + 2]};
    }
};

/// What a fragment reads; without an environment, or for a model that mirrors nothing, black.
struct FragmentValues {
    const LaneJob& job;
    const ModelInfo& model;
    const MeasuredPaint* measured;
    std::size_t block = 0, lane = 0;
    const float turn2 = static_cast<float>(lobe_turn_squared(model));
    LampRadiance u_light_radiance{job.light_irradiance};
    const float* u_light_radius2 = job.light_radius2;

    FragmentValues(const LaneJob& its_job,
                   const ModelInfo& its_model,
                   const MeasuredPaint* its_measured)
        : job(its_job), model(its_model), measured(its_measured) {}

    glm::vec3 bsdf_eval(const BsdfParameters& p, const glm::vec3& wi, const glm::vec3& wo) const {
        return measured ? evaluate(*measured, wi, wo) : model.f32.eval(p, wi, wo);
    }
    glm::vec4 four(const float* values) const {
        const float* from = values + 4 * kLaneBlock * block + lane;
        return {from[0], from[kLaneBlock], from[2 * kLaneBlock], from[3 * kLaneBlock]};
    }
    glm::vec3 three(const std::uint16_t* values) const {
        const std::uint16_t* from = values + 3 * kLaneBlock * block + lane;
        return {glm::unpackHalf1x16(from[0]),
                glm::unpackHalf1x16(from[kLaneBlock]),
                glm::unpackHalf1x16(from[2 * kLaneBlock])};
    }
    glm::vec4 eye_here() const { return four(job.eye); }
    glm::vec4 light_here(int k) const { return four(job.lights[k]); }
    glm::vec3 sky_here() const { return job.sky ? three(job.sky) : glm::vec3(0.0f); }
    /// One without a share need not be there.
    glm::vec3 share_of(float share, const std::uint16_t* layer) const {
        return share == 0.0f ? glm::vec3(0.0f) : share * three(layer);
    }
    glm::vec3 mirrored_here(const glm::vec4& layers, float) const {
        if (!job.mirror) return glm::vec3(0.0f);
        const std::uint16_t* const* first = job.mirror + static_cast<int>(layers.x);
        const float left = 1.0f - layers.y - layers.z - layers.w;
        const glm::vec3 sum = share_of(left, first[0]) + share_of(layers.y, first[1]) +
                              share_of(layers.z, first[2]) + share_of(layers.w, first[3]);
        return job.mirror_unit * max(sum, glm::vec3(0.0f));
    }
};

struct Shader : FragmentValues {
#include "shaders/radiance/shade.glsl"

    Shader(const LaneJob& its_job, const ModelInfo& its_model, const AnyModelUniforms& u)
        : FragmentValues(its_job, its_model, u.measured.get()),
          u_exposure(u.exposure),
          u_paint(u.paint),
          u_base_layers(u.base_layers),
          u_lobe_alpha(u.lobe_alpha) {
        std::copy(u.sky_weight.begin(), u.sky_weight.end(), u_sky_weight);
        std::copy(u.mirror_weight.begin(), u.mirror_weight.end(), u_mirror_weight);
    }
};

/// The blocks of `job`, whose own uniforms are not read, of any model, one fragment after another:
/// for those that are not taken apart for eight at a time. Without job.sky or job.mirror no light
/// comes from there.
void shade_any_model(const LaneJob& job, const ModelInfo& model, const AnyModelUniforms& uniforms) {
    Shader shader(job, model, uniforms);
    for (shader.block = job.first_block; shader.block < job.end_block; ++shader.block) {
        for (shader.lane = 0; shader.lane < kLaneBlock; ++shader.lane) {
            float* to = job.shaded + 4 * (kLaneBlock * shader.block + shader.lane);
            if (!job.artwork) {
                const glm::vec3 colour = shader.shaded();
                for (int c = 0; c < 3; ++c) to[c] = colour[c];
                to[3] = 1.0f;
                continue;
            }
            const glm::vec4 mean = shader.four(job.artwork);
            if (mean.w <= 0.0f) continue;  // what is no number must show
            const glm::vec3 colour = shader.shaded();
            for (int c = 0; c < 3; ++c) {
                to[c] = to[c] * (1.0f - job.of_cover * mean.w) +
                        colour[c] * (job.of_colour * mean[c] + job.of_alpha * mean.w);
            }
        }
    }
}

}  // namespace

ProcessorShading::ProcessorShading(const SurfaceMap& map, const PackedLayout& layout)
    : layout_(layout),
      index_(index_fragments(map, layout)),
      shaded_(static_cast<std::size_t>(layout.rows) * kPackedWidth * 4, 0.0f) {}

void ProcessorShading::shade(const Material& material,
                             const ShadingInputs& inputs,
                             double exposure_ev,
                             std::size_t part,
                             const LaneFunctions& functions) {
    shade(material, inputs, exposure_ev, part, functions, LaneJob());
}

void ProcessorShading::shade(const ArtworkCoat& coat,
                             const InputLayers& means,
                             const ShadingInputs& inputs,
                             double exposure_ev,
                             std::size_t part,
                             const LaneFunctions& functions) {
    LaneJob job;
    job.artwork = means.floats(coat.layer);
    job.of_colour = coat.of_colour;
    job.of_alpha = coat.of_alpha;
    job.of_cover = coat.of_cover;
    shade(coat.material, inputs, exposure_ev, part, functions, job);
}

void ProcessorShading::shade(const Material& material,
                             const ShadingInputs& inputs,
                             double exposure_ev,
                             std::size_t part,
                             const LaneFunctions& functions,
                             LaneJob job) {
    const ModelInfo& model = model_info(material.model);
    std::vector<const float*> lights;
    std::vector<const std::uint16_t*> mirror;
    const auto environment = static_cast<bool>(inputs.sky);
    if (model.same_from_all_sides) {
        job.lit = inputs.lit.halves(0);
    } else {
        job.eye = inputs.eye.floats(0);
        for (std::size_t k = 0; k < inputs.light_irradiance.size(); ++k) {
            lights.push_back(inputs.lights.floats(k));
        }
        job.lights = lights.data();
        job.light_count = static_cast<int>(lights.size());
        job.light_irradiance = lights.empty() ? nullptr : &inputs.light_irradiance[0].x;
        job.light_radius2 = inputs.light_radius2.data();
        if (environment) job.sky = inputs.sky.halves(0);
        if (environment && model.mirrors() && inputs.mirror) {
            for (std::size_t k = 0; k < kMirrorLayers; ++k) {
                mirror.push_back(inputs.mirror.has(k) ? inputs.mirror.halves(k) : nullptr);
            }
            job.mirror = mirror.data();
            job.mirror_unit = inputs.mirror_unit;
            job.grazing = mirror.data() + kMirrorAlphas.size();
        }
    }
    std::function<void(const LaneJob&)> shade_blocks;
    PaintUniforms uniforms;
    if (has_own_shading(material.model)) {
        uniforms = uniforms_of(material, exposure_ev, inputs.mirror_mixing);
        job.exposure = uniforms.exposure;
        job.prepared = uniforms.paint.numbers.data();
        job.lobe_layers = &uniforms.lobe_layers[0].x;
        const bool glints = !lights.empty() && has_glints(material);
        if (glints) {
            job.places = inputs.places.floats(0);
            job.glint_density =
                static_cast<float>(glint_density_on_mock_up(material, inputs.product_scale));
        }
        shade_blocks = functions.of(model.prepared.type, environment, glints);
    } else {
        shade_blocks = [&model,
                        any = any_model_uniforms_of(material, exposure_ev, inputs.mirror_mixing)](
                           const LaneJob& some) { shade_any_model(some, model, any); };
    }
    job.shaded = shaded_.data();
    const std::size_t first = layout_.address(layout_.part_begin[part], part) / kLaneBlock;
    const std::size_t blocks = (layout_.fragments(part) + kLaneBlock - 1) / kLaneBlock;
    parallel_for(blocks, kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
        LaneJob some = job;
        some.first_block = first + begin;
        some.end_block = first + end;
        shade_blocks(some);
    });
}

void ProcessorShading::resolve(ImageF* picture) const {
    // Plain pointers: this runs for each fragment of each pixel.
    const float* shaded = shaded_.data();
    const std::uint32_t *words = index_.words.data(), *pixels = index_.pixels.data(),
                        *lists = index_.lists.data();
    float* out = picture->values.data();
    const float share = 1.0f / static_cast<float>(index_.samples_per_pixel);
    parallel_for(index_.pixels.size(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::uint32_t word = words[i];
            float* to = out + 4 * static_cast<std::size_t>(pixels[i]);
            if (!FragmentIndex::more(word)) {
                std::memcpy(to, shaded + 4 * std::size_t{index_.address(word)}, 4 * sizeof(float));
                to[3] = share * static_cast<float>(index_.samples(word));
                continue;
            }
            std::size_t at = index_.address(word);
            float sum[3] = {0.0f, 0.0f, 0.0f}, covered = 0.0f;
            do {
                word = lists[at++];
                const auto samples = static_cast<float>(index_.samples(word));
                const float* from = shaded + 4 * std::size_t{index_.address(word)};
                for (std::size_t c = 0; c < 3; ++c) sum[c] += samples * from[c];
                covered += samples;
            } while (FragmentIndex::more(word));
            // Fragments of less than half a sample cover nothing.
            for (std::size_t c = 0; c < 3; ++c) to[c] = covered > 0.0f ? sum[c] / covered : 0.0f;
            to[3] = share * covered;
        }
    });
}

}  // namespace livery
