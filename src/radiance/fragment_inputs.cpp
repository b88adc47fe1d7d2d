#include "radiance/fragment_inputs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/mutation.h"
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

/// Whether what was filtered of one serves the other: filters know neither rotation nor scale.
bool same_map(const std::shared_ptr<const Environment>& a,
              const std::shared_ptr<const Environment>& b) {
    if (a == b) return true;
    return a && b && a->radiance_working.width == b->radiance_working.width &&
           a->radiance_working.values == b->radiance_working.values;
}

/// Whether a draft mirrors at a fragment the mean of what it does on both sides in the same row:
/// all three whole pixels of one surface that turns by less than a degree, so that no reflection
/// moves by more than another one.
bool lies_between(const SurfaceMap& map, std::size_t i) {
    constexpr float kOneDegree = 0.99985f;
    const Fragment &left = map.fragments[i - 1], &own = map.fragments[i],
                   &right = map.fragments[i + 1];
    const auto width = static_cast<std::uint32_t>(map.width);
    const std::uint32_t x = own.pixel % width;
    return x % 2 == 1 && x + 1 < width && left.pixel + 1 == own.pixel &&
           own.pixel + 1 == right.pixel && left.part == own.part && right.part == own.part &&
           left.coverage == 1.0f && own.coverage == 1.0f && right.coverage == 1.0f &&
           glm::dot(left.normal, right.normal) > kOneDegree &&
           glm::dot(left.normal, own.normal) > kOneDegree;
}

glm::vec3 radiance_working(const DirectionalLight& light) {
    return glm::vec3(working_from_rec709() * light.radiance_rec709);
}

}  // namespace

QualityRays rays_of(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return {1, {8, 0, true}, 0};
        case Quality::normal:
            return {16, {16, 128, false}, 16};
        case Quality::high:
            return {64, {64, 256, false}, 24};
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
                               const View& view,
                               const SurfaceMap& map,
                               const PackedLayout& layout,
                               ShadingDevice device,
                               bool keep_better)
    : mesh_(mesh),
      tracer_(tracer),
      pixels_(pixel_size_of(view)),
      map_(&map),
      layout_(layout),
      device_(device),
      keep_better_(keep_better) {}

void FragmentInputs::use(const SurfaceMap& map) {
    map_ = &map;
    lights_.clear();
    sky_visibility_.reset();
    mirror_visibility_.reset();
    visibility_eye_.reset();
    sky_made_ = {};
    mirror_made_ = {};
    directions_stale_ = diffuse_light_stale_ = places_stale_ = true;
}

void FragmentInputs::solve(const Scene& scene,
                           const FramePlan& plan,
                           StageClock& clock,
                           const Progress& progress) {
    solve_lights(scene, plan, clock, progress);
    solve_sky(scene, plan, clock, progress);
    solve_mirror(scene, plan, clock, progress);
}

void FragmentInputs::solve_lights(const Scene& scene,
                                  const FramePlan& plan,
                                  StageClock& clock,
                                  const Progress& progress) {
    const int rays = rays_of(plan.quality).light;
    std::size_t planned = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const PassId pass = visibility_pass(i);
        if (!find_pass(plan, pass)) continue;
        const DirectionalLight& light = scene.lights[i];
        const auto found = std::find_if(lights_.begin(), lights_.end(), [&](const Light& l) {
            return l.index == i && enough(l.rays, rays) && same_disc(l.light, light);
        });
        Light next{i, light, rays, {}};
        const bool stale = found == lights_.end();
        bool changed = stale || found != lights_.begin() + static_cast<std::ptrdiff_t>(planned);
        if (!stale) {
            changed = changed || found->light.radiance_rec709 != light.radiance_rec709;
            next.rays = found->rays;
            next.at = std::move(found->at);
            lights_.erase(found);
        }
        clock.run(pass, stale, [&] {
            next.at = light_at_fragments(mesh_, tracer_, *map_, light, rays, progress);
        });
        lights_.insert(lights_.begin() + static_cast<std::ptrdiff_t>(planned++), std::move(next));
        if (changed) directions_stale_ = diffuse_light_stale_ = true;
    }
    if (planned == lights_.size()) return;
    lights_.resize(planned);
    directions_stale_ = diffuse_light_stale_ = true;
}

