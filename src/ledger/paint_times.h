// What artwork and translucent paints cost: each kind over the car's body, the first frame, and
// each colour after it.
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

struct TranslucentTimes {
    /// One for each level of Effect::subsurface but none: ms.
    std::vector<LedgerLevel> first_frames, swaps;
    /// By level, none included: the pass alone, of a swap. Empty for none.
    std::vector<std::vector<double>> pass_ms;
    double body_fragments = 0.0;
};

/// `renderer` draws the scene, which has a body, and has drawn it before. The body wears marble as
/// if the mock-up were the product, so that light goes as far on it as it does in a hand's size.
TranslucentTimes measure_translucent(RadianceRenderer& renderer,
                                     const Scene& scene,
                                     const EffectLevels& levels,
                                     const Progress& progress);

}  // namespace livery
