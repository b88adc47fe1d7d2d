#include "radiance/light/mirror_look_up.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/sky_visibility.h"

namespace livery {

namespace {

/// mirror_correction() by the root of the cosine, then by lobe.
class Corrections {
  public:
    Corrections() {
        parallel_for(kCosines, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const double root = static_cast<double>(i) / (kCosines - 1);
                for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
                    of_[i][k] = static_cast<float>(
                        mirror_correction(root * root, static_cast<double>(kMirrorAlphas[k])));
                }
            }
        });
    }
    float of(std::size_t lobe, float root) const {
        const float at = root * static_cast<float>(kCosines - 1);
        const std::size_t below = std::min(static_cast<std::size_t>(at), kCosines - 2);
        return std::lerp(of_[below][lobe], of_[below + 1][lobe], at - static_cast<float>(below));
    }

  private:
    static constexpr std::size_t kCosines = 33;
    std::array<std::array<float, kMirrorAlphas.size()>, kCosines> of_;
};

/// How far from the normal to the mirrored eye a lobe's middle lies: masking takes more away from
/// the half that lies flat. Lagarde and de Rousiers, Moving Frostbite to PBR (2014).
constexpr float kLeans = 0.95f;
const std::array<float, kMirrorAlphas.size()> kTowardMirrored = [] {
    std::array<float, kMirrorAlphas.size()> share{};
    for (std::size_t k = 0; k < share.size(); ++k) {
        const float alpha = kMirrorAlphas[k];
        share[k] = (1.0f - alpha) * (std::sqrt(1.0f - alpha) + alpha);
    }
    return share;
}();

const Corrections& corrections() {
    static const Corrections table;
    return table;
}

}  // namespace

MirrorLookUp::MirrorLookUp(const FilteredEnvironment& filtered) {
    const std::vector<ImageF>& all = filtered.mirrored;
    const auto wide = std::find_if(all.begin(), all.end(), [&](const ImageF& picture) {
        return picture.width != all.front().width;
    });
    sharp_count_ = static_cast<std::size_t>(wide - all.begin());
    sharp_ = SphereStack(std::span(all).first(sharp_count_));
    wide_ = SphereStack(std::span(all).subspan(sharp_count_));
    largest_ = *std::max_element(all.front().values.begin(), all.front().values.end());
}

float MirrorLookUp::layer_of(float alpha2) {
    constexpr float kFirst2 = kLayerAlphas[1] * kLayerAlphas[1];
    constexpr auto kLast = static_cast<float>(kLayerAlphas.size() - 1);
    // The map itself has no width: in between, as the width is
    if (alpha2 < kFirst2) return std::sqrt(alpha2 / kFirst2);
    // Variances double from layer to layer: the exponent is the layer, the mantissa the share
    const auto bits = std::bit_cast<std::uint32_t>(alpha2 / kFirst2);
    const float share = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u) - 1.0f;
    return std::min(static_cast<float>((bits >> 23u) - 126u) + share, kLast);
}

glm::vec3 MirrorLookUp::between(float layer,
                                const SphereStack::Footprint& sharp,
                                const SphereStack::Footprint& wide) const {
    const auto picture = [&](std::size_t k) {
        return k < sharp_count_ ? sharp.in(k) : wide.in(k - sharp_count_);
    };
    const std::size_t below = std::min(static_cast<std::size_t>(layer), kLayerAlphas.size() - 2);
    const float share = layer - static_cast<float>(below);
    const Texel part{share, share, share, share};
    const Texel low = picture(below);
    return rgb_of(low + part * (picture(below + 1) - low));
}

MirrorLookUp::In::In(const MirrorLookUp& layers, const Environment& environment, glm::dvec3 eye_mm)
    : layers_(layers),
      places_(environment),
      scale_(static_cast<float>(environment.scale)),
      eye_mm_(eye_mm) {}

MirroredLight MirrorLookUp::In::at_fragment(const Fragment& f, const MirrorLobes& lobes) const {
    const glm::vec3 wo = toward_eye(f, eye_mm_);
    const float cosine = std::clamp(glm::dot(wo, f.normal), 0.0f, 1.0f);
    const glm::vec3 mirrored = 2.0f * cosine * f.normal - wo;
    const glm::vec2 uv = places_.of(mirrored);
    const SphereStack::Footprint sharp = layers_.sharp_.at(uv), wide = layers_.wide_.at(uv);
    const Corrections& correction = corrections();
    const float root = std::sqrt(cosine);
    MirroredLight result;
    result.fill(glm::vec3(1.0f));
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        if (!lobes.layers()[k]) continue;
        const float alpha2 = kMirrorAlphas[k] * kMirrorAlphas[k] + f.normal_variance;
        const float share = kTowardMirrored[k];
        const glm::vec3 middle = f.normal + share * (mirrored - f.normal);
        const SphereStack::Footprint leaning =
            share < kLeans ? layers_.wide_.at(places_.of(glm::normalize(middle))) : wide;
        result[k] =
            scale_ * correction.of(k, root) * layers_.between(layer_of(alpha2), sharp, leaning);
    }
    return result;
}

}  // namespace livery