void FragmentInputs::solve_sky(const Scene& scene,
                               const FramePlan& plan,
                               StageClock& clock,
                               const Progress& progress) {
    if (!find_pass(plan, PassKind::environment_irradiance)) {
        if (sky_made_.of) directions_stale_ = diffuse_light_stale_ = true;
        sky_made_ = {};
        diffused_ = nullptr;
        filtered_.diffuse = filtered_.blurred = filtered_.hardly_blurred = {};
        sky_.clear();
        return;
    }
    const bool occluded = find_pass(plan, PassKind::ambient_occlusion) != nullptr;
    const SkyRays sky_rays = rays_of(plan.quality).sky;
    const int rays = occluded ? sky_rays.first : 0;
    const bool stands = sky_made_.of == scene.environment && enough(sky_made_.rays, rays);
    const bool visible =
        !occluded || stands || (sky_visibility_ && enough(sky_visibility_->rays.first, rays));
    clock.run(PassKind::ambient_occlusion, !visible, [&] {
        sky_visibility_ = solve_sky_visibility(mesh_, tracer_, *map_, sky_rays, progress);
    });
    clock.run(PassKind::environment_irradiance, !stands, [&] {
        if (!same_map(diffused_, scene.environment)) {
            FilteredEnvironment filtered =
                filter_environment(*scene.environment, {false, true, true, false}, progress);
            filtered_.diffuse = std::move(filtered.diffuse);
            filtered_.blurred = std::move(filtered.blurred);
            filtered_.hardly_blurred = std::move(filtered.hardly_blurred);
        }
        diffused_ = scene.environment;
        sky_ = sky_at_fragments(
            mesh_, *map_, *scene.environment, filtered_, occluded ? &*sky_visibility_ : nullptr);
        sky_made_ = {scene.environment, occluded ? sky_visibility_->rays.first : 0, {}};
        directions_stale_ = diffuse_light_stale_ = true;
    });
}

void FragmentInputs::solve_mirror(const Scene& scene,
                                  const FramePlan& plan,
                                  StageClock& clock,
                                  const Progress& progress) {
    // A scene whose paints do not mirror keeps what the next one may; one without environment not.
    if (!find_pass(plan, PassKind::mirrored_environment)) {
        if (find_pass(plan, PassKind::environment_irradiance)) return;
        if (mirror_made_.of) changed_.glossy = true;
        mirror_made_ = {};
        layered_ = nullptr;
        filtered_.gaussians.clear();
        mirror_visibility_.reset();
        mirror_texels_ = {};
        return;
    }
    clock.run(PassKind::environment_filter, !same_map(layered_, scene.environment), [&] {
        filtered_.gaussians =
            filter_environment(*scene.environment, {false, false, false, true}, progress).gaussians;
    });
    layered_ = scene.environment;
    const glm::dvec3 eye = scene.eye_in_world_mm;
    const bool occluded = find_pass(plan, PassKind::reflection_occlusion) != nullptr;
    const int rays = occluded ? rays_of(plan.quality).mirror : 0;
    const bool stands = mirror_made_.of == scene.environment && mirror_made_.eye_mm == eye &&
                        enough(mirror_made_.rays, rays);
    const bool visible =
        !occluded || stands ||
        (mirror_visibility_ && enough(mirror_visibility_->quadrature.nodes(), rays) &&
         visibility_eye_ == eye);
    clock.run(PassKind::reflection_occlusion, !visible, [&] {
        mirror_visibility_ = solve_mirror_visibility(mesh_, tracer_, *map_, eye, rays, progress);
        visibility_eye_ = eye;
    });
    clock.run(PassKind::mirrored_environment, !stands, [&] {
        fill_mirror(scene, occluded, progress);
        mirror_made_ = {
            scene.environment, occluded ? mirror_visibility_->quadrature.nodes() : 0, eye};
    });
}

void FragmentInputs::fill_mirror(const Scene& scene, bool occluded, const Progress& progress) {
    const MirrorVisibility* visibility = occluded ? &*mirror_visibility_ : nullptr;
    const SkyVisibility* joints = !occluded && sky_visibility_ ? &*sky_visibility_ : nullptr;
    // Half floats hold the radiance in units in which the brightest texel fits.
    const ImageF& sharpest = filtered_.gaussians.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end()) *
                          static_cast<float>(scene.environment->scale);
    const float unit = std::max(1.0f, largest / kHalfLargest);
    const MirroredEnvironment environment(
        *scene.environment, filtered_, mesh_, *map_, scene.eye_in_world_mm, visibility);
    const std::size_t layer_size = static_cast<std::size_t>(layout_.rows) * kPackedWidth * 4;
    std::vector<std::vector<float>> texels(kMirrorLayers);
    parallel_for(texels.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) texels[k].assign(layer_size, 0.0f);
    });
    parallel_for(map_->fragments.size(), 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        MirroredEnvironment::Scratch scratch;
        const auto is_mean = [&](std::size_t i) {
            return !occluded && i > begin && i + 1 < end && lies_between(*map_, i);
        };
        for (std::size_t i = begin; i < end; ++i) {
            if (is_mean(i)) continue;
            const MirroredLight light = environment.at_fragment(i, scratch);
            // Who does not ask which lobes are hidden dims those of a joint like its diffuse light
            const bool joint = joints && map_->fragments[i].coverage < 1.0f;
            const float scale = (joint ? joints->openness(i) : 1.0f) / unit;
            const std::size_t at = 4 * layout_.address(i, map_->fragments[i].part);
            const auto store = [&](std::size_t layer, const glm::vec3& value) {
                for (std::size_t c = 0; c < 3; ++c) {
                    texels[layer][at + c] = value[static_cast<int>(c)];
                }
            };
            for (std::size_t k = 0; k < light.lobe.size(); ++k) store(k, light.lobe[k] * scale);
            for (std::size_t k = 0; k < light.grazing.size(); ++k) {
                store(light.lobe.size() + k, light.grazing[k]);
            }
        }
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_mean(i)) continue;
            const auto address = [&](std::size_t j) {
                return 4 * layout_.address(j, map_->fragments[j].part);
            };
            const std::size_t left = address(i - 1), at = address(i), right = address(i + 1);
            for (std::vector<float>& layer : texels) {
                for (std::size_t c = 0; c < 3; ++c) {
                    layer[at + c] = 0.5f * (layer[left + c] + layer[right + c]);
                }
            }
        }
    });
    mirror_texels_ = std::move(texels);
    mirror_unit_ = unit;
}

