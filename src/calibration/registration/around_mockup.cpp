#include "calibration/registration/around_mockup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

namespace {

constexpr double kFound_px = 0.5;
constexpr int kEvery = 3;  // pixels along an edge

bool meets(const Tracer& tracer, const Rigid3& now_from_then, const Ray& ray) {
    TraceRay trace;
    trace.origin = glm::vec3(now_from_then * ray.origin);
    trace.direction = glm::vec3(now_from_then.rotation * ray.direction);
    return tracer.occluded(trace);
}

/// A border of a stripe as the map had it: between the pixel before the edge and that after it.
struct MappedEdge {
    glm::dvec2 projector_px{0.0}, camera_px{0.0};
    double camera_px_per_px = 0.0;  ///< across the stripes
    bool rising = false;
};

std::vector<MappedEdge> mapped_edges(const StripeCode& code, const ImageF& around) {
    std::vector<MappedEdge> edges;
    for (std::size_t k = 0; k < code.edges.size(); ++k) {
        const int edge = code.edges[k], length = code.rows ? code.width : code.height;
        for (int along = kEvery / 2; along < length; along += kEvery) {
            const int x = code.rows ? along : edge, y = code.rows ? edge : along;
            const float* after = around.pixel(x, y);
            const float* before = around.pixel(x - (code.rows ? 0 : 1), y - (code.rows ? 1 : 0));
            if (!std::isfinite(after[0]) || !std::isfinite(before[0])) continue;
            MappedEdge one;
            one.projector_px = code.rows ? glm::dvec2(x + 0.5, y) : glm::dvec2(x, y + 0.5);
            const glm::dvec2 a(before[0], before[1]), b(after[0], after[1]);
            one.camera_px = 0.5 * (a + b);
            one.camera_px_per_px = glm::length(b - a);
            one.rising = k % 2 == 0;
            edges.push_back(one);
        }
    }
    return edges;
}

}  // namespace

AroundEvidence evidence_around(const Mesh& mesh,
                               const Tracer& tracer,
                               const ReposeInput& input,
                               const StripeSight& sight,
                               const Rigid3& then_from_now) {
    AroundEvidence evidence;
    const StripeCode& code = input.code;
    const ImageF& around = input.around;
    if (around.empty()) return evidence;
    check_argument(around.width == code.width && around.height == code.height &&
                       around.channels == 2 && !mesh.triangles.empty(),
                   "what is around the mock-up is not two channels of the projector's size");
    const Rigid3 now_from_then = inverse(then_from_now);
    std::size_t still = 0;
    for (const MappedEdge& edge : mapped_edges(code, around)) {
        const auto lit = find_ray(input.projector, edge.projector_px);
        const auto seen = find_ray(input.camera, edge.camera_px);
        if (!lit || !seen) continue;
        // Nor where the mock-up stood: the map is nearly its own there.
        if (meets(tracer, now_from_then, *lit) || meets(tracer, now_from_then, *seen) ||
            meets(tracer, {}, *lit) || meets(tracer, {}, *seen))
            continue;
        const double stripe_px = code.mean_stripe_px() * edge.camera_px_per_px;
        if (stripe_px < 3.0) continue;  // the camera does not part them
        const double within_px = std::max(2.0, 0.4 * stripe_px);
        ++evidence.places;
        const double offset = sight.offset_of(edge.camera_px, edge.rising, within_px);
        still += std::abs(offset) < kFound_px;
    }
    if (evidence.places == 0) return evidence;
    const auto count = static_cast<double>(evidence.places);
    evidence.still_share = static_cast<double>(still) / count;
    return evidence;
}

void check_pair(const AroundEvidence& around) {
    if (around.places < kLeastAround || around.still_share >= 0.5) return;
    throw Refused(
        fmt::format("of what stands around the mock-up only {:.0f}% is seen where it was: camera "
                    "or projector moved too, or all that the mock-up stands on",
                    100.0 * around.still_share),
        "let everything stand still, and photograph the geometry again");
}

}  // namespace livery
