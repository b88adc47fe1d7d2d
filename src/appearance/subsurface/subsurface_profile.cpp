#include "appearance/subsurface/subsurface_profile.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/profile_models.h"
#include "appearance/subsurface/single_scattering.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

/// Thinner slabs, in mean free paths, are lit along their depth and not from one point in it.
constexpr double kThinSlab = 2.5;

using Made = MadeProfile;

Made of_points(const ScatteringMedium& medium,
               const Diffusion& diffusion,
               std::vector<double> depths,
               std::vector<double> powers) {
    const auto sources =
        std::make_shared<PointSources>(diffusion, medium.thickness_mm, std::move(depths));
    Made made;
    for (std::size_t k = 0; k < powers.size(); ++k) {
        const Exitance each = sources->total(k);
        made.totals.reflected += powers[k] * each.reflected;
        made.totals.transmitted += powers[k] * each.transmitted;
    }
    made.at = [sources, powers = std::move(powers)](double r) {
        std::vector<Exitance> each;
        sources->at(r, each);
        Exitance sum;
        for (std::size_t k = 0; k < powers.size(); ++k) {
            sum.reflected += powers[k] * each[k].reflected;
            sum.transmitted += powers[k] * each[k].transmitted;
        }
        return sum;
    };
    return made;
}

Made dipole(const ScatteringMedium& medium) {
    return of_points(
        medium, classical_diffusion(medium), {medium.mean_free_path_mm()}, {medium.albedo_prime()});
}

Made better_dipole(const ScatteringMedium& medium) {
    const double albedo = medium.albedo_prime();
    return of_points(
        medium, improved_diffusion(medium), {medium.mean_free_path_mm()}, {albedo * albedo});
}

Made multipole(const ScatteringMedium& medium) {
    if (medium.reduced_depth() >= kThinSlab) return dipole(medium);
    static const auto nodes = gauss_legendre(16);
    std::vector<double> depths, powers;
    for (const QuadratureNode& node : nodes) {
        const double depth = node.at * medium.reduced_depth();
        depths.push_back(depth * medium.mean_free_path_mm());
        powers.push_back(node.weight * medium.reduced_depth() * std::exp(-depth) *
                         medium.albedo_prime());
    }
    return of_points(medium, classical_diffusion(medium), depths, powers);
}

Made beam_diffusion(const ScatteringMedium& medium) {
    const auto diffusion = std::make_shared<BeamDiffusion>(medium);
    return {[diffusion](double r) { return diffusion->at(r); }, diffusion->total()};
}

Made p3(const ScatteringMedium& medium) {
    const auto dipole = std::make_shared<P3Dipole>(medium);
    return {[dipole](double r) { return Exitance{dipole->at(r), 0.0}; }, {dipole->total(), 0.0}};
}

Made normalized(const ScatteringMedium& medium) {
    const NormalizedDiffusion diffusion(exact_totals(medium).reflectance,
                                        medium.mean_free_path_mm());
    return {[diffusion](double r) {
                return Exitance{diffusion.at(r), 0.0};
            },
            {diffusion.total(), 0.0}};
}

/// With what scatters once, which `factor` does not change.
Made with_single(const ScatteringMedium& medium, const Made& multiple, Exitance factor) {
    const DiffuseTotals once = single_scattering_totals(medium);
    Made made;
    made.totals = {once.reflectance + factor.reflected * multiple.totals.reflected,
                   once.transmittance + factor.transmitted * multiple.totals.transmitted};
    made.at = [medium, factor, at = multiple.at](double r) {
        const Exitance more = at(r);
        return Exitance{
            single_scattering_reflectance(medium, r) + factor.reflected * more.reflected,
            single_scattering_transmittance(medium, r) + factor.transmitted * more.transmitted};
    };
    return made;
}

/// What is missing from single scattering to the exact total, in the shape of beam diffusion.
Made scaled(const ScatteringMedium& medium) {
    const Made multiple = beam_diffusion(medium);
    return with_single(
        medium,
        multiple,
        factors_to(exact_totals(medium), single_scattering_totals(medium), multiple));
}

Made made_of(SubsurfaceModel model, const ScatteringMedium& medium) {
    const auto alone = Exitance{1.0, 1.0};
    switch (model) {
        case SubsurfaceModel::dipole:
            return dipole(medium);
        case SubsurfaceModel::better_dipole:
            return with_single(medium, better_dipole(medium), alone);
        case SubsurfaceModel::beam_diffusion:
            return with_single(medium, beam_diffusion(medium), alone);
        case SubsurfaceModel::scaled_beam_diffusion:
            return scaled(medium);
        case SubsurfaceModel::multipole:
            return multipole(medium);
        case SubsurfaceModel::p3:
            return p3(medium);
        case SubsurfaceModel::normalized_diffusion:
            return normalized(medium);
    }
    throw std::logic_error("subsurface_profile: no such model");
}

