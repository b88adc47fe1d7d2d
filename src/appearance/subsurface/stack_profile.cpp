#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/subsurface/layered_sources.h"
#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/scattering_medium.h"
#include "appearance/subsurface/single_scattering.h"

namespace livery {

namespace {

/// Of light between layers that goes to and fro next to nothing may be left over.
constexpr double kLeastLeft = 1e-9;

MadeProfile scaled_beam_diffusion(const ScatteringStack& stack) {
    const auto multiple = std::make_shared<LayeredBeamDiffusion>(stack);
    const DiffuseTotals exact = exact_totals(stack), once = single_scattering_totals(stack);
    const Exitance factor = factors_to(exact, once, {{}, multiple->total()});
    MadeProfile made;
    made.totals = {std::max(exact.reflectance, once.reflectance),
                   std::max(exact.transmittance, once.transmittance)};
    made.at = [stack, multiple, factor](double r) {
        const Exitance more = multiple->at(r);
        return Exitance{
            single_scattering_reflectance(stack, r) + factor.reflected * more.reflected,
            single_scattering_transmittance(stack, r) + factor.transmitted * more.transmitted};
    };
    return made;
}

/// What a layer, or several, make of light that meets them from above (down) and below (up).
struct Transfer {
    double reflected_down = 0.0, transmitted_down = 0.0;
    double reflected_up = 0.0, transmitted_up = 0.0;
};

Transfer joined(const Transfer& above, const Transfer& below) {
    const double left = std::max(1.0 - above.reflected_up * below.reflected_down, kLeastLeft);
    return {above.reflected_down +
                above.transmitted_down * below.reflected_down * above.transmitted_up / left,
            above.transmitted_down * below.transmitted_down / left,
            below.reflected_up +
                below.transmitted_up * above.reflected_up * below.transmitted_down / left,
            below.transmitted_up * above.transmitted_up / left};
}

/// The stack layer by layer: the light that reaches a layer counts as a narrow beam into it.
class LayeredMultipole {
  public:
    explicit LayeredMultipole(const ScatteringStack& stack) {
        const std::size_t count = stack.layers.size();
        for (std::size_t k = 0; k < count; ++k) {
            const ScatteringMedium& layer = stack.layers[k];
            // Only the outer boundaries mirror.
            const auto with_index = [&](bool outer) {
                ScatteringMedium medium = layer;
                medium.eta = outer ? stack.eta() : 1.0;
                return diffusion_stack({{medium}}, classical_diffusion);
            };
            Layer made;
            made.thickness_mm = layer.thickness_mm;
            made.straight = std::exp(-layer.reduced_depth());
            if (k == 0) made.mirrored_above = mirrored(stack.eta());
            if (k + 1 == count) made.mirrored_below = mirrored(stack.eta());
            if (layer.sigma_t_prime() > 0.0) {
                const DiffusionStack top = with_index(k == 0), bottom = with_index(k + 1 == count);
                made.diffusion =
                    std::make_shared<LayeredDiffusion>(top.layers, top.top, bottom.bottom);
                made.sources = beam_sources({{layer}});
                for (BeamSource& source : made.sources) source.power *= layer.albedo_prime();
                if (k == 0) first_ = top.top;
            }
            layers_.push_back(std::move(made));
        }
        for (const BeamSource& source : layers_.front().sources) {
            depths_.push_back(source.depth_mm);
        }
        near_ = std::make_shared<PointSources>(first_, std::nullopt, depths_);
        straight_ = 1.0;
        for (const Layer& layer : layers_) straight_ *= layer.straight;
        if (!stack.is_slab()) straight_ = 0.0;
        straight_ *= 1.0 - mirrored(stack.eta());
    }

