// (1') the same scene in and image out as radiance/, ground truth: an Embree path tracer.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

/// How light is found at a scattering. All three have the same mean; `combined` weighs the other
/// two by the balance heuristic (Veach 1997) and is the one to use. Lights without a disc can only
/// be found as lights.
enum class ReferenceSampling { combined, lights, reflectance };

struct ReferenceOptions {
    int samples_per_pixel = 64;  ///< stops here,
    double seconds = 0.0;        ///< or after this long when > 0, at a whole sample
    int bounces = 0;             ///< scatterings after the first: 0 is direct light only
    std::uint64_t seed = 1;
    bool shade_for_eye = true;  ///< as radiance/ does; false: for the view's own centre
    ReferenceSampling sampling = ReferenceSampling::combined;
};

struct ReferenceResult {
    ImageF radiance_working;  ///< R, G, B, coverage as RadianceRenderer::read_back
    ImageF standard_error;    ///< of the mean luminance, one channel; infinite below two samples
    int samples_per_pixel = 0;
    double seconds = 0.0;
};

/// Progressive, multiple importance sampling of lights, environment and reflectance. The result
/// depends on the options alone, not on the number of threads. Throws std::invalid_argument on a
/// scene whose materials do not match its parts and on options out of range.
ReferenceResult trace_reference(const Scene& scene,
                                const View& view,
                                const ReferenceOptions& options,
                                const Progress& progress = {});

}  // namespace livery
