#include "appearance/subsurface/model_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/quadrature.h"

namespace livery {

namespace {

/// From the beam to where a thousandth is left, each an eighth wider than the one before.
std::vector<ProfileRing> rings_of(const ScatteringStack& stack) {
    const SubsurfaceProfile profile =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, stack);
    const double path = stack.mean_free_path_mm();
    const double end = std::max(energy_radius_mm(profile, path, 0.999), 3.0 * path);
    std::vector<ProfileRing> rings{{0.0, 0.02 * path}};
    while (rings.back().outer_mm < end) {
        rings.push_back({rings.back().outer_mm, 1.125 * rings.back().outer_mm});
    }
    return rings;
}

double area_of(const ProfileRing& ring) {
    return std::numbers::pi * (ring.outer_mm - ring.inner_mm) * (ring.outer_mm + ring.inner_mm);
}

/// Mean over the ring's area. In the innermost, where profiles go as 1/r, too.
double mean_over(const std::function<double(double)>& profile, const ProfileRing& ring) {
    static const auto many = gauss_legendre(8), few = gauss_legendre(3);
    const double sum =
        integrate(ring.inner_mm > 0.0 ? few : many, ring.inner_mm, ring.outer_mm, [&](double r) {
            return 2.0 * std::numbers::pi * r * profile(r);
        });
    return sum / area_of(ring);
}

/// Share of `truth` that the values are off, by area.
double l1_of(const std::vector<double>& values,
             const std::vector<Estimate>& truth,
             const std::vector<ProfileRing>& rings) {
    double off = 0.0, all = 0.0;
    for (std::size_t k = 0; k < rings.size(); ++k) {
        off += std::abs(values[k] - truth[k].value) * area_of(rings[k]);
        all += truth[k].value * area_of(rings[k]);
    }
    return all > 0.0 ? off / all : 0.0;
}

double rms_ln_of(const std::vector<double>& values,
                 const std::vector<Estimate>& truth,
                 const std::vector<ProfileRing>& rings,
                 double path) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < rings.size(); ++k) {
        const double middle = 0.5 * (rings[k].inner_mm + rings[k].outer_mm) / path;
        if (middle < 1.0 || middle > 10.0 || !(truth[k].value > 0.0)) continue;
        // A profile that is nothing there is off by more than any factor that matters.
        const double off = std::log(std::max(values[k] / truth[k].value, 1e-3));
        sum += off * off;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

const std::vector<NamedMedium>& compared_media() {
    // Green channels of Jensen et al. 2001, and corners between and beyond them.
    static const std::vector<NamedMedium> media{
        {"marble", {0.0041, 2.62, 0.0, 1.5, {}}},
        {"white PVC", {0.003, 2.0, 0.0, 1.5, {}}},
        {"skim milk", {0.0025, 1.22, 0.0, 1.3, {}}},
        {"skin 1", {0.17, 0.88, 0.0, 1.3, {}}},
        {"ketchup", {0.97, 0.07, 0.0, 1.3, {}}},
        {"albedo .5", {0.5, 0.5, 0.0, 1.5, {}}},
        {"marble, no index step", {0.0041, 2.62, 0.0, 1.0, {}}},
        {"marble, g .8", {0.0041, 13.1, 0.8, 1.5, {}}},
        {"skin 1, g .8", {0.17, 4.4, 0.8, 1.3, {}}},
        {"marble, 2 mm", {0.0041, 2.62, 0.0, 1.5, 2.0}},
        {"skin 1, 2 mm", {0.17, 0.88, 0.0, 1.3, 2.0}},
        {"marble, .2 mm", {0.0041, 2.62, 0.0, 1.5, 0.2}},
    };
    return media;
}

const std::vector<NamedStack>& compared_stacks() {
    static const std::vector<NamedStack> stacks{
        {"skin 1, 1 mm, on marble", {{{0.17, 0.88, 0.0, 1.3, 1.0}, {0.0041, 2.62, 0.0, 1.3, {}}}}},
        {"marble, 1 mm, on skin 1", {{{0.0041, 2.62, 0.0, 1.3, 1.0}, {0.17, 0.88, 0.0, 1.3, {}}}}},
        {"marble, 1 mm, on an absorber",
         {{{0.0041, 2.62, 0.0, 1.5, 1.0}, {2.0, 0.2, 0.0, 1.5, {}}}}},
        {"clear, .5 mm, on marble", {{{0.0, 0.0, 0.0, 1.5, 0.5}, {0.0041, 2.62, 0.0, 1.5, {}}}}},
        {"marble, 1 mm, skin 1, 1 mm",
         {{{0.0041, 2.62, 0.0, 1.5, 1.0}, {0.17, 0.88, 0.0, 1.5, 1.0}}}},
        {"three of skin, 3 mm",
         {{{0.3, 1.5, 0.0, 1.4, 0.3}, {0.05, 2.5, 0.0, 1.4, 1.2}, {0.02, 1.0, 0.0, 1.4, 1.5}}}},
    };
    return stacks;
}

MediumErrors model_errors(const NamedMedium& named,
                          const MonteCarloSettings& settings,
                          const Progress& progress) {
    return model_errors(NamedStack{named.name, {{named.medium}}}, settings, progress);
}

MediumErrors model_errors(const NamedStack& named,
                          const MonteCarloSettings& settings,
                          const Progress& progress) {
    const ScatteringStack stack = merged(named.stack);
    const bool is_slab = stack.is_slab(), is_layered = stack.layers.size() > 1;
    const std::vector<ProfileRing> rings = rings_of(stack);
    const MonteCarloProfile truth = monte_carlo_profile(stack, rings, settings, progress);
    const double whole = exact_totals(stack).reflectance;
    MediumErrors errors{named.name, is_slab, 0.0, {}};
    double noise = 0.0, all = 0.0;
    for (std::size_t k = 0; k < rings.size(); ++k) {
        // The mean of |x| for a normal error.
        noise += std::sqrt(2.0 / std::numbers::pi) * truth.rd[k].standard_error * area_of(rings[k]);
        all += truth.rd[k].value * area_of(rings[k]);
    }
    errors.noise_l1 = all > 0.0 ? noise / all : 0.0;
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        const bool known = is_layered ? info.layers : is_slab ? info.slab : info.half_space;
        if (!known) continue;
        const SubsurfaceProfile profile = subsurface_profile(info.model, stack);
        std::vector<double> rd, rt;
        for (const ProfileRing& ring : rings) {
            rd.push_back(mean_over(profile.reflected, ring));
            rt.push_back(is_slab ? mean_over(profile.transmitted, ring) : 0.0);
        }
        ModelError error;
        error.model = info.model;
        error.reflectance_l1 = l1_of(rd, truth.rd, rings);
        error.transmittance_l1 = l1_of(rt, truth.rt, rings);
        error.reflectance_bias = whole > 0.0 ? profile.totals.reflectance / whole - 1.0 : 0.0;
        error.rms_ln = rms_ln_of(rd, truth.rd, rings, stack.mean_free_path_mm());
        error.was_negative = profile.was_negative;
        errors.models.push_back(error);
    }
    return errors;
}

std::string markdown_of(const std::vector<MediumErrors>& media) {
    std::string text =
        "| medium | model | L1 of R_d | total R_d | ln R_d, 1 to 10 paths | L1 of T_d |\n"
        "| --- | --- | --- | --- | --- | --- |\n";
    for (const MediumErrors& errors : media) {
        std::string name = errors.name;
        for (const ModelError& error : errors.models) {
            const std::string model = info_of(error.model).name;
            const bool best = error.model == kBestSubsurfaceModel;
            text += fmt::format(
                "| {} | {} | {:.1f}% | {:+.1f}% | {:.3f} | {} |\n",
                name,
                best ? "**" + model + "**" : model,
                100.0 * error.reflectance_l1,
                100.0 * error.reflectance_bias,
                error.rms_ln,
                errors.is_slab ? fmt::format("{:.1f}%", 100.0 * error.transmittance_l1) : "");
            name.clear();
        }
    }
    return text;
}

}  // namespace livery
