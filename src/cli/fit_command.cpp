// livery fit brdf

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "appearance/fit/fit_brdf.h"
#include "appearance/fit/fit_search.h"
#include "appearance/material_json.h"
#include "appearance/measured/measured_reflectance.h"
#include "appearance/model_table.h"
#include "cli/command.h"

namespace livery {

namespace {

std::vector<BrdfFit> fits_of(const std::string& model,
                             const FitSamples& samples,
                             const ReflectanceFunction& truth,
                             const Progress& progress) {
    if (model == "all") return fit_all_models(samples, truth, progress);
    return {fit_model(find_model(model)->model, samples, truth, {}, progress)};
}

/// "garnet_red" -> "garnet red"
std::string paint_name_of(const std::filesystem::path& file) {
    std::string name = file.stem().string();
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '_' || c == '-'; }, ' ');
    return name;
}

Json figures_of(const BrdfFit& fit) {
    return {{"name", model_info(fit.material.model).name},
            {"parameters", json_of(fit.material)["parameters"]},
            {"error", weighed_error(fit)},
            {"error_log", fit.error_log},
            {"error_de00", fit.difference.de00_mean},
            {"error_de00_p95", fit.difference.de00_p95},
            {"largest_albedo", fit.largest_albedo},
            {"seconds", fit.seconds}};
}

std::string text_of(const std::vector<BrdfFit>& fits) {
    std::string text = fmt::format("{:<22} {:>6} {:>9} {:>6} {:>9} {:>7} {:>8}\n",
                                   "model",
                                   "error",
                                   "CIEDE2000",
                                   "95%",
                                   "log error",
                                   "albedo",
                                   "seconds");
    for (const BrdfFit& fit : fits) {
        text += fmt::format("{:<22} {:>6.2f} {:>9.2f} {:>6.1f} {:>9.3f} {:>7.3f} {:>8.2f}\n",
                            model_info(fit.material.model).name,
                            weighed_error(fit),
                            fit.difference.de00_mean,
                            fit.difference.de00_p95,
                            fit.error_log,
                            fit.largest_albedo,
                            fit.seconds);
    }
    return text + fmt::format("error: {}\n", kWeighedError);
}

}  // namespace

Command fit_brdf_command() {
    struct Arguments {
        std::string measured, model = "all", name, out;
    };
    const auto arguments = std::make_shared<Arguments>();
    std::vector<std::string> models{"all"};
    for (const ModelInfo& info : formula_models()) {
        if (can_be_fitted(info)) models.push_back(info.name);
    }
    Command command;
    command.name = "fit brdf";
    command.summary = "measured reflectance -> a paint of the models' parameters";
    command.example = "livery fit brdf --measured garnet_red.brdf --model all --out paint.json";
    command.options = {
        {"--measured",
         "FILE",
         "measured reflectance: .binary (MERL), .brdf (spectral samples) or .csv",
         &arguments->measured,
         true},
        {"--model",
         "NAME",
         "a model of docs/materials.md, or all: the best is written (default all)",
         &arguments->model,
         false,
         models},
        {"--name", "NAME", "what the paint is called (default: the file's name)", &arguments->name},
        {"--out", "FILE", "the paint, a material file", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const MeasuredReflectance measured = read_measured_file(arguments->measured);
        const ReflectanceFunction truth = [&](const glm::dvec3& wi, const glm::dvec3& wo) {
            return evaluate(measured, wi, wo);
        };
        const FitSamples samples = fit_samples(truth, [&](const DirectionPair& pair) {
            return is_measured(measured, pair.wi, pair.wo);
        });
        const std::vector<BrdfFit> fits = fits_of(arguments->model, samples, truth, progress);
        Material paint = fits.front().material;
        paint.name = arguments->name.empty() ? paint_name_of(arguments->measured) : arguments->name;
        paint.family = "measured";
        paint.provenance = fmt::format(
            "fitted to the {} of {}: CIEDE2000 {:.2f} in the mean over a lit sphere, {:.1f} for "
            "95% "
            "of it",
            name_of(measured.format),
            std::filesystem::path(arguments->measured).filename().string(),
            fits.front().difference.de00_mean,
            fits.front().difference.de00_p95);
        write_material_file(arguments->out, paint);
        Outcome outcome;
        outcome.figures = {{"models", Json::array()},
                           {"error_is", kWeighedError},
                           {"samples", samples.pairs.size()},
                           {"file", arguments->out}};
        for (const BrdfFit& fit : fits) outcome.figures["models"].push_back(figures_of(fit));
        outcome.text = text_of(fits) +
                       fmt::format("wrote {} ({})\n", arguments->out, model_info(paint.model).name);
        return outcome;
    };
    return command;
}

}  // namespace livery
