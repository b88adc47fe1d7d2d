// Fits the library's measured paints anew and writes them into a folder of material files; one that
// is there already and looks as near keeps its parameters:
//   LIVERY_REFERENCE_DATA=<folder> livery_make_library materials [NAME ...]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "appearance/fit/fit_brdf.h"
#include "appearance/model_table.h"
#include "appearance/paint_figures.h"
#include "core/error.h"
#include "support/library_recipes.h"
#include "support/reference_data.h"

namespace livery {
namespace {

BrdfFit best_fit(const LibraryRecipe& recipe, const RecipeTruth& truth) {
    std::vector<BrdfFit> fits;
    for (const ReflectanceModel model : recipe.models) {
        fits.push_back(fit_model(model, truth.samples, truth.value_working, fits));
    }
    // A larger model must be worth it.
    constexpr double kSeen = 0.05;
    BrdfFit best = fits.front();
    for (const BrdfFit& fit : fits) {
        if (fit.difference.de00_mean < best.difference.de00_mean - kSeen) best = fit;
    }
    return best;
}

/// CIEDE2000: what the file rounds to.
constexpr double kAsNear = 0.01;

ReflectanceFunction function_of(const Material& material) {
    return [model = material.model, p = parameters_of_f64(material)](
               const glm::dvec3& wi, const glm::dvec3& wo) { return evaluate(model, p, wi, wo); };
}

/// No table says what flakes a paint has: one layer of discs of that size.
void add_glints(int flake_um, Material& paint) {
    const double radius_mm = 0.5e-3 * flake_um;
    paint.glint_density_per_mm2 =
        std::round(1.0 / (std::numbers::pi * radius_mm * radius_mm) / 100.0) * 100.0;
    paint.provenance +=
        fmt::format("; glints designed: one layer of flakes of {} micrometres", flake_um);
}

void make(const LibraryRecipe& recipe,
          const std::filesystem::path& reference_data,
          const std::filesystem::path& folder) {
    const RecipeTruth truth = truth_of(recipe, reference_data);
    std::string name = recipe.name;
    std::replace(name.begin(), name.end(), ' ', '-');
    const std::filesystem::path file = folder / (name + ".json");

    const BrdfFit fit = best_fit(recipe, truth);
    Material paint = fit.material;
    ReflectanceDifference difference = fit.difference;
    bool stands = false;
    if (std::filesystem::exists(file)) {
        const Material standing = read_material_file(file);
        const ReflectanceDifference its = difference_of(function_of(standing), truth.value_working);
        stands = its.de00_mean <= difference.de00_mean + kAsNear;
        if (stands) {
            paint = standing;
            difference = its;
        }
    }
    paint.name = recipe.name;
    paint.family = recipe.family;
    paint.provenance = fmt::format("{}; fitted to {}", truth.origin, stated_error(difference));
    if (recipe.flake_um > 0) add_glints(recipe.flake_um, paint);
    write_material_file(file, paint);
    const PaintFigures figures = paint_figures(paint);
    const glm::dvec3& face = figures.lab[kFaceAngle];
    std::printf("%-24s %-10s %5.2f %5.1f  %5.1f %5.1f %5.1f  flop %5.2f  gloss %5.1f %5.1f%s\n",
                recipe.name,
                model_info(paint.model).name,
                difference.de00_mean,
                difference.de00_p95,
                face.x,
                face.y,
                face.z,
                figures.flop.value_or(-1.0),
                figures.gloss_20,
                figures.gloss_60,
                stands ? "  (as it was)" : "");
    std::fflush(stdout);
}

int run(const std::vector<std::string>& words) {
    const auto reference = reference_data();
    if (!reference || words.empty()) {
        std::fputs("LIVERY_REFERENCE_DATA=<folder> livery_make_library FOLDER [NAME ...]\n",
                   stderr);
        return 2;
    }
    for (auto name = words.begin() + 1; name != words.end(); ++name) {
        if (std::none_of(library_recipes().begin(),
                         library_recipes().end(),
                         [&](const LibraryRecipe& recipe) { return *name == recipe.name; })) {
            throw std::invalid_argument("no measured paint '" + *name + "' in the library");
        }
    }
    for (const LibraryRecipe& recipe : library_recipes()) {
        const bool chosen = words.size() == 1 ||
                            std::find(words.begin() + 1, words.end(), recipe.name) != words.end();
        if (chosen) make(recipe, *reference, words.front());
    }
    return 0;
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    try {
        return livery::run({argv + 1, argv + argc});
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 2;
    }
}
