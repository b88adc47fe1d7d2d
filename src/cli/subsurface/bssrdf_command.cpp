// livery bssrdf

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "appearance/subsurface/model_errors.h"
#include "appearance/subsurface/translucent_material.h"
#include "cli/command.h"
#include "cli/subsurface/medium_options.h"
#include "core/text/markup.h"

namespace livery {

namespace {

struct BssrdfArguments : MediumArguments {
    std::string layers, model = "best", radii = "0.1,0.2,0.5,1,2,5,10", markdown;
    int photons = 1'000'000;
    bool compare = false, compare_layers = false;
};

std::vector<double> parse_radii(const std::string& text) {
    const auto radii = parse_numbers("--radii-mm", text, 0);
    for (const double radius : radii) {
        if (radius < 0.0 || radius > 1e6) {
            throw std::invalid_argument(fmt::format(
                "--radii-mm: found {}, expected distances from 0 to 1000000 mm", radius));
        }
    }
    if (radii.size() > 10'000) {
        throw std::invalid_argument(
            fmt::format("--radii-mm: found {} of them, expected at most 10000", radii.size()));
    }
    return radii;
}

MonteCarloSettings photons_of(const BssrdfArguments& arguments, const CommonOptions& common) {
    if (arguments.photons < 1000 || arguments.photons > 2'000'000'000) {
        throw std::invalid_argument(
            fmt::format("--photons: found {}, expected 1000 to 2000000000", arguments.photons));
    }
    return {static_cast<std::uint64_t>(arguments.photons), static_cast<std::uint64_t>(common.seed)};
}

ScatteringStack stack_from(const BssrdfArguments& arguments) {
    if (arguments.layers.empty()) return {{medium_from(arguments)}};
    check_argument(arguments.sigma_a.empty() && arguments.sigma_s.empty() && arguments.g.empty() &&
                       arguments.eta.empty() && arguments.thickness_mm.empty() &&
                       arguments.material.empty(),
                   "--layers: found beside options of one medium, expected one or the other");
    return read_scattering_stack(arguments.layers);
}

Json json_of(const ScatteringMedium& medium) {
    Json json = {{"sigma_a_per_mm", medium.sigma_a_per_mm},
                 {"sigma_s_per_mm", medium.sigma_s_per_mm},
                 {"sigma_s_prime_per_mm", medium.sigma_s_prime()},
                 {"g", medium.g},
                 {"eta", medium.eta}};
    if (medium.thickness_mm) json["thickness_mm"] = *medium.thickness_mm;
    return json;
}

/// What is said of a medium, or layers, by every model.
void tell_medium(const ScatteringStack& stack, bool layered, Outcome& outcome) {
    const UnscatteredLight unscattered = unscattered_light(stack);
    Json& figures = outcome.figures;
    figures["specular"] = unscattered.specular;
    figures["unscattered_transmittance"] = unscattered.transmitted;
    figures["unscattered_reflectance"] = unscattered.reflected;
    if (!layered) {
        figures["medium"] = json_of(stack.layers.front());
        return;
    }
    figures["layers"] = Json::array();
    for (const ScatteringMedium& layer : stack.layers) figures["layers"].push_back(json_of(layer));
}

std::string text_of(const Json& figures) {
    const bool slab = figures.contains("rt"), noisy = figures.contains("rd_se");
    std::string text =
        fmt::format("{}\n{:>10} {:>14}", figures["model"].get<std::string>(), "r mm", "rd per mm2");
    if (noisy) text += fmt::format(" {:>12}", "+-");
    if (slab) text += fmt::format(" {:>14}", "rt per mm2");
    text += "\n";
    for (std::size_t k = 0; k < figures["radii_mm"].size(); ++k) {
        text += fmt::format("{:>10.5g} {:>14.6g}",
                            figures["radii_mm"][k].get<double>(),
                            figures["rd"][k].get<double>());
        if (noisy) text += fmt::format(" {:>12.2g}", figures["rd_se"][k].get<double>());
        if (slab) text += fmt::format(" {:>14.6g}", figures["rt"][k].get<double>());
        text += "\n";
    }
    text += fmt::format(
        "of what enters: reflected {:.5f}, through {:.5f}, through unscattered "
        "{:.5f}, absorbed {:.5f}; specular {:.5f} of what arrives\n",
        figures["total_reflectance"].get<double>(),
        figures["total_transmittance"].get<double>(),
        figures["unscattered_transmittance"].get<double>(),
        figures["absorbed"].get<double>(),
        figures["specular"].get<double>());
    if (figures.contains("why")) text += figures["why"].get<std::string>() + "\n";
    if (figures.contains("notes")) {
        for (const Json& note : figures["notes"]) text += "note: " + note.get<std::string>() + "\n";
    }
    return text;
}

void run_monte_carlo(const ScatteringStack& stack,
                     const std::vector<double>& radii,
                     const MonteCarloSettings& settings,
                     const Progress& progress,
                     Json& figures) {
    std::vector<ProfileRing> rings;
    if (stack.depth() > 0.0) {
        for (const double radius : radii) {
            // Without sigma_s' there is no shortest radius, and nothing to see.
            ProfileRing ring = ring_around(stack, radius);
            if (!(ring.outer_mm > 0.0)) ring.outer_mm = 1e-9;
            rings.push_back(ring);
        }
    } else {
        rings.resize(radii.size());
        for (ProfileRing& ring : rings) ring.outer_mm = 1.0;
    }
    const MonteCarloProfile profile = monte_carlo_profile(stack, rings, settings, progress);
    figures["model"] = "montecarlo";
    figures["radii_mm"] = radii;
    const auto tell = [&](const char* name, const std::vector<Estimate>& estimates) {
        Json values = Json::array(), errors = Json::array();
        for (const Estimate& one : estimates) {
            values.push_back(one.value);
            errors.push_back(one.standard_error);
        }
        figures[name] = values;
        figures[std::string(name) + "_se"] = errors;
    };
    tell("rd", profile.rd);
    if (stack.is_slab()) tell("rt", profile.rt);
    figures["total_reflectance"] = profile.total_reflectance.value;
    figures["total_reflectance_se"] = profile.total_reflectance.standard_error;
    figures["total_transmittance"] = profile.total_transmittance.value;
    figures["total_transmittance_se"] = profile.total_transmittance.standard_error;
    figures["absorbed"] = profile.absorbed.value;
    figures["photons"] = profile.photons;
    figures["seed"] = settings.seed;
}

void run_model(const std::string& name,
               const ScatteringStack& stack,
               const std::vector<double>& radii,
               Json& figures) {
    const bool best = name == "best";
    const SubsurfaceModel model = best ? kBestSubsurfaceModel : *find_subsurface_model(name);
    // Of one medium each model is what it says, and refuses what it is not for.
    const SubsurfaceProfile profile = stack.layers.size() == 1
                                          ? subsurface_profile(model, stack.layers.front())
                                          : subsurface_profile(model, stack);
    figures["model"] = info_of(model).name;
    if (best) {
        figures["asked"] = "best";
        figures["why"] = why_best(stack);
    }
    figures["radii_mm"] = radii;
    Json rd = Json::array(), rt = Json::array();
    for (const double radius : radii) {
        rd.push_back(profile.reflectance(radius));
        if (stack.is_slab()) rt.push_back(profile.transmittance(radius));
    }
    figures["rd"] = rd;
    if (stack.is_slab()) figures["rt"] = rt;
    figures["total_reflectance"] = profile.totals.reflectance;
    figures["total_transmittance"] = profile.totals.transmittance;
    const UnscatteredLight unscattered = unscattered_light(stack);
    figures["absorbed"] = 1.0 - profile.totals.reflectance - profile.totals.transmittance -
                          unscattered.transmitted - unscattered.reflected;
    Json notes = Json::array();
    if (profile.was_negative) {
        notes.push_back("the model is below 0 in places, given as 0: the albedo is too low for it");
    }
    const DiffuseTotals exact = exact_totals(stack);
    const double off = std::max(std::abs(profile.totals.reflectance - exact.reflectance),
                                std::abs(profile.totals.transmittance - exact.transmittance));
    if (off > 0.02) {
        notes.push_back(
            fmt::format("its totals are off: {:.4f} of what enters is reflected and "
                        "{:.4f} comes through",
                        exact.reflectance,
                        exact.transmittance));
    }
    if (!notes.empty()) figures["notes"] = notes;
}

Json json_of(const MediumErrors& errors) {
    Json models = Json::array();
    for (const ModelError& error : errors.models) {
        models.push_back({{"name", info_of(error.model).name},
                          {"rd_l1", error.reflectance_l1},
                          {"total_reflectance_bias", error.reflectance_bias},
                          {"rd_rms_ln", error.rms_ln},
                          {"rt_l1", errors.is_slab ? Json(error.transmittance_l1) : Json(nullptr)},
                          {"was_negative", error.was_negative}});
    }
    return {{"name", errors.name},
            {"best", info_of(kBestSubsurfaceModel).name},
            {"noise_l1", errors.noise_l1},
            {"models", models}};
}

/// Every model of media, or of layers, against Monte Carlo; `mark` is the table's in the file.
template <typename Named>
Outcome compare(const std::vector<Named>& all,
                const std::string& markdown,
                const char* mark,
                const MonteCarloSettings& settings,
                const Progress& progress) {
    if (!markdown.empty()) check_marked_block(markdown, mark);
    std::vector<MediumErrors> found;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto share = [&](std::size_t n) {
            return static_cast<double>(n) / static_cast<double>(all.size());
        };
        found.push_back(model_errors(all[k], settings, progress.part(share(k), share(k + 1))));
    }
    Outcome outcome;
    outcome.figures = {
        {"photons", settings.photons}, {"seed", settings.seed}, {"media", Json::array()}};
    for (const MediumErrors& errors : found) outcome.figures["media"].push_back(json_of(errors));
    outcome.text = markdown_of(found);
    if (!markdown.empty()) replace_marked_block(markdown, mark, markdown_of(found));
    return outcome;
}

}  // namespace

