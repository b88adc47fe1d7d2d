// A formula with its parameters, ready for many directions.
#pragma once

#include <memory>

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

}  // namespace livery
