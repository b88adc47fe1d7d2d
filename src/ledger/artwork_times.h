// What artwork costs: each kind over the car's body.
#pragma once

#include <string>
#include <vector>

#include "ledger/level.h"
#include "radiance/renderer.h"

namespace livery {

struct ArtworkTimes {
    std::vector<LedgerLevel> frames;  ///< a frame with it, less the same without; ms
    std::vector<double> cover_ms;     ///< solving where one lies
    std::vector<double> relief_ms;    ///< tilting the body's normals
    double body_fragments = 0.0;
};

/// `renderer` draws the scene, which has a body and no artwork, and has drawn it before.
ArtworkTimes measure_artwork(RadianceRenderer& renderer,
                             const Scene& scene,
                             const EffectLevels& levels,
                             const Progress& progress);

}  // namespace livery
