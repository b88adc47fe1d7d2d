// livery fit bssrdf

#include <memory>

#include <fmt/format.h>

#include "appearance/subsurface/fit_profile.h"
#include "appearance/subsurface/translucent_material.h"
#include "cli/command.h"
#include "cli/subsurface/medium_options.h"

namespace livery {

namespace {

struct BssrdfFitArguments {
    std::string profile, model = "best", g, eta, thickness_mm, spot_mm, name, out;
};

ProfileFitOptions options_of(const BssrdfFitArguments& arguments) {
    ProfileFitOptions options;
    options.eta = parse_number("--eta", arguments.eta).value_or(1.5);
    options.g = parse_number("--g", arguments.g).value_or(0.0);
    options.thickness_mm = parse_number("--thickness-mm", arguments.thickness_mm);
    options.spot_mm = parse_number("--spot-mm", arguments.spot_mm).value_or(0.0);
    options.model = arguments.model == "best"
                        ? best_model({1.0, 1.0, 0.0, options.eta, options.thickness_mm}).model
                        : *find_subsurface_model(arguments.model);
    const SubsurfaceModelInfo& info = info_of(options.model);
    check_argument(options.thickness_mm ? info.slab : info.half_space,
                   fmt::format("--model: found {}, which knows {}, expected best or another",
                               info.name,
                               options.thickness_mm ? "no slab (--thickness-mm)"
                                                    : "slabs alone: --thickness-mm is missing"));
    return options;
}

Json confidence_of(const ProfileFit& fit) {
    const auto told = [](const FittedParameter& one) {
        return Json{{"relative_standard_error", one.relative_standard_error},
                    {"verdict", one.relative_standard_error > 0.15 ? "weak" : "good"}};
    };
    return {
        {"sigma_a", told(fit.sigma_a_per_mm)},
        {"sigma_s_prime", told(fit.sigma_s_prime_per_mm)},
        {"g",
         {{"verdict", "not identifiable"},
          {"why", "beyond a mean free path profiles of one sigma_s' are alike: g is as given"}}},
        {"correlation", fit.correlation},
        {"model_error", fit.model_error},
        {"warnings", fit.warnings}};
}

std::string text_of(const ProfileFit& fit, const ProfileFitOptions& options) {
    const auto line = [](const char* name, const FittedParameter& one) {
        return fmt::format("{:<10} {:>10.5g} per mm +- {:.1f}%\n",
                           name,
                           one.value,
                           100.0 * one.relative_standard_error);
    };
    std::string text =
        line("sigma_a", fit.sigma_a_per_mm) + line("sigma_s'", fit.sigma_s_prime_per_mm);
    text += fmt::format("g          {:>10.5g} as given: no profile tells it\n", fit.g);
    text += fmt::format("{}, {} radii from {:.3g} to {:.3g} mm, {:.1f}% off in the mean\n",
                        info_of(options.model).name,
                        fit.used,
                        fit.from_mm,
                        fit.to_mm,
                        100.0 * std::expm1(fit.error));
    if (fit.not_positive > 0) {
        text += fmt::format("left out: {} radii without light\n", fit.not_positive);
    }
    for (const std::string& warning : fit.warnings) text += "note: " + warning + "\n";
    return text;
}

TranslucentMaterial material_of(const ProfileFit& fit,
                                const ProfileFitOptions& options,
                                const BssrdfFitArguments& arguments) {
    const std::filesystem::path profile = arguments.profile;
    TranslucentMaterial material;
    material.name = arguments.name.empty() ? profile.stem().string() : arguments.name;
    material.sigma_a_per_mm = glm::dvec3(fit.sigma_a_per_mm.value);
    material.sigma_s_prime_per_mm = glm::dvec3(fit.sigma_s_prime_per_mm.value);
    material.g = fit.g;
    material.eta = fit.eta;
    material.thickness_mm = options.thickness_mm;
    material.provenance = fmt::format(
        "fitted to the profile of {} by {} from {:.3g} to {:.3g} mm: {:.1f}% off in "
        "the mean",
        profile.filename().string(),
        info_of(options.model).name,
        fit.from_mm,
        fit.to_mm,
        100.0 * std::expm1(fit.error));
    return material;
}

}  // namespace

Command fit_bssrdf_command() {
    const auto arguments = std::make_shared<BssrdfFitArguments>();
    std::vector<std::string> models{"best"};
    for (const SubsurfaceModelInfo& info : subsurface_models()) {
        if (info.model != SubsurfaceModel::normalized_diffusion) models.push_back(info.name);
    }
    Command command;
    command.name = "fit bssrdf";
    command.summary = "a measured profile of a translucent sample -> its absorption and scattering";
    command.example =
        "livery fit bssrdf --profile marble.csv --eta 1.5 --model best --out marble.json";
    command.options = {
        {"--profile",
         "FILE",
         "CSV with the columns r_mm and rd: per mm^2 and unit power that enters",
         &arguments->profile,
         true,
         {}},
        {"--model",
         "NAME",
         "a model of docs/subsurface.md; best: the nearest to Monte Carlo (default best)",
         &arguments->model,
         false,
         models},
        {"--eta",
         "N",
         "index of refraction over that of air (default 1.5)",
         &arguments->eta,
         false,
         {}},
        {"--g",
         "G",
         "mean cosine of the phase function, which no profile tells (default 0)",
         &arguments->g,
         false,
         {}},
        {"--thickness-mm",
         "D",
         "the sample is a slab of this thickness in air (default: without end)",
         &arguments->thickness_mm,
         false,
         {}},
        {"--spot-mm",
         "W",
         "how wide the spot of light was: refused where it rules the profile",
         &arguments->spot_mm,
         false,
         {}},
        {"--name",
         "NAME",
         "what the material is called (default: the file's name)",
         &arguments->name,
         false,
         {}},
        {"--out", "FILE", "the material, for livery bssrdf --material", &arguments->out, false, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const ProfileFitOptions options = options_of(*arguments);
        const std::vector<ProfileSample> samples = read_profile_csv(arguments->profile);
        const ProfileFit fit = fit_profile(samples, options, progress);
        Outcome outcome;
        outcome.figures = {{"sigma_a_per_mm", fit.sigma_a_per_mm.value},
                           {"sigma_s_prime_per_mm", fit.sigma_s_prime_per_mm.value},
                           {"g", fit.g},
                           {"eta", fit.eta},
                           {"error", fit.error},
                           {"error_is", "root mean square of ln(model/measured) in the window"},
                           {"confidence", confidence_of(fit)},
                           {"model", info_of(options.model).name},
                           {"window_mm", {fit.from_mm, fit.to_mm}},
                           {"samples", samples.size()},
                           {"samples_used", fit.used},
                           {"samples_not_positive", fit.not_positive},
                           {"half_energy_radius_mm", fit.half_energy_radius_mm}};
        if (options.thickness_mm) outcome.figures["thickness_mm"] = *options.thickness_mm;
        outcome.text = text_of(fit, options);
        if (!arguments->out.empty()) {
            write_translucent_material(arguments->out, material_of(fit, options, *arguments));
            outcome.figures["file"] = arguments->out;
            outcome.text += "wrote " + arguments->out + "\n";
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
