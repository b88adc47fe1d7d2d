#include "appearance/subsurface/layered_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/profile_models.h"

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

namespace {

/// e^-45 of the shallowest source is less than rounding.
constexpr double kNothingLeft = 45.0;

ScatteringMedium diffusing(const ScatteringMedium& layer) {
    ScatteringMedium medium = layer;
    if (!layer.thickness_mm) return medium;
    const double least = 1.0 / (3.0 * *layer.thickness_mm);
    if (medium.sigma_t_prime() >= least) return medium;
    medium.g = 0.0;
    medium.sigma_s_per_mm = least - medium.sigma_a_per_mm;
    return medium;
}

std::vector<double> first_depths(const std::vector<BeamSource>& sources) {
    std::vector<double> depths;
    for (const BeamSource& source : sources) {
        if (source.layer == 0) depths.push_back(source.depth_mm);
    }
    return depths;
}

}  // namespace

DiffusionStack diffusion_stack(const ScatteringStack& stack,
                               Diffusion (*diffusion)(const ScatteringMedium&)) {
    DiffusionStack made;
    ScatteringMedium last;
    for (const ScatteringMedium& layer : stack.layers) {
        if (!layer.thickness_mm && !(layer.sigma_t_prime() > 0.0)) {
            made.lost_below = true;
            last.eta = 1.0;
            break;
        }
        last = diffusing(layer);
        made.layers.push_back({diffusion(last), layer.thickness_mm});
    }
    made.top = made.layers.front().diffusion;
    made.bottom = diffusion(last);
    return made;
}

std::vector<BeamSource> beam_sources(const ScatteringStack& stack) {
    std::vector<BeamSource> sources;
    double reduced = 0.0, depth = 0.0;
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const ScatteringMedium& layer = stack.layers[k];
        const double density = layer.sigma_t_prime();
        if (density > 0.0 && layer.sigma_s_prime() > 0.0) {
            const BeamDepths found = beam_depths(reduced, reduced + layer.reduced_depth());
            for (std::size_t n = 0; n < found.powers.size(); ++n) {
                const double within = (found.reduced_depths[n] - reduced) / density;
                sources.push_back(
                    {k, within, depth + within, found.reduced_depths[n], found.powers[n]});
            }
        }
        if (!layer.thickness_mm) break;
        if (density > 0.0) reduced += layer.reduced_depth();
        depth += *layer.thickness_mm;
    }
    return sources;
}

LayeredBeamDiffusion::LayeredBeamDiffusion(const ScatteringStack& stack)
    : layers_(diffusion_stack(stack, improved_diffusion)),
      diffusion_(layers_.layers, layers_.top, layers_.bottom),
      sources_(beam_sources(stack)),
      near_(layers_.top, {}, first_depths(sources_)),
      mean_free_path_mm_(stack.mean_free_path_mm()),
      decay_per_mm_(layers_.top.sigma_tr_per_mm) {
    for (BeamSource& source : sources_) {
        const double albedo = stack.layers[source.layer].albedo_prime();
        source.power *= albedo * albedo;
        if (source.layer == 0) ++in_first_;
    }
    for (const DiffusionLayer& layer : layers_.layers) {
        decay_per_mm_ = std::min(decay_per_mm_, layer.diffusion.sigma_tr_per_mm);
    }
    if (stack.is_slab()) {
        for (const ScatteringMedium& layer : stack.layers) {
            thickness_mm_ += *layer.thickness_mm;
            if (layer.sigma_t_prime() > 0.0) reduced_depth_ += layer.reduced_depth();
        }
    }
    // Of a source in the first layer the half space is taken off: what is left was below it.
    const double first =
        stack.layers.front().thickness_mm.value_or(std::numeric_limits<double>::infinity());
    for (const BeamSource& source : sources_) {
        const double up = source.layer == 0 ? 2.0 * first - source.depth_mm : source.depth_mm;
        const double down = stack.is_slab() ? thickness_mm_ - source.depth_mm : up;
        shortest_.push_back(std::min(up, down));
    }
}

Exitance LayeredBeamDiffusion::at(double radius_mm) const {
    std::vector<Exitance> each;
    near_.at(radius_mm, each);
    each.resize(sources_.size());
    inverse_hankel(radius_mm, [&](double per_mm, double weight) {
        const auto spectrum = diffusion_.at(per_mm);
        for (std::size_t k = 0; k < sources_.size(); ++k) {
            const BeamSource& source = sources_[k];
            if (per_mm * shortest_[k] > kNothingLeft) continue;
            const Exitance out = spectrum.of(source.layer, source.depth_in_layer_mm);
            const double known =
                k < in_first_ ? half_space_spectrum(layers_.top, source.depth_mm, per_mm) : 0.0;
            each[k].reflected += weight * (out.reflected - known);
            each[k].transmitted += weight * out.transmitted;
        }
    });
    // As BeamDiffusion: Grosjean's solution has too much near the beam.
    const auto often = [&](const BeamSource& source, double optical, double to_exit) {
        const double slant = to_exit > 0.0 ? std::hypot(radius_mm, to_exit) / to_exit : 1.0;
        return -std::expm1(-2.0 * (source.reduced_depth + optical * slant));
    };
    Exitance sum;
    for (std::size_t k = 0; k < sources_.size(); ++k) {
        const BeamSource& source = sources_[k];
        sum.reflected +=
            source.power * each[k].reflected * often(source, source.reduced_depth, source.depth_mm);
        if (!(thickness_mm_ > 0.0)) continue;
        sum.transmitted +=
            source.power * each[k].transmitted *
            often(source, reduced_depth_ - source.reduced_depth, thickness_mm_ - source.depth_mm);
    }
    return sum;
}

Exitance LayeredBeamDiffusion::total() const {
    return over_plane(mean_free_path_mm_, decay_per_mm_, [&](double r) { return at(r); });
}

}  // namespace livery
