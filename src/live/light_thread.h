// Solves light at the vertices beside the thread that draws with it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "live/preview_picture.h"
#include "live/swatches.h"
#include "radiance/light/vertex_light.h"

namespace livery {

/// What one product's picture needs besides its paints and view.
struct SolvedLight {
    std::shared_ptr<const Product> product;
    std::shared_ptr<const VertexLight> light;
    std::shared_ptr<const GroundShadow> ground;
};

/// One thread; the newest request wins, a running one is finished first. `on_change` is called on
/// it after each result.
class LightThread {
  public:
    explicit LightThread(std::function<void()> on_change);
    ~LightThread();
    LightThread(const LightThread&) = delete;
    LightThread& operator=(const LightThread&) = delete;

    void solve(std::shared_ptr<const Product> product,
               std::vector<DirectionalLight> lights,
               std::shared_ptr<const Environment> environment);
    void prepare_swatches();  ///< after what solve() asked for

    struct Results {
        SolvedLight solved;
        std::shared_ptr<const SwatchStudio> swatches;
        std::string problem, swatch_problem;  ///< why there is none
    };
    Results newest() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