/// At r, or the mean over the smallest disc.
DiffuseTotals value_at(const std::function<DiffuseTotals(double)>& profile,
                       double least,
                       double radius) {
    check_argument(radius >= 0.0 && std::isfinite(radius),
                   fmt::format("radius: found {} mm, expected 0 or more", radius));
    if (!(least > 0.0)) return {};
    if (radius >= least) return profile(radius);
    const Exitance sum = over_disc(1e-4 * least, least, [&](double r) {
        const DiffuseTotals at = profile(r);
        return Exitance{at.reflectance, at.transmittance};
    });
    const double area = std::numbers::pi * least * least;
    return {sum.reflected / area, sum.transmitted / area};
}

}  // namespace

Exitance factors_to(const DiffuseTotals& exact,
                    const DiffuseTotals& once,
                    const MadeProfile& multiple) {
    const auto factor = [](double whole, double part, double shape) {
        return shape > 0.0 ? std::max(whole - part, 0.0) / shape : 0.0;
    };
    return {factor(exact.reflectance, once.reflectance, multiple.totals.reflected),
            factor(exact.transmittance, once.transmittance, multiple.totals.transmitted)};
}

const std::vector<SubsurfaceModelInfo>& subsurface_models() {
    using enum SubsurfaceModel;
    static const std::vector<SubsurfaceModelInfo> models{
        {dipole, "dipole", true, false, false, "a point source and its image (Jensen et al. 2001)"},
        {better_dipole,
         "better-dipole",
         true,
         false,
         false,
         "Grosjean's diffusion and exitance (d'Eon 2012), with single scattering"},
        {beam_diffusion,
         "beam-diffusion",
         true,
         true,
         false,
         "sources along the beam (Habel et al. 2013), with single scattering"},
        {scaled_beam_diffusion,
         "scaled-beam-diffusion",
         true,
         true,
         true,
         "the same, diffusion scaled to the exact total"},
        {multipole,
         "multipole",
         false,
         true,
         true,
         "images on both sides of a slab (Donner and Jensen 2005)"},
        {p3,
         "p3",
         true,
         false,
         false,
         "third-order spherical harmonics, a point source and its image"},
        {normalized_diffusion,
         "normalized-diffusion",
         true,
         false,
         false,
         "two exponentials fitted to Monte Carlo (Christensen and Burley 2015)"},
    };
    return models;
}

const SubsurfaceModelInfo& info_of(SubsurfaceModel model) {
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        if (info.model == model) return info;
    }
    throw std::logic_error("subsurface model without a row");
}

std::optional<SubsurfaceModel> find_subsurface_model(std::string_view name) {
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        if (info.name == name) return info.model;
    }
    return std::nullopt;
}

SubsurfaceProfile subsurface_profile(SubsurfaceModel model, const ScatteringMedium& medium) {
    check_medium(medium);
    const SubsurfaceModelInfo& info = info_of(model);
    const auto knows = [&](const SubsurfaceModelInfo& one) {
        return medium.thickness_mm ? one.slab : one.half_space;
    };
    if (!knows(info)) {
        std::vector<std::string> names;
        for (const SubsurfaceModelInfo& one : subsurface_models()) {
            if (knows(one)) names.emplace_back(one.name);
        }
        throw std::invalid_argument(fmt::format("model: found {} for a {}, expected {}",
                                                info.name,
                                                medium.thickness_mm ? "slab" : "half space",
                                                list_of(names)));
    }
    SubsurfaceProfile profile;
    profile.model = model;
    profile.least_radius_mm = least_radius_mm(medium);
    // Nothing scatters: nothing comes back, and no model has a formula for it.
    if (!(medium.sigma_s_prime() > 0.0)) {
        finish_profile({[](double) { return Exitance{}; }, {}}, unscattered_light(medium), profile);
        return profile;
    }
    const Made made = made_of(model, medium);
    finish_profile(made, unscattered_light(medium), profile);
    if (model == SubsurfaceModel::p3) {
        for (double paths = 1e-2; paths < 1e2 && !profile.was_negative; paths *= 1.3) {
            profile.was_negative = made.at(paths * medium.mean_free_path_mm()).reflected < 0.0;
        }
    }
    return profile;
}

