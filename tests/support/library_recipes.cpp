#include "support/library_recipes.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "appearance/measured_reflectance.h"
#include "core/colour.h"
#include "support/merl_fits.h"

namespace livery {

namespace {

constexpr const char* kStated = "CIEDE2000 ";

template <typename Fit>
RecipeTruth truth_of_fit(const Fit& fit) {
    RecipeTruth truth;
    truth.value_working = [fit](const glm::dvec3& wi, const glm::dvec3& wo) {
        return working_from_rec709() * evaluate(fit, wi, wo);
    };
    truth.samples = fit_samples(truth.value_working, [&](const DirectionPair& pair) {
        const glm::dvec3 value = evaluate(fit, pair.wi, pair.wo);
        return std::min({value.x, value.y, value.z}) >= 0.0;
    });
    return truth;
}

std::string describe_cornell(const std::string& name) {
    if (name == "garnet_red") return "Garnet Red, automotive paint of medium gloss";
    if (name == "cayman") return "Cayman Metallic, automotive paint of high gloss";
    if (name == "krylon_blue") return "Krylon True Blue enamel under a frosting overcoat";
    throw std::invalid_argument("no Cornell paint '" + name + "'");
}

}  // namespace

const std::vector<LibraryRecipe>& library_recipes() {
    using enum PaintSource;
    using enum ReflectanceModel;
    static const std::vector<ReflectanceModel> coated{ggx, clearcoat};
    static const std::vector<ReflectanceModel> bare{ggx, ggx_multiscatter};
    static const std::vector<ReflectanceModel> flakes{clearcoat};
    static const std::vector<LibraryRecipe> recipes{
        {"wine red", "solid", cornell, "garnet_red", coated},
        {"cayman", "metallic", cornell, "cayman", flakes},
        {"frosted blue", "matte", cornell, "krylon_blue", coated},
        {"dark blue", "solid", sgd, "dark-blue-paint", coated},
        {"dark red", "solid", sgd, "dark-red-paint", coated},
        {"light red", "solid", sgd, "light-red-paint", coated},
        {"orange", "solid", abc, "orange-paint", coated},
        {"purple", "solid", sgd, "purple-paint", coated},
        {"white", "solid", abc, "white-paint", coated},
        {"yellow", "solid", sgd, "yellow-paint", coated},
        {"green latex", "matte", sgd, "green-latex", coated},
        {"blue-metallic-paint", "metallic", sgd, "blue-metallic-paint", flakes},
        {"blue-metallic-paint2", "metallic", sgd, "blue-metallic-paint2", flakes},
        {"green-metallic-paint", "metallic", sgd, "green-metallic-paint", flakes},
        {"green-metallic-paint2", "metallic", sgd, "green-metallic-paint2", flakes},
        {"gold-metallic-paint", "metallic", sgd, "gold-metallic-paint", flakes},
        {"gold-metallic-paint2", "metallic", sgd, "gold-metallic-paint2", flakes},
        {"gold-metallic-paint3", "metallic", sgd, "gold-metallic-paint3", flakes},
        {"red-metallic-paint", "metallic", sgd, "red-metallic-paint", flakes},
        {"silver-metallic-paint", "metallic", sgd, "silver-metallic-paint", flakes},
        {"silver-metallic-paint2", "metallic", sgd, "silver-metallic-paint2", flakes},
        {"color-changing-paint1", "pearl", sgd, "color-changing-paint1", flakes},
        {"color-changing-paint2", "pearl", sgd, "color-changing-paint2", flakes},
        {"color-changing-paint3", "pearl", sgd, "color-changing-paint3", flakes},
        {"pearl-paint", "pearl", sgd, "pearl-paint", flakes},
        {"gold-paint", "metallic", sgd, "gold-paint", flakes},
        {"silver-paint", "metallic", sgd, "silver-paint", flakes},
        {"two-layer-gold", "metallic", sgd, "two-layer-gold", flakes},
        {"two-layer-silver", "metallic", sgd, "two-layer-silver", flakes},
        {"red plastic", "plastic", sgd, "red-plastic", coated},
        {"green plastic", "plastic", sgd, "green-plastic", coated},
        {"yellow plastic", "plastic", sgd, "yellow-plastic", coated},
        {"grey plastic", "plastic", sgd, "gray-plastic", coated},
        {"pink plastic", "plastic", sgd, "pink-plastic", coated},
        {"matte yellow plastic", "plastic", sgd, "yellow-matte-plastic", coated},
        {"soft black plastic", "plastic", sgd, "black-soft-plastic", coated},
        {"blue acrylic", "plastic", sgd, "blue-acrylic", coated},
        {"white acrylic", "plastic", sgd, "white-acrylic", coated},
        {"violet acrylic", "plastic", sgd, "violet-acrylic", coated},
        {"specular-black-phenolic", "plastic", sgd, "specular-black-phenolic", coated},
        {"specular-red-phenolic", "plastic", sgd, "specular-red-phenolic", coated},
        {"specular-white-phenolic", "plastic", sgd, "specular-white-phenolic", coated},
        {"neoprene", "rubber", sgd, "neoprene-rubber", coated},
        {"blue rubber", "rubber", sgd, "blue-rubber", coated},
        {"natural rubber", "rubber", sgd, "pure-rubber", coated},
        {"violet rubber", "rubber", sgd, "violet-rubber", coated},
        {"chrome", "chrome", sgd, "chrome", bare},
        {"chrome-steel", "chrome", sgd, "chrome-steel", bare},
        {"nickel", "chrome", sgd, "nickel", bare},
        {"brass", "chrome", sgd, "brass", bare},
        {"aluminium", "chrome", sgd, "aluminium", bare},
        {"ss440", "chrome", sgd, "ss440", bare},
        {"tungsten-carbide", "chrome", sgd, "tungsten-carbide", bare},
        {"alum-bronze", "chrome", sgd, "alum-bronze", bare},
        {"black glass", "glass", sgd, "black-obsidian", coated},
    };
    return recipes;
}

RecipeTruth truth_of(const LibraryRecipe& recipe, const std::filesystem::path& reference_data) {
    const std::string name = recipe.source_name;
    RecipeTruth truth;
    switch (recipe.source) {
        case PaintSource::sgd:
            truth = truth_of_fit(fit_named(
                read_sgd_fits(reference_data / "materials/sgd_bagher2012_merl.csv"), name));
            truth.origin = "by Bagher, Soler and Holzschuch's parameters (2012)";
            break;
        case PaintSource::abc:
            truth = truth_of_fit(
                fit_named(read_abc_fits(reference_data / "materials/abc_low2012_merl.csv"), name));
            truth.origin = "by Low, Kronander, Ynnerman and Unger's parameters (2012)";
            break;
        case PaintSource::cornell: {
            const auto measured = std::make_shared<const MeasuredReflectance>(
                read_measured_file(reference_data / "paint" / (name + ".brdf")));
            truth.value_working = [measured](const glm::dvec3& wi, const glm::dvec3& wo) {
                return evaluate(*measured, wi, wo);
            };
            truth.samples = fit_samples(truth.value_working, [&](const DirectionPair& pair) {
                return is_measured(*measured, pair.wi, pair.wo);
            });
            truth.origin = fmt::format(
                "measured: {}, at 31 wavelengths by the Cornell Light Measurement Laboratory",
                describe_cornell(name));
            return truth;
        }
    }
    truth.origin = fmt::format(
        "measured: '{}' of the MERL database (Matusik, Pfister, Brand and McMillan 2003) {}",
        name,
        truth.origin);
    return truth;
}

std::string stated_error(const ReflectanceDifference& difference) {
    return fmt::format("{}{:.2f} in the mean over a lit sphere, {:.1f} for 95% of it",
                       kStated,
                       difference.de00_mean,
                       difference.de00_p95);
}

double stated_mean_of(const std::string& provenance) {
    const auto at = provenance.find(kStated);
    if (at == std::string::npos) return -1.0;
    return std::stod(provenance.substr(at + std::string(kStated).size()));
}

}  // namespace livery
