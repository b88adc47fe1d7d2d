// livery fit bssrdf

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "appearance/subsurface/fit_profile.h"
#include "appearance/subsurface/translucent_material.h"
#include "cli/command.h"
#include "cli/subsurface/medium_options.h"
#include "core/error.h"

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
    options.model =
        arguments.model == "best" ? kBestSubsurfaceModel : *find_subsurface_model(arguments.model);
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

/// One profile, or the three of a camera's channels.
std::vector<std::filesystem::path> profiles_of(const BssrdfFitArguments& arguments) {
    // A name may have commas itself.
    if (std::filesystem::exists(arguments.profile)) return {arguments.profile};
    std::vector<std::filesystem::path> files;
    std::istringstream names(arguments.profile);
    for (std::string name; std::getline(names, name, ',');) files.emplace_back(name);
    check_argument(files.size() == 1 || files.size() == 3,
                   fmt::format("--profile: found {} files, expected one, or three with commas: of "
                               "red, green and blue",
                               files.size()));
    return files;
}

/// As wide as said, a number for all or one each.
std::vector<double> spots_of(const BssrdfFitArguments& arguments, std::size_t profiles) {
    if (arguments.spot_mm.empty()) return std::vector<double>(profiles, 0.0);
    if (arguments.spot_mm.find(',') != std::string::npos) {
        return parse_numbers("--spot-mm", arguments.spot_mm, profiles);
    }
    return std::vector<double>(profiles, *parse_number("--spot-mm", arguments.spot_mm));
}

struct FittedProfile {
    std::filesystem::path file;
    std::size_t samples = 0;
    ProfileFit fit;
};

TranslucentMaterial material_of(const std::vector<FittedProfile>& fitted,
                                const ProfileFitOptions& options,
                                const BssrdfFitArguments& arguments) {
    TranslucentMaterial material;
    const std::filesystem::path named =
        fitted.size() == 1 ? fitted.front().file : std::filesystem::path(arguments.out);
    material.name = arguments.name.empty() ? named.stem().string() : arguments.name;
    material.g = fitted.front().fit.g;
    material.eta = fitted.front().fit.eta;
    material.thickness_mm = options.thickness_mm;
    std::string from;
    for (std::size_t c = 0; c < 3; ++c) {
        const FittedProfile& one = fitted[std::min(c, fitted.size() - 1)];
        const int channel = static_cast<int>(c);
        material.sigma_a_per_mm[channel] = one.fit.sigma_a_per_mm.value;
        material.sigma_s_prime_per_mm[channel] = one.fit.sigma_s_prime_per_mm.value;
        if (c >= fitted.size()) continue;
        from += fmt::format("{}{} from {:.3g} to {:.3g} mm, {:.1f}% off in the mean",
                            c == 0 ? "" : "; ",
                            one.file.filename().string(),
                            one.fit.from_mm,
                            one.fit.to_mm,
                            100.0 * std::expm1(one.fit.error));
    }
    material.provenance = fmt::format("fitted by {} to the radial profile{} {}",
                                      info_of(options.model).name,
                                      fitted.size() == 1 ? "" : "s",
                                      from);
    return material;
}

Json figures_of(const FittedProfile& one) {
    const ProfileFit& fit = one.fit;
    return {{"sigma_a_per_mm", fit.sigma_a_per_mm.value},
            {"sigma_s_prime_per_mm", fit.sigma_s_prime_per_mm.value},
            {"g", fit.g},
            {"eta", fit.eta},
            {"error", fit.error},
            {"error_is", "root mean square of ln(model/measured) in the window"},
            {"confidence", confidence_of(fit)},
            {"window_mm", {fit.from_mm, fit.to_mm}},
            {"samples", one.samples},
            {"samples_used", fit.used},
            {"samples_not_positive", fit.not_positive},
            {"half_energy_radius_mm", fit.half_energy_radius_mm}};
}

Outcome run_fits(const BssrdfFitArguments& arguments, const Progress& progress) {
    static constexpr std::array<const char*, 3> kFitChannels{"red", "green", "blue"};
    ProfileFitOptions options = options_of(arguments);
    const std::vector<std::filesystem::path> files = profiles_of(arguments);
    const std::vector<double> spots = spots_of(arguments, files.size());
    std::vector<FittedProfile> fitted;
    Outcome outcome;
    for (std::size_t k = 0; k < files.size(); ++k) {
        const auto count = static_cast<double>(files.size());
        const double at = static_cast<double>(k);
        FittedProfile& one = fitted.emplace_back();
        one.file = files[k];
        const std::vector<ProfileSample> samples = read_profile_csv(files[k]);
        one.samples = samples.size();
        options.spot_mm = spots[k];
        try {
            one.fit = fit_profile(samples, options, progress.part(at / count, (at + 1.0) / count));
        } catch (const Refused& refused) {
            if (files.size() == 1) throw;
            throw Refused(files[k].filename().string() + ": " + refused.why(), refused.fix());
        }
        if (files.size() > 1) {
            outcome.text += fmt::format("{}: {}\n", kFitChannels[k], files[k].string());
        }
        outcome.text += text_of(one.fit, options);
    }
    if (fitted.size() == 1) {
        outcome.figures = figures_of(fitted.front());
    } else {
        outcome.figures["channels"] = Json::array();
        for (std::size_t k = 0; k < fitted.size(); ++k) {
            Json channel = figures_of(fitted[k]);
            channel["channel"] = kFitChannels[k];
            outcome.figures["channels"].push_back(std::move(channel));
        }
    }
    outcome.figures["model"] = info_of(options.model).name;
    if (options.thickness_mm) outcome.figures["thickness_mm"] = *options.thickness_mm;
    if (!arguments.out.empty()) {
        write_translucent_material(arguments.out, material_of(fitted, options, arguments));
        outcome.figures["file"] = arguments.out;
        outcome.text += "wrote " + arguments.out + "\n";
    }
    return outcome;
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
         "CSV with the columns r_mm and rd: per mm^2 and unit power that enters; or three with "
         "commas, of red, green and blue",
         &arguments->profile,
         true},
        {"--model",
         "NAME",
         "a model of docs/subsurface.md; best: the nearest to Monte Carlo (default best)",
         &arguments->model,
         false,
         models},
        {"--eta", "N", "index of refraction over that of air (default 1.5)", &arguments->eta},
        {"--g",
         "G",
         "mean cosine of the phase function, which no profile tells (default 0)",
         &arguments->g},
        {"--thickness-mm",
         "D",
         "the sample is a slab of this thickness in air (default: without end)",
         &arguments->thickness_mm},
        {"--spot-mm",
         "W",
         "how wide the spot of light was, or three: refused where it rules the profile",
         &arguments->spot_mm},
        {"--name",
         "NAME",
         "what the material is called (default: the file's name)",
         &arguments->name},
        {"--out", "FILE", "the material, for livery bssrdf --material", &arguments->out},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        return run_fits(*arguments, progress);
    };
    return command;
}

}  // namespace livery