void finish_profile(const MadeProfile& made,
                    const UnscatteredLight& unscattered,
                    SubsurfaceProfile& profile) {
    profile.totals = {std::max(made.totals.reflected, 0.0), std::max(made.totals.transmitted, 0.0)};
    const double most = 1.0 - unscattered.reflected - unscattered.transmitted;
    const double all = profile.totals.reflectance + profile.totals.transmittance;
    if (all > most) {
        profile.scale = most / all;
        profile.totals.reflectance *= profile.scale;
        profile.totals.transmittance *= profile.scale;
    }
    profile.both = [at = made.at, scale = profile.scale](double r) {
        const Exitance sum = at(r);
        return DiffuseTotals{scale * std::max(sum.reflected, 0.0),
                             scale * std::max(sum.transmitted, 0.0)};
    };
    profile.reflected = [both = profile.both](double r) { return both(r).reflectance; };
    profile.transmitted = [both = profile.both](double r) { return both(r).transmittance; };
}

DiffuseTotals SubsurfaceProfile::at(double radius_mm) const {
    return value_at(both, least_radius_mm, radius_mm);
}

double SubsurfaceProfile::reflectance(double radius_mm) const { return at(radius_mm).reflectance; }

double SubsurfaceProfile::transmittance(double radius_mm) const {
    return at(radius_mm).transmittance;
}

double energy_radius_mm(const SubsurfaceProfile& profile,
                        const ScatteringMedium& medium,
                        double share) {
    return energy_radius_mm(profile, medium.mean_free_path_mm(), share);
}

double energy_radius_mm(const SubsurfaceProfile& profile, double mean_free_path_mm, double share) {
    check_argument(share > 0.0 && share < 1.0,
                   fmt::format("share: found {}, expected above 0 and below 1", share));
    if (!(profile.least_radius_mm > 0.0) || !(profile.totals.reflectance > 0.0)) return 0.0;
    const auto f = [&](double r) { return Exitance{profile.reflected(r), 0.0}; };
    // Rings of a tenth in the logarithm, until there is enough.
    double within = over_disc(1e-5 * mean_free_path_mm, 1e-3 * mean_free_path_mm, f).reflected;
    const double wanted = share * profile.totals.reflectance;
    double r = 1e-3 * mean_free_path_mm;
    for (int k = 0; k < 200; ++k) {
        const double next = r * std::exp(0.1);
        const double ring =
            std::numbers::pi * (next * next - r * r) * f(std::sqrt(r * next)).reflected;
        if (within + ring >= wanted) return r * std::exp(0.1 * (wanted - within) / ring);
        within += ring;
        r = next;
    }
    return r;
}

namespace {

/// By how much of all light the profile was off in the media of docs/subsurface.md that are like
/// this one, in per cent; for slabs the worse of both sides. The test of compared_media() holds it
/// against Monte Carlo.
int measured_error(const ScatteringMedium& medium) {
    const double forward = std::abs(medium.g);
    const bool no_step = std::abs(medium.eta - 1.0) < 0.1;
    if (medium.thickness_mm) return forward > 0.5 ? 25 : 9;
    if (forward > 0.85) return 25;
    if (forward > 0.5 || no_step || medium.eta > 1.8) return 8;
    return 4;
}

/// The same of compared_stacks(): what crosses a layer without being scattered is no narrow beam's
/// light any more, and of what comes out below several layers a seventh lies elsewhere.
int measured_error(const ScatteringStack& stack) {
    const bool clear =
        std::any_of(stack.layers.begin(), stack.layers.end(), [](const ScatteringMedium& layer) {
            const double depth = layer.thickness_mm.value_or(0.0) * layer.sigma_s_prime();
            return layer.thickness_mm && depth < 0.3;
        });
    return stack.is_slab() || clear ? 16 : 5;
}

}  // namespace

std::string why_best(const ScatteringStack& given) {
    const ScatteringStack stack = merged(given);
    if (!stack.scatters()) return "nothing scatters here, which every model knows";
    if (stack.layers.size() > 1) {
        return fmt::format(
            "nearer to Monte Carlo than the multipole in every stack compared, within "
            "{}% of the light",
            measured_error(stack));
    }
    return fmt::format(
        "no model is measurably nearer to Monte Carlo in any medium compared than "
        "single scattering and beam diffusion scaled to the exact total: within "
        "{}% of the light in those like this one",
        measured_error(stack.layers.front()));
}

}  // namespace livery
