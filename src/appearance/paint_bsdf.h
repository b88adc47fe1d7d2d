// A material ready to be evaluated in float, whether it is a formula's or a measurement's.
#pragma once

#include <memory>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"

namespace livery {

/// One paint's functions, what does not depend on directions taken once. All const functions may
/// run on several threads at once.
template <typename Real, typename Vec3>
struct BoundBsdf {
    virtual ~BoundBsdf() = default;
    virtual Vec3 eval(const Vec3& wi, const Vec3& wo) const = 0;
    virtual Vec3 sample(const Vec3& wo, const Vec3& u) const = 0;
    virtual Real pdf(const Vec3& wi, const Vec3& wo) const = 0;
};
/// A paint's copies share it: it may be bound for thousands of points of a path.
template <typename Real, typename Vec3>
using BoundBsdfPointer = std::shared_ptr<const BoundBsdf<Real, Vec3>>;

struct PaintBsdf {
    ReflectanceModel model = ReflectanceModel::lambert;
    f32::BsdfParameters parameters{};                 ///< of a formula
    BoundBsdfPointer<float, glm::vec3> bound{};       ///< the formula with them
    std::shared_ptr<const MeasuredPaint> measured{};  ///< of ReflectanceModel::measured
};

/// Throws std::invalid_argument for parameters out of range, and for a measured material without
/// its measurement.
PaintBsdf bsdf_of(const Material& material);

/// Values of a material in the working space: a formula's in double, what is measured as it is
/// drawn. Throws as bsdf_of().
ReflectanceFunction reflectance_of(const Material& material);

/// As in bsdf.h.
glm::vec3 evaluate(const PaintBsdf& bsdf, glm::vec3 wi, glm::vec3 wo);
glm::vec3 sample(const PaintBsdf& bsdf, glm::vec3 wo, glm::vec3 u);
float pdf(const PaintBsdf& bsdf, glm::vec3 wi, glm::vec3 wo);
f32::BsdfEnvironment environment_weights(const PaintBsdf& bsdf, float mu);
/// The share of even light from all around that the surface returns, by environment_weights().
glm::vec3 hemispherical_albedo(const PaintBsdf& bsdf);
/// The GGX slope parameter that is about as wide as the main lobe; 1 without a lobe.
float lobe_alpha(const PaintBsdf& bsdf);

}  // namespace livery
