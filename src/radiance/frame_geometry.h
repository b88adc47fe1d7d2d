// What a product and a view fix, whatever it is painted and lit with.
#pragma once

#include <memory>

#include "core/progress.h"
#include "radiance/light/interreflection.h"
#include "radiance/subsurface/subsurface_transport.h"
#include "radiance/surface_map.h"
#include "scene/effects.h"
#include "scene/product.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

/// Rays a pixel of the surface map that a level is worth: few for the first picture of a pose.
int sub_samples_of(const EffectLevels& levels);
int sub_samples_of(Quality quality);

/// What a product and a view fix, whatever it is painted and lit with: rays through the product and
/// its surface map. Immutable: renderers of the same product and view share it.
struct FrameGeometry {
    FrameGeometry(std::shared_ptr<const Product> its_product,
                  const View& its_view,
                  const Progress& progress = {},
                  int sub_samples = 16);
    /// The same product and view with another number of sub-samples.
    FrameGeometry(const FrameGeometry& other, int sub_samples, const Progress& progress = {});

    std::shared_ptr<const Product> product;
    View view;
    std::shared_ptr<const Tracer> tracer;  ///< shared with maps of other numbers of sub-samples
    SurfaceMap map;
    std::shared_ptr<SharedExchange> exchange;      ///< the same
    std::shared_ptr<SharedTransports> transports;  ///< the same
    double ms = 0.0;                               ///< that making it took
    double tracer_ms = 0.0;                        ///< of it: the tree of the product's triangles
};

}  // namespace livery
