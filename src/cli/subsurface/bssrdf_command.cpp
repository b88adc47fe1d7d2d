// livery bssrdf

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "appearance/subsurface/model_errors.h"
#include "appearance/subsurface/translucent_material.h"
#include "cli/command.h"
#include "cli/subsurface/medium_options.h"
#include "core/text/marked_block.h"

namespace livery {

namespace {

struct BssrdfArguments : MediumArguments {
    std::string model = "best", radii = "0.1,0.2,0.5,1,2,5,10", markdown;
    int photons = 1'000'000;
    bool compare = false;
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

/// What is said of a medium by every model.
void tell_medium(const ScatteringMedium& medium, Outcome& outcome) {
    const UnscatteredLight unscattered = unscattered_light(medium);
    Json& figures = outcome.figures;
    figures["specular"] = unscattered.specular;
    figures["unscattered_transmittance"] = unscattered.transmitted;
    figures["unscattered_reflectance"] = unscattered.reflected;
    figures["medium"] = {{"sigma_a_per_mm", medium.sigma_a_per_mm},
                         {"sigma_s_per_mm", medium.sigma_s_per_mm},
                         {"sigma_s_prime_per_mm", medium.sigma_s_prime()},
                         {"g", medium.g},
                         {"eta", medium.eta}};
    if (medium.thickness_mm) figures["medium"]["thickness_mm"] = *medium.thickness_mm;
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

void run_monte_carlo(const ScatteringMedium& medium,
                     const std::vector<double>& radii,
                     const MonteCarloSettings& settings,
                     const Progress& progress,
                     Json& figures) {
    std::vector<ProfileRing> rings;
    if (medium.sigma_t() > 0.0) {
        for (const double radius : radii) {
            // Without sigma_s' there is no shortest radius, and nothing to see.
            ProfileRing ring = ring_around(medium, radius);
            if (!(ring.outer_mm > 0.0)) ring.outer_mm = 1e-9;
            rings.push_back(ring);
        }
    } else {
        rings.resize(radii.size());
        for (ProfileRing& ring : rings) ring.outer_mm = 1.0;
    }
    const MonteCarloProfile profile = monte_carlo_profile(medium, rings, settings, progress);
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
    if (medium.thickness_mm) tell("rt", profile.rt);
    figures["total_reflectance"] = profile.total_reflectance.value;
    figures["total_reflectance_se"] = profile.total_reflectance.standard_error;
    figures["total_transmittance"] = profile.total_transmittance.value;
    figures["total_transmittance_se"] = profile.total_transmittance.standard_error;
    figures["absorbed"] = profile.absorbed.value;
    figures["photons"] = profile.photons;
    figures["seed"] = settings.seed;
}

void run_model(const std::string& name,
               const ScatteringMedium& medium,
               const std::vector<double>& radii,
               Json& figures) {
    const bool best = name == "best";
    const ModelChoice choice =
        best ? best_model(medium) : ModelChoice{*find_subsurface_model(name), ""};
    const SubsurfaceProfile profile = subsurface_profile(choice.model, medium);
    figures["model"] = info_of(choice.model).name;
    if (best) {
        figures["asked"] = "best";
        figures["why"] = choice.why;
    }
    figures["radii_mm"] = radii;
    Json rd = Json::array(), rt = Json::array();
    for (const double radius : radii) {
        rd.push_back(profile.reflectance(radius));
        if (medium.thickness_mm) rt.push_back(profile.transmittance(radius));
    }
    figures["rd"] = rd;
    if (medium.thickness_mm) figures["rt"] = rt;
    figures["total_reflectance"] = profile.totals.reflectance;
    figures["total_transmittance"] = profile.totals.transmittance;
    const UnscatteredLight unscattered = unscattered_light(medium);
    figures["absorbed"] = 1.0 - profile.totals.reflectance - profile.totals.transmittance -
                          unscattered.transmitted - unscattered.reflected;
    Json notes = Json::array();
    if (profile.was_negative) {
        notes.push_back("the model is below 0 in places, given as 0: the albedo is too low for it");
    }
    const DiffuseTotals exact = exact_totals(medium);
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
        models.push_back(
            {{"name", info_of(error.model).name},
             {"rd_l1", error.reflectance_l1},
             {"total_reflectance_bias", error.reflectance_bias},
             {"rd_rms_ln", error.rms_ln},
             {"rt_l1", errors.medium.thickness_mm ? Json(error.transmittance_l1) : Json(nullptr)},
             {"was_negative", error.was_negative}});
    }
    return {{"name", errors.name},
            {"best", errors.best},
            {"noise_l1", errors.noise_l1},
            {"models", models}};
}

Outcome compare(const BssrdfArguments& arguments,
                const MonteCarloSettings& settings,
                const Progress& progress) {
    if (!arguments.markdown.empty()) check_marked_block(arguments.markdown, "bssrdf");
    std::vector<MediumErrors> all;
    const auto& media = compared_media();
    for (std::size_t k = 0; k < media.size(); ++k) {
        const auto share = [&](std::size_t n) {
            return static_cast<double>(n) / static_cast<double>(media.size());
        };
        all.push_back(model_errors(media[k], settings, progress.part(share(k), share(k + 1))));
    }
    Outcome outcome;
    outcome.figures = {
        {"photons", settings.photons}, {"seed", settings.seed}, {"media", Json::array()}};
    for (const MediumErrors& errors : all) outcome.figures["media"].push_back(json_of(errors));
    outcome.text = markdown_of(all);
    if (!arguments.markdown.empty()) {
        replace_marked_block(arguments.markdown, "bssrdf", markdown_of(all));
    }
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
         &arguments->radii,
         false,
         {}},
        {"--photons", "N", "of Monte Carlo (default 1000000)", &arguments->photons, false, {}},
        {"--compare",
         "",
         "instead of one medium: every model against Monte Carlo in media of all kinds",
         &arguments->compare,
         false,
         {}},
        {"--markdown",
         "FILE",
         "with --compare: also write the table between the marks in this file",
         &arguments->markdown,
         false,
         {}},
    };
    command.options.insert(command.options.end(), own.begin(), own.end());
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const MonteCarloSettings settings = photons_of(*arguments, common);
        if (arguments->compare) return compare(*arguments, settings, progress);
        check_argument(arguments->markdown.empty(),
                       "--markdown: found without --compare, expected "
                       "with it");
        const std::vector<double> radii = parse_radii(arguments->radii);
        const ScatteringMedium medium = medium_from(*arguments);
        Outcome outcome;
        if (arguments->model == "montecarlo") {
            run_monte_carlo(medium, radii, settings, progress, outcome.figures);
        } else {
            run_model(arguments->model, medium, radii, outcome.figures);
        }
        tell_medium(medium, outcome);
        outcome.text = text_of(outcome.figures);
        return outcome;
    };
    return command;
}

}  // namespace livery
