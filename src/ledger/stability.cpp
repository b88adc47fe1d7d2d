#include "ledger/stability.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "core/worst_error.h"
#include "ledger/reflectance_values.h"

namespace livery {

namespace {

constexpr std::size_t kInputs = 10'000'000, kPairs = 20'000;
constexpr int kAlbedoPoints = 64;

/// At one slope parameter, over the model's anisotropies.
double gpu_error(
    ReflectanceModel model, double alpha, std::size_t pairs_each, GlDevice device, Random& random) {
    double worst = 0.0;
    for (const double stretch : ledger_stretches(model)) {
        const f64::BsdfParameters wide = ledger_parameters(alpha, stretch);
        std::vector<DirectionPair> pairs;
        for (const RoundedPair& pair : ledger_directions(alpha, pairs_each, random)) {
            pairs.push_back({glm::dvec3(pair.wi), glm::dvec3(pair.wo)});
        }
        const auto values = reflectance_on_gpu(model, rounded(wide), pairs, device);
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const glm::dvec3 truth = evaluate(model, wide, pairs[k].wi, pairs[k].wo);
            for (int c = 0; c < 3; ++c) {
                worst = worse_of(worst, relative_error(values[k][c], truth[c]));
            }
        }
    }
    return worst;
}

double worst_in_float(const ModelStability& model) {
    double worst = 0.0;
    for (const PrecisionError& row : model.in_float) worst = worse_of(worst, row.float_worst);
    return worst;
}

double worst_on_gpu(const ModelStability& model) {
    return *std::max_element(model.on_gpu.begin(), model.on_gpu.end());
}

/// Every slope parameter that a model was measured at.
std::set<double> all_alphas(const StabilityLedger& result) {
    std::set<double> alphas;
    for (const ModelStability& model : result.models) {
        for (const PrecisionError& row : model.in_float) alphas.insert(row.alpha);
    }
    return alphas;
}

}  // namespace

StabilityLedger measure_stability(GlDevice device,
                                  bool quick,
                                  std::uint64_t seed,
                                  const Progress& progress) {
    using Clock = std::chrono::steady_clock;
    const std::size_t part = quick ? 100 : 1;
    StabilityLedger result;
    {
        const HeadlessContext context(device);
        result.renderer = context.renderer();
        std::vector<ReflectanceModel> models;
        for (const ModelInfo& info : formula_models()) models.push_back(info.model);
        models.push_back(ReflectanceModel::measured);
        for (const ReflectanceModel model : models) {
            progress.update(0.0, std::string("drawing ") + model_info(model).name);
            const auto start = Clock::now();
            std::vector<DrawnError> rows = drawn_errors(model, quick, seed, progress);
            const double ms =
                std::chrono::duration<double, std::milli>(Clock::now() - start).count();
            for (DrawnError& row : rows) {
                row.ms = ms / static_cast<double>(rows.size());
                result.drawn.push_back(row);
            }
        }
    }
    for (const ModelInfo& info : formula_models()) {
        progress.update(static_cast<double>(result.models.size()) /
                            static_cast<double>(formula_models().size()),
                        info.name);
        const auto start = Clock::now();
        ModelStability& model = result.models.emplace_back();
        model.model = info.model;
        model.in_float = precision_errors(info.model, kPairs / part, seed);
        Random random(seed);
        for (const PrecisionError& row : model.in_float) {
            progress.check_stop();
            model.on_gpu.push_back(gpu_error(info.model, row.alpha, kPairs / part, device, random));
        }
        model.reciprocity = reciprocity_error(info.model, kPairs / part, seed);
        model.albedo = worst_albedo(info.model, quick ? 24 : kAlbedoPoints);
        progress.check_stop();
        model.invalid = count_invalid(info.model, kInputs / part, seed);
        model.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    }
    return result;
}

std::vector<LedgerEffect> effects_of(const StabilityLedger& result) {
    std::vector<LedgerEffect> effects = effects_of(result.drawn);
    for (const ModelStability& model : result.models) {
        LedgerEffect& effect = effects.emplace_back();
        effect.name = fmt::format("reflectance: {}", model_info(model.model).name);
        const auto add = [&](const std::string& name, double error, const std::string& unit) {
            LedgerLevel& level = effect.levels.emplace_back();
            level.name = name;
            level.ms = level.fastest_ms = model.ms;
            level.repeats = 1;
            level.work_items = static_cast<double>(model.invalid.inputs);
            level.error = error;
            level.unit = unit;
        };
        add("float against double", worst_in_float(model), "relative");
        add("OpenGL against double", worst_on_gpu(model), "relative");
        for (std::size_t k = 0; k < model.in_float.size(); ++k) {
            const PrecisionError& row = model.in_float[k];
            add(fmt::format("float, alpha {:.4g}", row.alpha), row.float_worst, "relative");
            add(fmt::format("OpenGL, alpha {:.4g}", row.alpha), model.on_gpu[k], "relative");
        }
        add("light and eye exchanged", model.reciprocity, "relative");
        add("largest albedo", model.albedo.albedo, "share of the light");
        add("invalid values",
            static_cast<double>(model.invalid.invalid),
            fmt::format("of {} inputs", model.invalid.inputs));
    }
    return effects;
}

std::string markdown_of(const StabilityLedger& result) {
    std::string text = fmt::format("OpenGL: {}.\n\n", result.renderer) + markdown_of(result.drawn);
    text += fmt::format(
        "\nThe models by themselves, {} inputs each:\n\n"
        "| model | float against double | OpenGL against double | light and eye exchanged | "
        "largest albedo | where | claims at most 1 | invalid values |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        result.models.front().invalid.inputs);
    for (const ModelStability& model : result.models) {
        const ModelInfo& info = model_info(model.model);
        text += fmt::format(
            "| `{}` | {:.1e} | {:.1e} | {:.1e} | {:.5f} | {}, cosine {:g} | {} | {} |\n",
            info.name,
            worst_in_float(model),
            worst_on_gpu(model),
            model.reciprocity,
            model.albedo.albedo,
            info.mirrors()
                ? fmt::format(
                      "alpha {:g}, reflectance {:g}", model.albedo.alpha, model.albedo.reflectance)
                : "diffuse",
            model.albedo.mu,
            info.conserves_energy ? "yes" : "no",
            model.invalid.invalid);
    }
    text +=
        "\nWorst relative error at each slope parameter, in float on the processor and in "
        "OpenGL:\n\n"
        "| model |";
    const std::set<double> alphas = all_alphas(result);
    std::string rule = "\n| --- |";
    for (const double alpha : alphas) {
        text += fmt::format(" {:.3g} |", alpha);
        rule += " --- |";
    }
    text += rule + "\n";
    for (const ModelStability& model : result.models) {
        text += fmt::format("| `{}` |", model_info(model.model).name);
        for (const double alpha : alphas) {
            std::string cell = " |";
            for (std::size_t k = 0; k < model.in_float.size(); ++k) {
                if (model.in_float[k].alpha != alpha) continue;
                cell =
                    fmt::format(" {:.1e} {:.1e} |", model.in_float[k].float_worst, model.on_gpu[k]);
            }
            text += cell;
        }
        text += "\n";
    }
    return text;
}

}  // namespace livery
