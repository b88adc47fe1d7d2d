#include "support/library_recipes.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "appearance/measured/measured_reflectance.h"
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
    static const std::vector<ReflectanceModel> flakes{clearcoat, car_paint};
    static const std::vector<LibraryRecipe> recipes{
        {"wine red", "solid", cornell, "garnet_red", coated},
        {"satin raspberry", "solid", sgd, "purple-paint", coated},
        {"satin white", "solid", abc, "white-paint", coated},
        {"frosted blue", "matte", cornell, "krylon_blue", coated},
        {"matte dark blue", "matte", sgd, "dark-blue-paint", coated},
        {"matte dark red", "matte", sgd, "dark-red-paint", coated},
        {"matte red", "matte", sgd, "light-red-paint", coated},
        {"matte orange", "matte", abc, "orange-paint", coated},
        {"matte yellow", "matte", sgd, "yellow-paint", coated},
        {"matte sage", "matte", sgd, "green-latex", coated},
        {"teal metallic", "metallic", cornell, "cayman", flakes, 20},
        {"violet metallic", "metallic", sgd, "blue-metallic-paint", flakes},
        {"midnight metallic", "metallic", sgd, "blue-metallic-paint2", flakes},
        {"sea green metallic", "metallic", sgd, "green-metallic-paint", flakes},
        {"gold metallic", "metallic", sgd, "gold-metallic-paint", flakes, 35},
        {"bronze metallic", "metallic", sgd, "gold-metallic-paint3", flakes},
        {"dark red metallic", "metallic", sgd, "red-metallic-paint", flakes},
        {"graphite metallic", "metallic", sgd, "silver-metallic-paint", flakes},
        {"grey silver metallic", "metallic", sgd, "silver-metallic-paint2", flakes},
        {"soft gold", "metallic", sgd, "gold-paint", flakes},
        {"two-coat silver", "metallic", sgd, "two-layer-silver", flakes},
        {"cream pearl", "pearl", sgd, "pearl-paint", flakes},
        {"rose pearl", "pearl", sgd, "two-layer-gold", flakes},
        {"black violet pearl", "pearl", sgd, "color-changing-paint1", flakes},
        {"black rose pearl", "pearl", sgd, "color-changing-paint2", flakes},
        {"red plastic", "plastic", sgd, "red-plastic", coated},
        {"green plastic", "plastic", sgd, "green-plastic", coated},
        {"grey plastic", "plastic", sgd, "gray-plastic", coated},
        {"soft black plastic", "plastic", sgd, "black-soft-plastic", coated},
        {"blue acrylic", "plastic", sgd, "blue-acrylic", coated},
        {"white acrylic", "plastic", sgd, "white-acrylic", coated},
        {"red phenolic", "plastic", sgd, "specular-red-phenolic", coated},
        {"blue rubber", "rubber", sgd, "blue-rubber", coated},
        {"neoprene", "rubber", sgd, "neoprene-rubber", coated},
        {"chrome steel", "chrome", abc, "chrome-steel", bare},
        {"polished brass", "chrome", sgd, "brass", bare},
        {"stainless steel", "chrome", abc, "ss440", bare},
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
