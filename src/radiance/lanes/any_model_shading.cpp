#include "radiance/lanes/any_model_shading.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/packing.hpp>

#include "core/mutation.h"

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

}  // namespace

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

}  // namespace livery
