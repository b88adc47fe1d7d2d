// The paints that come with the program: complete, of told origin, physical, and as near to what
// they were measured from as they say.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/material_library.h"
#include "appearance/model_table.h"
#include "appearance/models.h"
#include "appearance/paint_figures.h"
#include "core/paths.h"
#include "support/library_recipes.h"
#include "support/reference_data.h"

namespace livery {
namespace {

std::vector<Material> shipped() { return read_paint_folder(shipped_path("materials")); }

bool is_measured_origin(const Material& paint) {
    return paint.provenance.starts_with("measured: ");
}

TEST(ShippedLibrary, IsLargeAndOfToldOrigin) {
    const auto paints = shipped();
    EXPECT_GE(paints.size(), 40u);
    EXPECT_GE(std::count_if(paints.begin(), paints.end(), is_measured_origin), 25);
    std::set<std::string> used;
    for (const Material& paint : paints) {
        const auto& families = paint_families();
        EXPECT_TRUE(std::find(families.begin(), families.end(), paint.family) != families.end())
            << paint.name << ": " << paint.family;
        used.insert(paint.family);
        EXPECT_TRUE(is_measured_origin(paint) || paint.provenance.starts_with("designed: "))
            << paint.name << ": " << paint.provenance;
        std::string file = paint.name + ".json";
        std::replace(file.begin(), file.end(), ' ', '-');
        EXPECT_EQ(paint.file.filename(), file);
        EXPECT_LE(paint.name.size(), 24u) << paint.name << " is long under a swatch";
    }
    EXPECT_EQ(used.size(), paint_families().size());
    // The six of the study that the program follows.
    for (const char* paint : {"solid red",
                              "solid green",
                              "solid blue",
                              "silver metallic",
                              "green metallic",
                              "blue metallic"}) {
        EXPECT_EQ(find_material(paint).name, paint);
    }
}

TEST(ShippedLibrary, IsListedByFamily) {
    const auto listed = read_paint_library()->shipped;
    const auto& families = paint_families();
    EXPECT_EQ(listed.front().family, families.front());
    EXPECT_EQ(listed.back().family, families.back());
    for (std::size_t k = 1; k < listed.size(); ++k) {
        const auto place = [&](std::size_t i) {
            return std::find(families.begin(), families.end(), listed[i].family);
        };
        EXPECT_LE(place(k - 1), place(k));
        if (listed[k - 1].family == listed[k].family) {
            EXPECT_LT(listed[k - 1].file, listed[k].file);
        }
    }
}

TEST(ShippedLibrary, HasFiniteFigures) {
    for (const Material& paint : shipped()) {
        const PaintFigures figures = paint_figures(paint);
        for (const glm::dvec3& lab : figures.lab) {
            EXPECT_TRUE(std::isfinite(lab.x + lab.y + lab.z)) << paint.name;
            EXPECT_GE(lab.x, 0.0) << paint.name;
        }
        EXPECT_TRUE(std::isfinite(figures.gloss_20 + figures.gloss_60)) << paint.name;
        EXPECT_GE(std::min(figures.gloss_20, figures.gloss_60), 0.0) << paint.name;
        if (figures.flop) {
            EXPECT_TRUE(std::isfinite(*figures.flop)) << paint.name;
        }
    }
}

TEST(ShippedLibrary, KeepsEnergyWhereTheModelDoes) {
    for (const Material& paint : shipped()) {
        const ModelInfo& model = model_info(paint.model);
        if (!model.conserves_energy) continue;
        const f64::BsdfParameters p = parameters_of_f64(paint);
        for (const double mu : {0.02, 0.1, 0.3, 0.6, 1.0}) {
            for (const double phi : {0.0, 1.5}) {
                const glm::dvec3 albedo =
                    directional_albedo(paint.model, p, direction(mu, phi), 96);
                EXPECT_LE(std::max({albedo.x, albedo.y, albedo.z}), 1.0 + 1e-4)
                    << paint.name << " at " << mu;
            }
        }
    }
}

TEST(ShippedLibrary, HoldsThePaintsOfItsRecipes) {
    std::set<std::string> measured, made;
    for (const Material& paint : shipped()) {
        if (is_measured_origin(paint)) measured.insert(paint.name);
    }
    for (const LibraryRecipe& recipe : library_recipes()) {
        EXPECT_TRUE(made.insert(recipe.name).second) << recipe.name << " twice";
    }
    EXPECT_EQ(measured, made);
}

TEST(ShippedLibrary, IsAsNearToItsMeasurementsAsItSays) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    for (const LibraryRecipe& recipe : library_recipes()) {
        const Material paint = find_material(recipe.name);
        const RecipeTruth truth = truth_of(recipe, data);
        EXPECT_TRUE(paint.provenance.starts_with(truth.origin)) << paint.provenance;
        EXPECT_EQ(paint.family, recipe.family);
        const f64::BsdfParameters p = parameters_of_f64(paint);
        const ReflectanceDifference difference =
            difference_of([&](const glm::dvec3& wi,
                              const glm::dvec3& wo) { return evaluate(paint.model, p, wi, wo); },
                          truth.value_working);
        const double stated = stated_mean_of(paint.provenance);
        EXPECT_GE(stated, 0.0) << paint.provenance;
        EXPECT_NEAR(difference.de00_mean, stated, 0.0051) << paint.name;
        EXPECT_LE(stated, 5.0) << paint.name;
    }
}

}  // namespace
}  // namespace livery