    Exitance spectrum(double per_mm) const {
        Transfer whole = transfer(layers_.back(), per_mm);
        for (std::size_t k = layers_.size() - 1; k-- > 0;) {
            whole = joined(transfer(layers_[k], per_mm), whole);
        }
        return {whole.reflected_down, std::max(whole.transmitted_down - straight_, 0.0)};
    }
    Exitance at(double radius_mm) const {
        std::vector<Exitance> each;
        near_->at(radius_mm, each);
        const auto& sources = layers_.front().sources;
        Exitance sum;
        for (std::size_t k = 0; k < sources.size(); ++k) {
            sum.reflected += sources[k].power * each[k].reflected;
        }
        inverse_hankel(radius_mm, [&](double per_mm, double weight) {
            const Exitance out = spectrum(per_mm);
            double known = 0.0;
            for (const BeamSource& source : sources) {
                known += source.power * half_space_spectrum(first_, source.depth_mm, per_mm);
            }
            sum.reflected += weight * (out.reflected - known);
            sum.transmitted += weight * out.transmitted;
        });
        return sum;
    }

  private:
    struct Layer {
        std::shared_ptr<LayeredDiffusion> diffusion;  ///< none in a clear layer
        std::vector<BeamSource> sources;
        double straight = 0.0;  ///< of light that crosses it without being met
        double mirrored_above = 0.0, mirrored_below = 0.0;
        std::optional<double> thickness_mm;
    };

    /// Of even light inside.
    static double mirrored(double eta) { return 2.0 * fresnel_moments(eta).c1; }

    static Transfer transfer(const Layer& layer, double per_mm) {
        Transfer made;
        if (layer.diffusion) {
            const auto spectrum = layer.diffusion->at(per_mm);
            for (const BeamSource& source : layer.sources) {
                const Exitance down = spectrum.of(0, source.depth_mm);
                made.reflected_down += source.power * down.reflected;
                made.transmitted_down += source.power * down.transmitted;
                if (!layer.thickness_mm) continue;
                const Exitance up = spectrum.of(0, *layer.thickness_mm - source.depth_mm);
                made.reflected_up += source.power * up.transmitted;
                made.transmitted_up += source.power * up.reflected;
            }
        }
        // What goes straight across meets the outer boundaries too.
        const double twice = layer.straight * layer.straight;
        made.transmitted_down += layer.straight * (1.0 - layer.mirrored_below);
        made.reflected_down += twice * layer.mirrored_below;
        made.transmitted_up += layer.straight * (1.0 - layer.mirrored_above);
        made.reflected_up += twice * layer.mirrored_above;
        return made;
    }

    std::vector<Layer> layers_;
    Diffusion first_;
    std::vector<double> depths_;
    std::shared_ptr<PointSources> near_;
    double straight_ = 0.0;
};

MadeProfile multipole(const ScatteringStack& stack) {
    const auto layers = std::make_shared<LayeredMultipole>(stack);
    return {[layers](double r) { return layers->at(r); }, layers->spectrum(0.0)};
}

}  // namespace

SubsurfaceProfile subsurface_profile(SubsurfaceModel model, const ScatteringStack& given) {
    check_stack(given);
    const ScatteringStack stack = merged(given);
    const bool is_multipole = model == SubsurfaceModel::multipole;
    if (stack.layers.size() == 1 && !(is_multipole && !stack.is_slab())) {
        return subsurface_profile(model, stack.layers.front());
    }
    if (!info_of(model).layers) {
        throw std::invalid_argument(
            fmt::format("model: found {} for layers, expected multipole or scaled-beam-diffusion",
                        info_of(model).name));
    }
    SubsurfaceProfile profile;
    profile.model = model;
    profile.least_radius_mm = least_radius_mm(stack);
    if (!stack.scatters()) {
        finish_profile({[](double) { return Exitance{}; }, {}}, unscattered_light(stack), profile);
        return profile;
    }
    finish_profile(is_multipole ? multipole(stack) : scaled_beam_diffusion(stack),
                   unscattered_light(stack),
                   profile);
    return profile;
}

}  // namespace livery
