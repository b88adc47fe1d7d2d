#include "radiance/fragment_inputs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/parallel.h"

namespace livery {
namespace {

constexpr float kHalfLargest = 65000.0f;

bool same_disc(const DirectionalLight& a, const DirectionalLight& b) {
    return a.direction == b.direction && a.angle_rad == b.angle_rad;
}

/// Into the fragment's own frame: tangent, across, mean normal.
glm::vec3 to_local(const Fragment& f, const glm::vec3& direction) {
    const glm::vec3 s(f.tangent);
    const glm::vec3 t = f.tangent.w * glm::cross(f.normal, s);
    return {glm::dot(direction, s), glm::dot(direction, t), glm::dot(direction, f.normal)};
}

glm::vec3 radiance_working(const DirectionalLight& light) {
    return glm::vec3(working_from_rec709() * light.radiance_rec709);
}

}  // namespace

QualityRays rays_of(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return {1, 0, 0};
        case Quality::normal:
            return {16, 16, 8};
        case Quality::high:
            return {64, 64, 16};
        case Quality::reference:
            break;
    }
    throw std::invalid_argument("the reference level is the path tracer's");
}

double StageClock::now_ms() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

FragmentInputs::FragmentInputs(const Mesh& mesh,
                               const Tracer& tracer,
                               const SurfaceMap& map,
                               const PackedLayout& layout)
    : mesh_(mesh), tracer_(tracer), map_(map), layout_(layout) {}

bool FragmentInputs::update(const Scene& scene,
                            const FramePlan& plan,
                            StageClock& clock,
                            const Progress& progress) {
    bool changed = update_lights(scene, plan, clock, progress);
    changed = update_sky(scene, plan, clock, progress) || changed;
    const bool mirror = update_mirror(scene, plan, clock, progress);
    const bool directions = update_directions(scene, plan, clock, changed || mirror);
    const bool diffuse = update_diffuse_light(plan, clock, changed);
    return changed || mirror || directions || diffuse;
}

bool FragmentInputs::update_lights(const Scene& scene,
                                   const FramePlan& plan,
                                   StageClock& clock,
                                   const Progress& progress) {
    const int rays = rays_of(plan.quality).light;
    bool changed = false;
    std::vector<Light> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const std::string pass = visibility_pass(i);
        if (!find_pass(plan, pass)) continue;
        const DirectionalLight& light = scene.lights[i];
        const auto found = std::find_if(lights_.begin(), lights_.end(), [&](const Light& l) {
            return l.index == i && l.rays == rays && same_disc(l.light, light) && !l.at.empty();
        });
        Light next;
        next.index = i;
        next.light = light;
        next.rays = rays;
        const bool stale = found == lights_.end();
        if (!stale) {
            changed = changed || found->light.radiance_rec709 != light.radiance_rec709;
            next.at = found->at;
        }
        const bool solved = clock.run(pass, stale, [&] {
            next.at = light_at_fragments(mesh_, tracer_, map_, light, rays, progress);
        });
        changed = changed || solved;
        lights.push_back(std::move(next));
    }
    changed = changed || lights.size() != lights_.size();
    lights_ = std::move(lights);
    return changed;
}

bool FragmentInputs::update_sky(const Scene& scene,
                                const FramePlan& plan,
                                StageClock& clock,
                                const Progress& progress) {
    if (!find_pass(plan, kIrradiancePass)) {
        const bool had = environment_ != nullptr;
        environment_ = nullptr;
        sky_.clear();
        return had;
    }
    const int directions = rays_of(plan.quality).sky;
    const bool occluded = find_pass(plan, kOcclusionPass) != nullptr;
    const bool other_rays =
        occluded && (!sky_visibility_ || sky_visibility_->directions != directions);
    clock.run(kOcclusionPass, other_rays, [&] {
        sky_visibility_ = solve_sky_visibility(mesh_, tracer_, map_, directions, progress);
    });
    const bool other_map = environment_ != scene.environment;
    return clock.run(kIrradiancePass, other_map || other_rays || occluded != sky_occluded_, [&] {
        if (other_map) {
            FilteredEnvironment filtered =
                filter_environment(*scene.environment, {false, true, true}, progress);
            filtered_.diffuse = std::move(filtered.diffuse);
            filtered_.blurred = std::move(filtered.blurred);
        }
        sky_ = sky_at_fragments(
            map_, *scene.environment, filtered_, occluded ? &*sky_visibility_ : nullptr);
        environment_ = scene.environment;
        sky_occluded_ = occluded;
    });
}

bool FragmentInputs::update_mirror(const Scene& scene,
                                   const FramePlan& plan,
                                   StageClock& clock,
                                   const Progress& progress) {
    if (!find_pass(plan, kMirrorPass)) {
        const bool had = mirrored_ != nullptr;
        layered_ = mirrored_ = nullptr;
        filtered_.mirrored.clear();
        mirror_visibility_.reset();
        shading_.mirror = Texture2D();
        return had;
    }
    clock.run(kFilterPass, layered_ != scene.environment, [&] {
        filtered_.mirrored =
            filter_environment(*scene.environment, {true, false, false}, progress).mirrored;
        layered_ = scene.environment;
    });
    const int rays = rays_of(plan.quality).mirror;
    const bool occluded = find_pass(plan, kReflectionPass) != nullptr;
    const bool other_rays = occluded && (!mirror_visibility_ || mirror_visibility_->rays != rays ||
                                         visibility_eye_ != scene.eye_in_world_mm);
    const bool trust_sky = plan.quality != Quality::high && sky_visibility_;
    const SkyVisibility* sky = trust_sky ? &*sky_visibility_ : nullptr;
    clock.run(kReflectionPass, other_rays, [&] {
        mirror_visibility_ = solve_mirror_visibility(
            mesh_, tracer_, map_, scene.eye_in_world_mm, rays, sky, progress);
        visibility_eye_ = scene.eye_in_world_mm;
    });
    if (!occluded) mirror_visibility_.reset();
    const bool stale = mirrored_ != scene.environment || other_rays ||
                       occluded != mirror_occluded_ || mirror_eye_ != scene.eye_in_world_mm;
    return clock.run(kMirrorPass, stale, [&] {
        upload_mirror(scene);
        mirrored_ = scene.environment;
        mirror_occluded_ = occluded;
        mirror_eye_ = scene.eye_in_world_mm;
    });
}

