#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/error.h"
#include "live/preview_thread.h"
#include "tracing/tracer.h"

namespace livery {

struct PartPicker::State {
    std::shared_ptr<const Product> product;
    std::optional<Tracer> tracer;  ///< made for the first click: nobody waits for it at the start
};

PartPicker::PartPicker(std::shared_ptr<const Product> product) {
    check_argument(product != nullptr, "picking parts needs a product");
    state_ = std::make_unique<State>();
    state_->product = std::move(product);
}

PartPicker::~PartPicker() = default;

std::optional<int> PartPicker::part_at(const View& view, const glm::dvec2& pixel) const {
    const auto point = point_at(view, pixel);
    return point ? std::optional(point->part) : std::nullopt;
}

std::optional<PickedPoint> PartPicker::point_at(const View& view, const glm::dvec2& pixel) const {
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < view.width && pixel.y < view.height)) {
        return std::nullopt;
    }
    const Ray ray = ray_through(view, pixel);
    TraceRay traced;
    traced.origin = glm::vec3(ray.origin);
    traced.direction = glm::vec3(ray.direction);
    const Mesh& mesh = state_->product->mesh;
    if (!state_->tracer) state_->tracer.emplace(mesh);
    const Hit hit = state_->tracer->closest(traced);
    if (!hit.valid()) return std::nullopt;
    const SurfacePoint surface = surface_point(mesh, hit);
    PickedPoint point{
        surface.part, glm::dvec3(surface.position_mm), glm::normalize(glm::dvec3(surface.normal))};
    // An open surface is seen from both sides.
    if (glm::dot(surface.geometric_normal, traced.direction) > 0.0f) point.normal = -point.normal;
    return point;
}

}  // namespace livery
