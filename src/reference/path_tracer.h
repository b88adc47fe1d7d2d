// (1') the same scene in and image out as radiance/, ground truth: an Embree path tracer.
#pragma once

#include <memory>

#include "core/image.h"
#include "core/progress.h"
#include "reference/projected_light.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

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