FragmentInputs::Changed FragmentInputs::upload(const Scene& scene, StageClock& clock) {
    if (!mirror_made_.of) shading_.mirror = InputLayers();
    if (!mirror_texels_.empty()) {
        clock.add(PassKind::mirrored_environment, [&] {
            upload_mirror();
            changed_.glossy = true;
        });
    }
    const bool other_eye = eye_ != scene.eye_in_world_mm;
    clock.run(PassKind::directions, directions_stale_ || other_eye, [&] {
        upload_directions(scene);
        eye_ = scene.eye_in_world_mm;
        directions_stale_ = false;
        changed_.glossy = true;
    });
    clock.run(PassKind::diffuse_light, diffuse_light_stale_, [&] {
        upload_diffuse_light();
        diffuse_light_stale_ = false;
        changed_.diffuse = true;
    });
    clock.run(PassKind::glint_places, places_stale_, [&] {
        upload_places();
        places_stale_ = false;
    });
    shading_.product_scale = scene.product->product_scale;
    return std::exchange(changed_, {});
}

void FragmentInputs::upload_mirror() {
    make(shading_.mirror, kMirrorLayers, InputLayers::Precision::half);
    for (std::size_t k = 0; k < mirror_texels_.size(); ++k) {
        shading_.mirror.upload(mirror_texels_[k], static_cast<int>(k));
    }
    shading_.mirror_unit = mirror_unit_;
    mirror_texels_ = {};
}

void FragmentInputs::upload_directions(const Scene& scene) {
    const auto fragment = [&](std::size_t i) -> const Fragment& { return map_->fragments[i]; };
    const auto upload = [&](InputLayers& input, int layer, const auto& value) {
        input.upload(packed(*map_, layout_, value), layer);
    };
    make(shading_.eye, 0, InputLayers::Precision::full);
    upload(shading_.eye, 0, [&](std::size_t i) {
        const glm::vec3 wo = toward_eye(fragment(i), scene.eye_in_world_mm);
        return glm::vec4(to_local(fragment(i), wo), fragment(i).normal_variance);
    });

    shading_.light_irradiance.clear();
    shading_.light_radius2.clear();
    if (!lights_.empty()) {
        make(shading_.lights, lights_.size(), InputLayers::Precision::full);
    }
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const Light& light = lights_[k];
        shading_.light_irradiance.push_back(
            LIVERY_MUTATED(lamp_irradiance, std::numbers::pi_v<float>) *
            radiance_working(light.light));
        shading_.light_radius2.push_back(
            static_cast<float>(0.25 * light.light.angle_rad * light.light.angle_rad));
        upload(shading_.lights, static_cast<int>(k), [&](std::size_t i) {
            return glm::vec4(to_local(fragment(i), light.at[i].direction), light.at[i].visibility);
        });
    }
    if (sky_.empty()) {
        shading_.sky = InputLayers();
        return;
    }
    make(shading_.sky, 0, InputLayers::Precision::half);
    upload(shading_.sky, 0, [&](std::size_t i) {
        return glm::vec4(glm::min(sky_[i], glm::vec3(kHalfLargest)), 1.0f);
    });
}

void FragmentInputs::upload_diffuse_light() {
    make(shading_.lit, 0, InputLayers::Precision::half);
    const auto light_on = [&](std::size_t i) {
        glm::vec3 sum = sky_.empty() ? glm::vec3(0.0f) : sky_[i];
        for (const Light& light : lights_) {
            const float cosine = glm::dot(map_->fragments[i].normal, light.at[i].direction);
            sum +=
                radiance_working(light.light) * (light.at[i].visibility * std::max(cosine, 0.0f));
        }
        return glm::vec4(glm::min(sum, glm::vec3(kHalfLargest)), 1.0f);
    };
    shading_.lit.upload(packed(*map_, layout_, light_on), 0);
}

void FragmentInputs::upload_places() {
    make(shading_.places, 0, InputLayers::Precision::full);
    const auto place_of = [&](std::size_t i) {
        const Fragment& f = map_->fragments[i];
        return glm::vec4(f.position_mm, pixel_side_mm(pixels_, f.position_mm, f.normal));
    };
    shading_.places.upload(packed(*map_, layout_, place_of), 0);
}

void FragmentInputs::make(InputLayers& input,
                          std::size_t layers,
                          InputLayers::Precision precision) {
    if (input.make(device_, layout_.rows, static_cast<int>(layers), precision)) ++layers_made_;
}

}  // namespace livery
