#include "radiance/frame_geometry.h"

#include <array>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "radiance/fragment_inputs.h"

namespace livery {

int sub_samples_of(const EffectLevels& levels) {
    constexpr std::array kSubSamples{4, 16, 64};
    return kSubSamples.at(static_cast<std::size_t>(levels[Effect::sub_samples]));
}

int sub_samples_of(Quality quality) { return sub_samples_of(levels_of(quality)); }

FrameGeometry::FrameGeometry(std::shared_ptr<const Product> its_product,
                             const View& its_view,
                             const Progress& progress,
                             int sub_samples)
    : product(std::move(its_product)), view(its_view) {
    check_argument(product != nullptr, "a renderer needs a product");
    const double begin_ms = StageClock::now_ms();
    tracer = std::make_shared<const Tracer>(product->mesh);
    exchange = std::make_shared<SharedExchange>();
    transports = std::make_shared<SharedTransports>();
    tracer_ms = StageClock::now_ms() - begin_ms;
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

FrameGeometry::FrameGeometry(const FrameGeometry& other, int sub_samples, const Progress& progress)
    : product(other.product),
      view(other.view),
      tracer(other.tracer),
      exchange(other.exchange),
      transports(other.transports) {
    const double begin_ms = StageClock::now_ms();
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

}  // namespace livery
