#include "radiance/lanes/processor_shading.h"

#include <cstring>
#include <functional>

#include "appearance/model_table.h"
#include "core/parallel.h"
#include "radiance/glints.h"
#include "radiance/lanes/any_model_shading.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {
namespace {

/// Small enough that two threads end together, large enough that starting one is nothing.
constexpr std::size_t kBlocksAtOnce = 64, kPixelsAtOnce = 2048;

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