Command bssrdf_command() {
    const auto arguments = std::make_shared<BssrdfArguments>();
    std::vector<std::string> models{"best", "montecarlo"};
    for (const SubsurfaceModelInfo& info : subsurface_models()) models.push_back(info.name);
    Command command;
    command.name = "bssrdf";
    command.summary = "how far from where light enters a translucent medium it leaves again";
    command.example =
        "livery bssrdf --sigma-a 0.0041 --sigma-s 2.62 --eta 1.5 --radii-mm 0.5,1,2,5";
    command.options = medium_options(*arguments);
    const std::vector<Option> own = {
        {"--layers",
         "FILE",
         "translucent layers in the place of one medium (docs/files.md)",
         &arguments->layers},
        {"--model",
         "NAME",
         "a model of docs/subsurface.md, montecarlo, or best: the nearest to Monte Carlo (default "
         "best)",
         &arguments->model,
         false,
         models},
        {"--radii-mm",
         "R1,R2,...",
         "distances from where the light enters (default 0.1,0.2,0.5,1,2,5,10)",
         &arguments->radii},
        {"--photons", "N", "of Monte Carlo (default 1000000)", &arguments->photons},
        {"--compare",
         "",
         "instead of one medium: every model against Monte Carlo in media of all kinds",
         &arguments->compare},
        {"--compare-layers", "", "the same in layers of all kinds", &arguments->compare_layers},
        {"--markdown",
         "FILE",
         "with --compare or --compare-layers: also write the table between the marks in this file",
         &arguments->markdown},
    };
    command.options.insert(command.options.end(), own.begin(), own.end());
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const MonteCarloSettings settings = photons_of(*arguments, common);
        check_argument(!arguments->compare || !arguments->compare_layers,
                       "--compare-layers: found beside --compare, expected one or the other");
        if (arguments->compare) {
            return compare(compared_media(), arguments->markdown, "bssrdf", settings, progress);
        }
        if (arguments->compare_layers) {
            return compare(
                compared_stacks(), arguments->markdown, "bssrdf-layers", settings, progress);
        }
        check_argument(arguments->markdown.empty(),
                       "--markdown: found without --compare or --compare-layers, expected "
                       "with one of them");
        const std::vector<double> radii = parse_radii(arguments->radii);
        const ScatteringStack stack = stack_from(*arguments);
        Outcome outcome;
        if (arguments->model == "montecarlo") {
            run_monte_carlo(stack, radii, settings, progress, outcome.figures);
        } else {
            run_model(arguments->model, stack, radii, outcome.figures);
        }
        tell_medium(stack, !arguments->layers.empty(), outcome);
        outcome.text = text_of(outcome.figures);
        return outcome;
    };
    return command;
}

}  // namespace livery
