// The reflectance models as data: whatever the program must know of one is a row here, and one
// file of shaders/bsdf.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"

namespace livery {

/// A model's functions in one precision (bsdf.h says what they give).
template <typename Real, typename Vec3, typename Parameters, typename Environment>
struct BsdfFunctions {
    Vec3 (*eval)(const Parameters&, const Vec3& wi, const Vec3& wo);
    Vec3 (*sample)(const Parameters&, const Vec3& wo, const Vec3& u);
    Real (*pdf)(const Parameters&, const Vec3& wi, const Vec3& wo);
    Environment (*environment)(const Parameters&, Real mu);
    BoundBsdfPointer<Real, Vec3> (*bound)(const Parameters&);  ///< for many directions
};
using BsdfFunctionsF32 = BsdfFunctions<float, glm::vec3, f32::BsdfParameters, f32::BsdfEnvironment>;
using BsdfFunctionsF64 =
    BsdfFunctions<double, glm::dvec3, f64::BsdfParameters, f64::BsdfEnvironment>;

/// What a model takes from its parameters once, for shading (NAME_prepare of its shader file).
struct PreparedPaint {
    std::vector<float> numbers;          ///< of the model's struct, in its order
    std::vector<glm::vec2> lobe_slopes;  ///< of each lobe that mirrors, along and across
    std::vector<bool> reflects;          ///< each lobe anything at all: none does with f0 0
};
struct PreparedModel {
    const char* type = nullptr;  ///< the struct, "CarPaintPrepared"; null: shading prepares nothing
    PreparedPaint (*of)(const f32::BsdfParameters&) = nullptr;
};

/// What a model's main lobe is a function of, and which parameter says how wide it is.
enum class Lobe {
    none,            ///< diffuse
    half_alpha,      ///< the half vector; alpha
    half_exponent,   ///< the half vector; exponent, alpha^2 = 2 / (n + 2)
    mirror_exponent  ///< the mirror direction, which turns twice as far as the normal; exponent
};

struct ModelInfo {
    ReflectanceModel model;
    const char* name;      ///< in files: "blinn-phong"
    const char* label;     ///< "Glossy or matte"
    const char* meaning;   ///< a sentence, with the paper
    const char* in_words;  ///< why a plan shades with it: "a paint with one glossy lobe"
    const char* unused;    ///< why a plan does not: "no part uses GGX"
    std::vector<const char*> shaders;  ///< in shaders/bsdf, in the order in which they need another
    std::vector<const char*> parameters;
    Lobe lobe;
    bool anisotropic;          ///< takes pairs of two different numbers
    bool same_from_all_sides;  ///< needs only the sum of all light
    bool reciprocal;           ///< claims the same value with light and eye exchanged
    bool conserves_energy;     ///< claims an albedo of at most 1
    const char* prefix;        ///< of its functions in shaders/bsdf: "blinn_phong"
    BsdfFunctionsF32 f32;
    BsdfFunctionsF64 f64;
    PreparedModel prepared{};

    bool mirrors() const { return lobe != Lobe::none; }  ///< part of the environment
    bool has(const std::string& parameter) const;
};

/// All of them, indexed by ReflectanceModel.
const std::vector<ModelInfo>& model_table();
/// Those that are a formula from light to eye: all but measured and translucent.
std::span<const ModelInfo> formula_models();
const ModelInfo& model_info(ReflectanceModel model);
/// By its name in files; null: none.
const ModelInfo* find_model(const std::string& name);
/// "lambert, ggx, clearcoat"
std::string model_names();

/// The GGX slope parameter that is about as wide as the model's main lobe; 1 without a lobe.
float lobe_alpha(const ModelInfo& model, const f32::BsdfParameters& parameters);
/// How many times further than the normal the lobe turns, squared: the factor of a mean squared
/// slope for bsdf_widen.
double lobe_turn_squared(const ModelInfo& model);

}  // namespace livery
