// (1') the same scene in and image out as radiance/, ground truth: an Embree path tracer, and what
// the samples of one pixel say.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "reference/light_sampling.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// Sums over the samples that met the product. Samples of a pixel are points of one well-spread
/// sequence, so that their own scatter says far too much of their mean's error; that of the means
/// of 8 to 16 batches of consecutive samples, each as well spread in itself, says only a little too
/// much. Batches start as single samples and are joined in pairs as they fill up.
struct PixelEstimate {
    static constexpr std::uint32_t kBatches = 16;

    glm::dvec3 colour_sum{0.0};
    std::uint32_t traced = 0, covered = 0;
    std::uint32_t batch_length = 1;
    std::array<std::uint32_t, kBatches> batch_covered{};
    std::array<float, kBatches> batch_luminance{};  ///< sums

    /// One more sample, of a path or (null) beside the product.
    void add(const glm::dvec3* value, double luminance);
};

/// Of the mean luminance of the covered samples.
struct EstimateError {
    double standard_error = 0.0;  ///< infinite below two batches
    double half_width = 0.0;      ///< of the 95% confidence interval (Student's t)
};
EstimateError error_of(const PixelEstimate& estimate);

/// How light is found at a scattering. All three have the same mean; `combined` weighs the other
/// two by the balance heuristic (Veach 1997) and is the one to use. Lights without a disc can only
/// be found as lights.
enum class ReferenceSampling { combined, lights, reflectance };

/// Scatterings after the first that a path is followed for: what is left then is far below what a
/// picture shows, in a groove of albedo .8 some 1e-3.
inline constexpr int kReferenceBounces = 16;

struct ReferenceOptions {
    int samples_per_pixel = 64;  ///< stops here, where nothing below stops it earlier
    double seconds = 0.0;        ///< after this long when > 0, at a whole sample
    /// When > 0: at pixels of which the 95% confidence interval of the luminance, and those of the
    /// pixels around, reach no further than this times the luminance, or than this times .02 of
    /// design white where it is darker, as far as they cover the pixel.
    double error = 0.0;
    int bounces = kReferenceBounces;  ///< scatterings after the first; 0: direct light only
    std::uint64_t seed = 1;
    bool shade_for_eye = true;  ///< as radiance/ does; false: for the view's own centre
    ReferenceSampling sampling = ReferenceSampling::combined;
    std::shared_ptr<const ProjectedLight> projected;  ///< beside the scene's lights; null: none
};

struct ReferenceResult {
    ImageF radiance_working;  ///< R, G, B, coverage as RadianceRenderer::read_back
    /// One channel each, of the mean luminance: infinite below two samples.
    ImageF standard_error;
    ImageF confidence;                 ///< half of its 95% confidence interval
    ImageF samples;                    ///< that each pixel took
    int samples_per_pixel = 0;         ///< the most that any took
    double mean_samples = 0.0;         ///< over covered pixels
    double unresolved_fraction = 0.0;  ///< of covered pixels, that did not reach `error`
    double seconds = 0.0;
};

/// Progressive, multiple importance sampling of lights, environment and reflectance, by
/// Owen-scrambled Sobol points: a power of two of samples a pixel is best. The result depends on
/// the options alone, not on the number of threads, but for `seconds`. Throws std::invalid_argument
/// on a scene whose materials do not match its parts and on options out of range.
ReferenceResult trace_reference(const Scene& scene,
                                const View& view,
                                const ReferenceOptions& options,
                                const Progress& progress = {});

}  // namespace livery
