// What fragment inputs have solved, handed to the device that shades.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/mutation.h"
#include "radiance/fragment_inputs.h"
#include "radiance/packed_fragments.h"

namespace livery {
namespace {

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

void FragmentInputs::upload(const Scene& scene, StageClock& clock) {
    if (mirror_.has_uploads()) {
        clock.add(PassKind::mirrored_environment, [&] {
            const MirrorInputs::Uploaded done = mirror_.upload(device_, light_precision_, shading_);
            if (done.other_light) ++glossy_version_;
            if (done.more_room) ++layers_made_;
        });
    }
    const std::pair eye{map_version_, scene.eye_in_world_mm};
    const Versions lights{lights_version_};
    clock.run(PassKind::directions, eye_on_device_ != eye || lights_on_device_ != lights, [&] {
        if (eye_on_device_ != eye) upload_eye(scene);
        eye_on_device_ = eye;
        if (lights_on_device_ != lights) upload_lights();
        lights_on_device_ = lights;
        ++glossy_version_;
    });
    // Where nothing spreads in a medium, no lamp is in it
    const Versions sky{sky_.version,
                       exchanged_.version,
                       subsurface_.version(),
                       subsurface_.empty() ? 0 : lights_version_};
    if (sky_on_device_ != sky) {
        upload_sky();
        sky_on_device_ = sky;
        ++glossy_version_;
    }
    const Versions diffuse{lights_version_, sky_.version, exchanged_.version};
    clock.run(PassKind::diffuse_light, diffuse_on_device_ != diffuse, [&] {
        upload_diffuse_light();
        diffuse_on_device_ = diffuse;
        ++diffuse_version_;
    });
    const Versions places{map_version_};
    clock.run(PassKind::glint_places, places_on_device_ != places, [&] {
        upload_places();
        places_on_device_ = places;
    });
    shading_.product_scale = scene.product->product_scale;
}

int FragmentInputs::version_for(const Material& material) const {
    return model_info(material.model).same_from_all_sides ? diffuse_version_ : glossy_version_;
}

template <typename Value>
void FragmentInputs::upload_packed(InputLayers& input, int layer, const Value& value) {
    pack(layout_, value, packed_);
    input.upload(packed_, layer);
}

void FragmentInputs::upload_eye(const Scene& scene) {
    const auto fragment = [&](std::size_t i) -> const Fragment& { return map_->fragments[i]; };
    make(shading_.eye, 0, InputLayers::Precision::full);
    upload_packed(shading_.eye, 0, [&](std::size_t i) {
        const glm::vec3 wo = toward_eye(fragment(i), scene.eye_in_world_mm);
        return glm::vec4(to_local(fragment(i), wo), fragment(i).normal_variance);
    });
}

void FragmentInputs::upload_lights() {
    const auto fragment = [&](std::size_t i) -> const Fragment& { return map_->fragments[i]; };
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
        upload_packed(shading_.lights, static_cast<int>(k), [&](std::size_t i) {
            return glm::vec4(to_local(fragment(i), light.at[i].direction), light.at[i].visibility);
        });
    }
}

void FragmentInputs::upload_sky() {
    if (!sky_.from && !exchanged_.from && subsurface_.empty()) {
        shading_.sky = InputLayers();
        return;
    }
    make(shading_.sky, 0, light_precision_);
    const auto light_on = [&](std::size_t i) {
        glm::vec3 sum = surrounding_light(i);
        if (!subsurface_.empty()) {
            // Of a translucent part: what leaves it
            const std::size_t part = map_->fragments[i].part;
            if (const SubsurfaceInputs::Part* leaving = subsurface_.part(part)) {
                sum = leaving->spread
                          ? leaving->at_fragments[i]
                          : leaving->total * entering_at(i,
                                                         {leaving->medium.eta, glm::vec3(0.0f), {}},
                                                         entering_share(leaving->medium.eta),
                                                         0.0f);
            }
        }
        return glm::vec4(glm::min(sum, glm::vec3(kLargestHalf)), 1.0f);
    };
    upload_packed(shading_.sky, 0, light_on);
}

glm::vec3 FragmentInputs::surrounding_light(std::size_t fragment) const {
    const std::vector<glm::vec3>& between = exchanged_.value.on_diffuser;
    return (sky_.from ? sky_.value[fragment] : glm::vec3(0.0f)) +
           (between.empty() ? glm::vec3(0.0f) : between[fragment]);
}

glm::vec3 FragmentInputs::entering_at(std::size_t fragment,
                                      const EnteredMedium& medium,
                                      float share,
                                      float curvature_per_mm) const {
    glm::vec3 sum = share * surrounding_light(fragment);
    for (const Light& light : lights_) {
        const float cosine =
            glm::dot(map_->fragments[fragment].normal, light.at[fragment].direction);
        if (cosine <= 0.0f) continue;
        const glm::vec3 enters = glm::vec3(light.light.radiance_rec709) *
                                 entering_of_lamp(medium, cosine, curvature_per_mm);
        sum +=
            light.at[fragment].visibility * glm::vec3(working_from_rec709() * glm::dvec3(enters));
    }
    return sum;
}

void FragmentInputs::upload_diffuse_light() {
    make(shading_.lit, 0, light_precision_);
    const auto light_on = [&](std::size_t i) {
        glm::vec3 sum = surrounding_light(i);
        for (const Light& light : lights_) {
            const float cosine = glm::dot(map_->fragments[i].normal, light.at[i].direction);
            sum +=
                radiance_working(light.light) * (light.at[i].visibility * std::max(cosine, 0.0f));
        }
        return glm::vec4(glm::min(sum, glm::vec3(kLargestHalf)), 1.0f);
    };
    upload_packed(shading_.lit, 0, light_on);
}

void FragmentInputs::upload_places() {
    make(shading_.places, 0, InputLayers::Precision::full);
    const auto place_of = [&](std::size_t i) {
        const Fragment& f = map_->fragments[i];
        return glm::vec4(f.position_mm, pixel_side_mm(pixels_, f.position_mm, f.normal));
    };
    upload_packed(shading_.places, 0, place_of);
}

void FragmentInputs::make(InputLayers& input,
                          std::size_t layers,
                          InputLayers::Precision precision) {
    if (input.make(device_, layout_.rows, static_cast<int>(layers), precision)) ++layers_made_;
}

}  // namespace livery
