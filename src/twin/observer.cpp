#include "twin/observer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "twin/place.h"

namespace livery {

Observer make_observer(const TracedObserver& traced,
                       Factors factors,
                       const Gathers& gathers,
                       const ImageF& dark) {
    Observer observer;
    const int width = traced.receivers.width, height = traced.receivers.height;
    observer.receivers = {&traced.receivers, std::move(factors)};
    observer.truth.lit = traced.lit;
    observer.truth.edge = traced.edge;
    observer.truth.seen_by_eye = traced.seen_by_eye;
    observer.truth.black_xyz = observe(observer, gathers, dark, true);
    observer.truth.primary_xyz = ImageF(width, height, 9);
    observer.clear_xyz = ImageF(width, height, 3);
    const LightPaths& lists = observer.receivers.traced->paths;
    parallel_for(lists.receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = lists.receiver[i];
            for (std::uint32_t t = lists.term_begin[i]; t < lists.term_begin[i + 1]; ++t) {
                const auto& direct = observer.receivers.factors.direct[lists.terms[t].surface];
                for (std::size_t k = 0; k < direct.size(); ++k) {
                    float* out = k < 3
                                     ? observer.truth.primary_xyz.values.data() + 9 * pixel + 3 * k
                                     : observer.clear_xyz.values.data() + 3 * pixel;
                    for (int c = 0; c < 3; ++c) {
                        out[c] += static_cast<float>(lists.terms[t].weight * direct[k][c]);
                    }
                }
            }
        }
    });
    return observer;
}

ImageF observe(const Observer& observer,
               const Gathers& gathers,
               const ImageF& light,
               bool ambient) {
    ImageF xyz = receive_all(observer.receivers, gathers, light);
    if (ambient) {
        const ImageF room = receive_ambient(observer.receivers);
        for (std::size_t k = 0; k < xyz.values.size(); ++k) xyz.values[k] += room.values[k];
    }
    return xyz;
}

Image8 reachable(const Observer& observer, const ImageF& wanted_xyz, double clear_strength) {
    const ObserverTruth& truth = observer.truth;
    const auto& receiver = observer.receivers.traced->paths.receiver;
    check_argument(wanted_xyz.width == truth.lit.width && wanted_xyz.height == truth.lit.height &&
                       wanted_xyz.channels == 3,
                   fmt::format("bench: a wanted picture of {}x{}x{} where {}x{} pixels are seen",
                               wanted_xyz.width,
                               wanted_xyz.height,
                               wanted_xyz.channels,
                               truth.lit.width,
                               truth.lit.height));
    constexpr double kTolerance = 1e-4;
    Image8 answer(wanted_xyz.width, wanted_xyz.height, 1);
    parallel_for(receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = receiver[i];
            glm::dmat3 xyz_from_light;
            glm::dvec3 wanted, clear;
            for (int c = 0; c < 3; ++c) {
                const auto channel = static_cast<std::size_t>(c);
                wanted[c] = double(wanted_xyz.values[3 * pixel + channel]) -
                            truth.black_xyz.values[3 * pixel + channel];
                clear[c] = clear_strength * observer.clear_xyz.values[3 * pixel + channel];
                for (int k = 0; k < 3; ++k) {
                    xyz_from_light[k][c] =
                        truth.primary_xyz
                            .values[9 * pixel + 3 * static_cast<std::size_t>(k) + channel];
                }
            }
            if (!(std::abs(glm::determinant(xyz_from_light)) > 0.0)) continue;
            const glm::dmat3 light_from_xyz = glm::inverse(xyz_from_light);
            glm::dvec3 light = light_from_xyz * wanted;
            // With a clear segment the light is l = light - m d, where m = min(l) >= 0 is what
            // the channels have in common and d what the segment adds for it, in units of the
            // primaries. min(light - m d) - m falls with m (1 + d > 0), so its root is unique.
            if (clear_strength > 0.0) {
                const glm::dvec3 d = light_from_xyz * clear;
                double common = 1e30;
                for (int k = 0; k < 3; ++k) common = std::min(common, light[k] / (1.0 + d[k]));
                light -= std::max(0.0, common) * d;
            }
            bool inside = true;
            for (int k = 0; k < 3; ++k) {
                inside = inside && light[k] >= -kTolerance && light[k] <= 1.0 + kTolerance;
            }
            answer.values[pixel] = inside ? 255 : 0;
        }
    });
    return answer;
}

Image8 mostly_lit_by(const Observer& observer, const Image8& mask) {
    const LightPaths& paths = observer.receivers.traced->paths;
    Image8 answer(observer.receivers.traced->width, observer.receivers.traced->height, 1);
    for (std::size_t i = 0; i < paths.receiver.size(); ++i) {
        double all = 0.0, from_mask = 0.0;
        for (std::uint32_t t = paths.term_begin[i]; t < paths.term_begin[i + 1]; ++t) {
            const PathTerm& term = paths.terms[t];
            all += term.weight;
            if (mask.values[term.pixel]) from_mask += term.weight;
        }
        if (all > 0.0 && 2.0 * from_mask >= all) answer.values[paths.receiver[i]] = 255;
    }
    return answer;
}

View eye_view(const glm::dvec3& eye_mm, const View& projector, const Mesh& mockup) {
    const Bounds bounds = bounds_of(mockup);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double radius = 0.5 * glm::distance(bounds.low, bounds.high);
    const double distance = glm::distance(eye_mm, middle);
    check_argument(distance > radius, "bench: the eye is inside the mock-up's box");
    const double pixel_mm =
        glm::distance(centre_in_world(projector), middle) / projector.focal_px.x;
    const double focal_px = distance / pixel_mm;

    // A picture that holds the ball around the mock-up, then what the mock-up needs of it.
    constexpr int kLargest = 8192, kMargin = 4;
    const double half = focal_px * radius / std::sqrt(distance * distance - radius * radius);
    const int side = std::min(kLargest, 2 * (static_cast<int>(std::ceil(half)) + kMargin));
    const View whole = look_at(eye_mm, middle, 2.0 * std::atan(0.5 * side / focal_px), side, side);
    const PixelRectangle box = pixels_that_see(whole, mockup, kMargin);
    return cropped(whole, box.left, box.top, box.right - box.left, box.bottom - box.top);
}

}  // namespace livery
