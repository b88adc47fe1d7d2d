#include "ledger/drawn_values.h"

#include <algorithm>
#include <span>

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

}  // namespace livery
