#include "appearance/subsurface/layered_diffusion.h"

#include <cmath>
#include <utility>

namespace livery {

namespace {

/// sinh(a h)/a and cosh(a h), both times e^{-a h}.
struct Hyperbolic {
    double sinh_over, cosh, decay;
};
Hyperbolic hyperbolic(double a, double h) {
    const double decay = std::exp(-a * h);
    const double x = a * h;
    return {x > 1e-9 ? -std::expm1(-2.0 * x) / (2.0 * a) : h, 0.5 * (1.0 + decay * decay), decay};
}

}  // namespace

LayeredDiffusion::LayeredDiffusion(std::vector<DiffusionLayer> layers,
                                   const Diffusion& top,
                                   const Diffusion& bottom)
    : layers_(std::move(layers)), top_(top), bottom_(bottom) {}

LayeredDiffusion::Spectrum::Side LayeredDiffusion::Spectrum::through(const Layer& layer,
                                                                     const Side& beyond,
                                                                     double distance) {
    const double d = layer.coefficient_mm, a = layer.decay_per_mm;
    const Hyperbolic h = hyperbolic(a, distance);
    const double grown = h.cosh + beyond.admittance / d * h.sinh_over;
    return {(beyond.admittance * h.cosh + d * a * a * h.sinh_over) / grown,
            beyond.exitance * h.decay / grown};
}

LayeredDiffusion::Spectrum LayeredDiffusion::at(double per_mm) const {
    Spectrum spectrum;
    for (const DiffusionLayer& layer : layers_) {
        spectrum.layers_.push_back({layer.diffusion.coefficient_mm,
                                    std::hypot(layer.diffusion.sigma_tr_per_mm, per_mm),
                                    layer.thickness_mm,
                                    {},
                                    {}});
    }
    // The extension to where the fluence vanishes.
    const auto boundary = [](const Spectrum::Layer& layer, const Diffusion& how) {
        const Hyperbolic h = hyperbolic(layer.decay_per_mm, how.extrapolation_mm);
        const double admittance = layer.coefficient_mm * h.cosh / h.sinh_over;
        return Spectrum::Side{admittance, how.fluence_share + how.flux_share * admittance};
    };
    auto& layers = spectrum.layers_;
    layers.front().above = boundary(layers.front(), top_);
    for (std::size_t k = 1; k < layers.size(); ++k) {
        layers[k].above =
            Spectrum::through(layers[k - 1], layers[k - 1].above, *layers[k - 1].thickness_mm);
    }
    Spectrum::Layer& last = layers.back();
    last.below = last.thickness_mm ? boundary(last, bottom_)
                                   : Spectrum::Side{last.coefficient_mm * last.decay_per_mm, 0.0};
    for (std::size_t k = layers.size() - 1; k > 0; --k) {
        const bool open = !layers[k].thickness_mm;
        layers[k - 1].below =
            open ? layers[k].below
                 : Spectrum::through(layers[k], layers[k].below, *layers[k].thickness_mm);
    }
    return spectrum;
}

Exitance LayeredDiffusion::Spectrum::of(std::size_t index, double depth) const {
    const Layer& layer = layers_[index];
    const Side up = through(layer, layer.above, depth);
    // A half space is the same from any depth on.
    const Side down =
        layer.thickness_mm ? through(layer, layer.below, *layer.thickness_mm - depth) : layer.below;
    const double fluence = 1.0 / (up.admittance + down.admittance);
    return {fluence * up.exitance, fluence * down.exitance};
}

double half_space_spectrum(const Diffusion& diffusion, double depth, double per_mm) {
    const double a = std::hypot(diffusion.sigma_tr_per_mm, per_mm);
    const Hyperbolic h = hyperbolic(a, diffusion.extrapolation_mm);
    return std::exp(-a * depth) *
           (diffusion.fluence_share / diffusion.coefficient_mm * h.sinh_over +
            diffusion.flux_share * h.cosh);
}

}  // namespace livery
