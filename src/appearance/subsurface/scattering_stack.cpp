#include "appearance/subsurface/scattering_stack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

namespace {

constexpr std::size_t kMostLayers = 100;

bool same_material(const ScatteringMedium& a, const ScatteringMedium& b) {
    return a.sigma_a_per_mm == b.sigma_a_per_mm && a.sigma_s_per_mm == b.sigma_s_per_mm &&
           a.g == b.g;
}

}  // namespace

bool ScatteringStack::scatters() const {
    return std::any_of(layers.begin(), layers.end(), [](const ScatteringMedium& layer) {
        return layer.sigma_s_prime() > 0.0;
    });
}

double ScatteringStack::depth() const {
    double sum = 0.0;
    for (const ScatteringMedium& layer : layers) {
        if (!(layer.sigma_t() > 0.0)) continue;
        sum += layer.thickness_mm ? layer.sigma_t() * *layer.thickness_mm
                                  : std::numeric_limits<double>::infinity();
    }
    return sum;
}

double ScatteringStack::mean_free_path_mm() const {
    double shortest = std::numeric_limits<double>::infinity();
    for (const ScatteringMedium& layer : layers) {
        if (layer.sigma_t_prime() > 0.0) shortest = std::min(shortest, layer.mean_free_path_mm());
    }
    return shortest;
}

void check_stack(const ScatteringStack& stack) {
    check_argument(
        !stack.layers.empty() && stack.layers.size() <= kMostLayers,
        fmt::format("layers: found {}, expected 1 to {}", stack.layers.size(), kMostLayers));
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const ScatteringMedium& layer = stack.layers[k];
        try {
            check_medium(layer);
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("layer {}: {}", k + 1, error.what()));
        }
        check_argument(layer.thickness_mm || k + 1 == stack.layers.size(),
                       fmt::format("layer {}: found no thickness, expected one of every layer but "
                                   "the last",
                                   k + 1));
        check_argument(layer.eta == stack.eta(),
                       fmt::format("layer {}: found an index of {} under one of {}, expected the "
                                   "same in all layers",
                                   k + 1,
                                   layer.eta,
                                   stack.eta()));
    }
}

ScatteringStack merged(const ScatteringStack& stack) {
    ScatteringStack whole;
    for (const ScatteringMedium& layer : stack.layers) {
        if (whole.layers.empty() || !same_material(whole.layers.back(), layer)) {
            whole.layers.push_back(layer);
        } else if (layer.thickness_mm) {
            *whole.layers.back().thickness_mm += *layer.thickness_mm;
        } else {
            whole.layers.back().thickness_mm.reset();
        }
    }
    return whole;
}

UnscatteredLight unscattered_light(const ScatteringStack& stack) {
    // One layer of the same depth shows it: light that goes straight on knows no other difference.
    ScatteringMedium whole{0.0, 0.0, 0.0, stack.eta(), {}};
    if (stack.is_slab()) {
        whole.thickness_mm = 1.0;
        whole.sigma_a_per_mm = stack.depth();
    }
    return unscattered_light(whole);
}

double least_radius_mm(const ScatteringStack& stack) {
    const double path = stack.mean_free_path_mm();
    return std::isfinite(path) ? 1e-3 * path : 0.0;
}

}  // namespace livery