void FragmentInputs::upload_mirror(const Scene& scene) {
    const MirrorVisibility* visibility = mirror_visibility_ ? &*mirror_visibility_ : nullptr;
    // Half floats hold the radiance in units in which the brightest texel fits.
    const ImageF& sharpest = filtered_.mirrored.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end()) *
                          static_cast<float>(scene.environment->scale);
    shading_.mirror_unit = std::max(1.0f, largest / kHalfLargest);
    make(shading_.mirror,
         {kPackedWidth, layout_.rows, static_cast<int>(kMirrorAlphas.size())},
         TexelFormat::rgba16f);
    const std::size_t layer_size = static_cast<std::size_t>(layout_.rows) * kPackedWidth * 4;
    std::vector<float> texels(layer_size * kMirrorAlphas.size(), 0.0f);
    parallel_for(map_.fragments.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto lobes = mirrored_at_fragment(
                mesh_, map_, i, *scene.environment, filtered_, scene.eye_in_world_mm, visibility);
            const std::size_t at = 4 * layout_.address(i, map_.fragments[i].part);
            for (std::size_t k = 0; k < lobes.size(); ++k) {
                for (std::size_t c = 0; c < 3; ++c) {
                    texels[k * layer_size + at + c] =
                        lobes[k][static_cast<int>(c)] / shading_.mirror_unit;
                }
            }
        }
    });
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        shading_.mirror.upload(std::span<const float>(texels).subspan(k * layer_size, layer_size),
                               0,
                               static_cast<int>(k));
    }
}

bool FragmentInputs::update_directions(const Scene& scene,
                                       const FramePlan& plan,
                                       StageClock& clock,
                                       bool changed) {
    if (!find_pass(plan, kDirectionsPass)) {
        eye_.reset();
        return false;
    }
    const bool stale = changed || eye_ != scene.eye_in_world_mm;
    return clock.run(kDirectionsPass, stale, [&] {
        upload_directions(scene);
        eye_ = scene.eye_in_world_mm;
    });
}

void FragmentInputs::upload_directions(const Scene& scene) {
    const TextureShape shape{kPackedWidth, layout_.rows};
    const auto fragment = [&](std::size_t i) -> const Fragment& { return map_.fragments[i]; };
    const auto upload = [&](Texture2D& texture, int layer, const auto& value) {
        texture.upload(std::span<const float>(packed(map_, layout_, value)), 0, layer);
    };
    make(shading_.eye, shape, TexelFormat::rgba32f);
    upload(shading_.eye, 0, [&](std::size_t i) {
        const glm::vec3 wo = toward_eye(fragment(i), scene.eye_in_world_mm);
        return glm::vec4(to_local(fragment(i), wo), fragment(i).normal_variance);
    });

    shading_.light_irradiance.clear();
    shading_.light_radius2.clear();
    if (!lights_.empty()) {
        make(shading_.lights,
             {shape.width, shape.height, static_cast<int>(lights_.size())},
             TexelFormat::rgba32f);
    }
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const Light& light = lights_[k];
        shading_.light_irradiance.push_back(std::numbers::pi_v<float> *
                                            radiance_working(light.light));
        shading_.light_radius2.push_back(
            static_cast<float>(0.25 * light.light.angle_rad * light.light.angle_rad));
        upload(shading_.lights, static_cast<int>(k), [&](std::size_t i) {
            return glm::vec4(to_local(fragment(i), light.at[i].direction), light.at[i].visibility);
        });
    }
    if (sky_.empty()) return;
    make(shading_.sky, shape, TexelFormat::rgba16f);
    upload(shading_.sky, 0, [&](std::size_t i) {
        return glm::vec4(glm::min(sky_[i], glm::vec3(kHalfLargest)), 1.0f);
    });
}

bool FragmentInputs::update_diffuse_light(const FramePlan& plan, StageClock& clock, bool changed) {
    if (!find_pass(plan, kDiffuseLightPass)) {
        shading_.lit = Texture2D();
        return false;
    }
    return clock.run(kDiffuseLightPass, changed || !shading_.lit, [&] {
        make(shading_.lit, {kPackedWidth, layout_.rows}, TexelFormat::rgba16f);
        const auto light_on = [&](std::size_t i) {
            glm::vec3 sum = sky_.empty() ? glm::vec3(0.0f) : sky_[i];
            for (const Light& light : lights_) {
                const float cosine = glm::dot(map_.fragments[i].normal, light.at[i].direction);
                sum += radiance_working(light.light) *
                       (light.at[i].visibility * std::max(cosine, 0.0f));
            }
            return glm::vec4(glm::min(sum, glm::vec3(kHalfLargest)), 1.0f);
        };
        shading_.lit.upload(std::span<const float>(packed(map_, layout_, light_on)));
    });
}

void FragmentInputs::make(Texture2D& texture, TextureShape shape, TexelFormat format) {
    const TextureShape& old = texture.shape();
    if (texture && old.width == shape.width && old.height == shape.height &&
        old.layers == shape.layers) {
        return;
    }
    texture = Texture2D(shape, format);
    ++textures_made_;
}

}  // namespace livery
