#include "radiance/light/mirror_lobes.h"

#include <algorithm>
#include <cmath>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"
#include "scene/artwork_coats.h"

namespace livery {
namespace {

/// Nearer to a tabulated lobe than a thousandth of its roughness, a paint has that one's.
constexpr double kSameLobe = 1e-3;

/// Those that one in between is mixed of.
void add_mix(double alpha, MirrorMixing mixing, MirrorLayers& layers) {
    const MirrorMix mix = mirror_mix(alpha, mixing);
    for (std::size_t k = 0; k < mix.share.size(); ++k) {
        if (mix.share[k] != 0.0f) layers.set(static_cast<std::size_t>(mix.first) + k);
    }
}

/// Those that grazing_fresnel() of layers.glsl interpolates between.
void add_half_angle(float alpha, MirrorLayers& layers) {
    std::size_t last = 0;
    const std::size_t count = 3 * kHalfAngleLobes.size();
    const auto alpha_of = [](std::size_t k) {
        return kMirrorAlphas[kHalfAngleLobes[k / 3][k % 3]];
    };
    while (last + 1 < count && alpha_of(last) < alpha) ++last;
    layers.set(kMirrorAlphas.size() + last / 3);
    if (last > 0) layers.set(kMirrorAlphas.size() + (last - 1) / 3);
}

}  // namespace

MirrorMix mirror_mix(double alpha, MirrorMixing mixing) {
    // Cubic in the logarithm, which treats a lobe's core (1 / alpha^2) and its tail (alpha^2)
    // alike: linear, both would be up to 6% too bright. Linear before the second and after the last
    // but one, where a cubic would extrapolate.
    const auto of = [](std::size_t k) { return std::log(static_cast<double>(kMirrorAlphas[k])); };
    const std::size_t last = kMirrorAlphas.size() - 1;
    const double x = std::clamp(std::log(alpha), of(0), of(last));
    std::size_t below = 0;
    while (below + 2 <= last && of(below + 1) <= x) ++below;
    const std::size_t first = std::clamp<std::size_t>(below, 1, last - 2) - 1;
    MirrorMix mix;
    mix.first = static_cast<int>(first);
    for (const std::size_t k : {below, below + 1}) {
        if (!(std::abs(x - of(k)) <= kSameLobe)) continue;  // nor what is no number
        mix.share[k - first] = 1.0f;
        return mix;
    }
    if (mixing == MirrorMixing::linear || below == 0 || below + 1 == last) {
        const auto share = static_cast<float>((x - of(below)) / (of(below + 1) - of(below)));
        // Who reads the shares takes the first for what the others leave: it must be none
        mix.share[below - first] = 1.0f - share;
        mix.share[below + 1 - first] = 1.0f - mix.share[below - first];
        return mix;
    }
    for (std::size_t k = first; k < first + mix.share.size(); ++k) {
        double share = 1.0;
        for (std::size_t j = first; j < first + mix.share.size(); ++j) {
            if (j != k) share *= (x - of(j)) / (of(k) - of(j));
        }
        mix.share[k - first] = static_cast<float>(share);
    }
    return mix;
}

bool reads_layers(const PreparedPaint& paint, std::size_t lobe) {
    // One that reflects nothing may read any; all of them, their own
    return paint.reflects[lobe] ||
           std::find(paint.reflects.begin(), paint.reflects.end(), true) == paint.reflects.end();
}

MirrorLayers mirror_layers_of(const Material& paint, MirrorMixing mixing) {
    const ModelInfo& model = model_info(paint.model);
    MirrorLayers layers;
    if (!model.mirrors()) return layers;
    if (!model.prepared.type) {
        // A measurement that nobody has read yet is black
        const float measured = paint.measured ? paint.measured->lobe_alpha : 1.0f;
        const bool is_formula = paint.model != ReflectanceModel::measured;
        const float alpha = is_formula ? lobe_alpha(model, parameters_of(paint)) : measured;
        add_mix(static_cast<double>(alpha), mixing, layers);
        return layers;
    }
    const PreparedPaint prepared = model.prepared.of(parameters_of(paint));
    // What lies under a coat is lit through it; what flakes reflect is the same from all sides
    const bool coated = prepared.lobe_slopes.size() > 1;
    const bool flakes = prepared.lobe_slopes.size() > 2;
    constexpr std::size_t kCoat = 1;
    bool any_under_coat = false;
    for (std::size_t lobe = 0; lobe < prepared.lobe_slopes.size(); ++lobe) {
        if (!reads_layers(prepared, lobe)) continue;
        any_under_coat = any_under_coat || lobe != kCoat;
        const glm::vec2 slopes = prepared.lobe_slopes[lobe];
        const float alpha = std::sqrt(slopes.x * slopes.y);
        add_mix(static_cast<double>(alpha), mixing, layers);
        if (!flakes || lobe == kCoat) add_half_angle(alpha, layers);
    }
    if (coated && any_under_coat) layers.set(kMirrorLayers - 1);
    return layers;
}

std::vector<MirrorLayers> mirror_layers_of(const Scene& scene, MirrorMixing mixing) {
    std::vector<MirrorLayers> of_part;
    for (const Material& paint : scene.part_materials) {
        of_part.push_back(mirror_layers_of(paint, mixing));
    }
    for (const PartArtwork& artwork : scene.artwork) {
        for (const ArtworkCoat& coat : coats_of(artwork)) {
            of_part[artwork.part] |= mirror_layers_of(coat.material, mixing);
        }
    }
    return of_part;
}

bool SolvedMirror::serves(const Scene& scene) const {
    if (mixing == MirrorMixing::linear) return true;
    const std::vector<MirrorLayers> worn = mirror_layers_of(scene, mixing);
    return std::equal(worn.begin(),
                      worn.end(),
                      of_part.begin(),
                      of_part.end(),
                      [](const auto& asked, const auto& known) { return (asked & ~known).none(); });
}

}  // namespace livery
