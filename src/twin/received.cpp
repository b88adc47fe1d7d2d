#include "twin/received.h"

#include <algorithm>

#include "core/parallel.h"

namespace livery {

namespace {

/// Sum of weight x light over terms [begin, end), then the surface's factors on the sum: the terms
/// of one surface lie together.
template <typename FactorsOfSurface>
glm::vec3 sum_terms(const PathTerm* term,
                    const PathTerm* end,
                    const float* light,
                    const FactorsOfSurface& factors_of) {
    glm::vec3 reading(0.0f);
    while (term != end) {
        const std::uint16_t surface = term->surface;
        float sum[kLightChannels] = {};
        for (; term != end && term->surface == surface; ++term) {
            const float* source = light + static_cast<std::size_t>(term->pixel) * kLightChannels;
            for (int k = 0; k < kLightChannels; ++k) sum[k] += term->weight * source[k];
        }
        const Factors::PerChannel& factors = factors_of(surface);
        for (std::size_t k = 0; k < factors.size(); ++k) reading += sum[k] * glm::vec3(factors[k]);
    }
    return reading;
}

template <typename Body>
ImageF picture(const Receivers& receivers, const Body& reading_of) {
    const std::vector<std::uint32_t>& pixels = receivers.traced->paths.receiver;
    ImageF image(receivers.traced->width, receivers.traced->height, 3);
    parallel_for(pixels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3 reading = reading_of(i);
            float* out = image.values.data() + 3 * static_cast<std::size_t>(pixels[i]);
            for (int c = 0; c < 3; ++c) out[c] = reading[c];
        }
    });
    return image;
}

}  // namespace

std::vector<glm::vec3> bounced_light(const Gathers& gathers,
                                     const Factors& factors,
                                     const ImageF& light) {
    if (gathers.begin.empty()) return {};
    const std::size_t places = gathers.begin.size() - 1, surfaces = factors.bounce.size();
    std::vector<glm::vec3> bounced(places * surfaces);
    parallel_for(places, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const PathTerm* first = gathers.terms.data() + gathers.begin[p];
            const PathTerm* last = gathers.terms.data() + gathers.begin[p + 1];
            for (std::size_t seen = 0; seen < surfaces; ++seen) {
                bounced[p * surfaces + seen] = sum_terms(
                    first, last, light.values.data(), [&](std::uint16_t lit) -> auto& {
                        return factors.bounce[seen][lit];
                    });
            }
        }
    });
    return bounced;
}

glm::vec3 receive(const Receivers& receivers,
                  const std::vector<glm::vec3>& bounced,
                  const ImageF& light,
                  std::size_t i) {
    const LightPaths& paths = receivers.traced->paths;
    glm::vec3 reading = sum_terms(
        paths.terms.data() + paths.term_begin[i],
        paths.terms.data() + paths.term_begin[i + 1],
        light.values.data(),
        [&](std::uint16_t surface) -> auto& { return receivers.factors.direct[surface]; });
    const std::vector<Gathers::Blend>& blends = receivers.traced->blends;
    if (blends.empty()) return reading;
    const Gathers::Blend& blend = blends[i];
    const std::size_t surfaces = receivers.factors.bounce.size();
    for (std::uint32_t c = paths.cover_begin[i]; c < paths.cover_begin[i + 1]; ++c) {
        const CoverTerm& cover = paths.covers[c];
        for (std::size_t k = 0; k < blend.place.size() && blend.weight[k] > 0.0f; ++k) {
            reading +=
                cover.share * blend.weight[k] * bounced[blend.place[k] * surfaces + cover.surface];
        }
    }
    return reading;
}

ImageF receive_all(const Receivers& receivers, const Gathers& gathers, const ImageF& light) {
    const auto bounced = bounced_light(gathers, receivers.factors, light);
    return picture(receivers, [&](std::size_t i) { return receive(receivers, bounced, light, i); });
}

glm::vec3 receive_ambient(const Receivers& receivers, std::size_t i) {
    const LightPaths& paths = receivers.traced->paths;
    glm::dvec3 reading(0.0);
    for (std::uint32_t c = paths.cover_begin[i]; c < paths.cover_begin[i + 1]; ++c) {
        reading += static_cast<double>(paths.covers[c].share) *
                   receivers.factors.ambient[paths.covers[c].surface];
    }
    return glm::vec3(reading);
}

ImageF receive_ambient(const Receivers& receivers) {
    return picture(receivers, [&](std::size_t i) { return receive_ambient(receivers, i); });
}

}  // namespace livery
