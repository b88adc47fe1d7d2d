#include "jobs/calibrate/carried_colours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/predict.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "core/time.h"
#include "jobs/captured_calibration.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// What the middle of each projector pixel lights.
struct LitPlaces {
    std::vector<glm::vec3> places;  ///< NaN: nothing of the mesh
    std::vector<glm::vec3> normals;
    ImageF irradiance;  ///< projector_irradiance()
};

LitPlaces lit_places(const Mesh& mesh,
                     const Tracer& tracer,
                     const View& projector,
                     const Progress& progress) {
    const auto width = static_cast<std::size_t>(projector.width);
    LitPlaces lit;
    lit.places.assign(width * static_cast<std::size_t>(projector.height),
                      glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    lit.normals.resize(lit.places.size());
    const glm::vec3 lamp(centre_in_world(projector));
    parallel_for(
        static_cast<std::size_t>(projector.height), 8, [&](std::size_t begin, std::size_t end) {
            std::vector<glm::vec3> directions(width);
            std::vector<Hit> hits(width);
            for (std::size_t y = begin; y < end; ++y) {
                for (std::size_t x = 0; x < width; ++x)
                    directions[x] = glm::vec3(
                        ray_through(projector,
                                    {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5})
                            .direction);
                tracer.closest_from(lamp, directions, hits);
                for (std::size_t x = 0; x < width; ++x) {
                    if (!hits[x].valid()) continue;
                    const SurfacePoint point = surface_point(mesh, hits[x]);
                    lit.places[y * width + x] = point.position_mm;
                    lit.normals[y * width + x] = point.normal;
                }
            }
        });
    lit.irradiance = projector_irradiance(mesh, projector, progress);
    return lit;
}

/// A pixel of then that lit the place, with its share.
struct CarriedFrom {
    std::size_t pixel = 0;
    double share = 0.0;
};

/// The pixels of then around a place of the mesh that were measured there. Empty: too few.
std::vector<CarriedFrom> sources_of(const ColourCalibration& then,
                                    const LitPlaces& lit,
                                    const View& projector,
                                    const glm::dvec3& place,
                                    const glm::dvec3& normal,
                                    float least_irradiance) {
    std::vector<CarriedFrom> sources;
    const auto pixel = project(projector, place);
    if (!pixel) return sources;
    const double left = std::floor(pixel->x - 0.5), top = std::floor(pixel->y - 0.5);
    const double px_mm = glm::length(place - centre_in_world(projector)) / projector.focal_px.x;
    double weight = 0.0;
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column) {
            const double x = left + column, y = top + row;
            if (!(x >= 0.0 && y >= 0.0 && x < then.width && y < then.height)) continue;
            const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(then.width) +
                               static_cast<std::size_t>(x);
            const auto status = static_cast<PixelStatus>(then.status.values[index]);
            if (status != PixelStatus::measured && status != PixelStatus::filled) continue;
            if (!(lit.irradiance.values[index] > least_irradiance)) continue;
            // The same surface: within two pixels of the tangent plane, and not far along it.
            const glm::dvec3 between = glm::dvec3(lit.places[index]) - place;
            if (!(std::abs(glm::dot(between, normal)) < 2.0 * px_mm) ||
                !(glm::length(between) < 10.0 * px_mm))
                continue;
            const double share =
                (1.0 - std::abs(pixel->x - 0.5 - x)) * (1.0 - std::abs(pixel->y - 0.5 - y));
            sources.push_back({index, share});
            weight += share;
        }
    if (weight < 0.5) return {};
    for (CarriedFrom& source : sources) source.share /= weight;
    return sources;
}

void carry_pixel(const ColourCalibration& then,
                 const LitPlaces& lit_then,
                 const std::vector<CarriedFrom>& sources,
                 double irradiance,
                 std::size_t pixel,
                 ColourCalibration& now) {
    bool filled = false;
    for (const CarriedFrom& source : sources) {
        const auto plane = [&](const ImageF& from, ImageF& to, std::size_t channels, double by) {
            for (std::size_t c = 0; c < channels; ++c)
                to.values[channels * pixel + c] += static_cast<float>(
                    by * static_cast<double>(from.values[channels * source.pixel + c]));
        };
        plane(then.unmixing, now.unmixing, 9, source.share);
        plane(then.dark, now.dark, 3, source.share);
        plane(then.span,
              now.span,
              3,
              source.share * irradiance /
                  static_cast<double>(lit_then.irradiance.values[source.pixel]));
        filled |=
            then.status.values[source.pixel] == static_cast<std::uint8_t>(PixelStatus::filled);
    }
    now.status.values[pixel] =
        static_cast<std::uint8_t>(filled ? PixelStatus::filled : PixelStatus::measured);
}

/// Where the camera sees a place now: where it saw it, and how far the pose moves it.
std::optional<glm::dvec2> seen_now(const ColourCalibration& then,
                                   const std::vector<CarriedFrom>& sources,
                                   const PairOfViews& views_then,
                                   const PairOfViews& views_now,
                                   const glm::dvec3& place) {
    const auto before = project(views_then.camera, place), after = project(views_now.camera, place);
    if (!before || !after) return std::nullopt;
    glm::dvec2 seen(0.0);
    for (const CarriedFrom& source : sources)
        seen += source.share * glm::dvec2(then.camera_px.values[2 * source.pixel],
                                          then.camera_px.values[2 * source.pixel + 1]);
    return seen + *after - *before;
}

void copy_pixel(const ColourCalibration& then, std::size_t pixel, ColourCalibration& now) {
    const auto plane = [&](const ImageF& from, ImageF& to, std::size_t channels) {
        std::copy_n(from.values.begin() + static_cast<std::ptrdiff_t>(channels * pixel),
                    channels,
                    to.values.begin() + static_cast<std::ptrdiff_t>(channels * pixel));
    };
    plane(then.unmixing, now.unmixing, 9);
    plane(then.dark, now.dark, 3);
    plane(then.span, now.span, 3);
    plane(then.camera_px, now.camera_px, 2);
    now.status.values[pixel] = then.status.values[pixel];
}

}  // namespace

ColourCalibration carry_colours(const ColourCalibration& then,
                                const Mesh& mesh,
                                const PairOfViews& views_then,
                                const PairOfViews& views_now,
                                const Progress& progress) {
    for (const View* projector : {&views_then.projector, &views_now.projector})
        check_argument(projector->width == then.width && projector->height == then.height,
                       "carry_colours: a projector of another size than the calibration");
    const Tracer tracer(mesh);
    const LitPlaces lit_then =
        lit_places(mesh, tracer, views_then.projector, progress.part(0.0, 0.4));
    const LitPlaces lit_now =
        lit_places(mesh, tracer, views_now.projector, progress.part(0.4, 0.8));
    // Light that hardly grazes a surface says nothing of it under another angle.
    const float least_irradiance =
        static_cast<float>(kGrazingShare) * quantile(lit_then.irradiance.values, 0.999);

    ColourCalibration now = then;
    now.created = utc_now();
    now.unmixing = ImageF(then.width, then.height, 9);
    now.dark = ImageF(then.width, then.height, 3);
    now.span = ImageF(then.width, then.height, 3);
    now.status = Image8(then.width, then.height, 1);
    now.camera_px = ImageF(then.width, then.height, 2, std::numeric_limits<float>::quiet_NaN());
    parallel_for(lit_now.places.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const glm::dvec3 place(lit_now.places[p]);
            const double irradiance = static_cast<double>(lit_now.irradiance.values[p]);
            if (!(irradiance > 0.0)) {
                if (!(lit_then.irradiance.values[p] > 0.0f)) copy_pixel(then, p, now);
                continue;
            }
            now.status.values[p] = static_cast<std::uint8_t>(PixelStatus::not_decoded);
            if (!std::isfinite(place.x)) continue;
            const std::vector<CarriedFrom> sources = sources_of(then,
                                                                lit_then,
                                                                views_then.projector,
                                                                place,
                                                                glm::dvec3(lit_now.normals[p]),
                                                                least_irradiance);
            if (sources.empty()) continue;
            carry_pixel(then, lit_then, sources, irradiance, p, now);
            if (const auto seen = seen_now(then, sources, views_then, views_now, place)) {
                now.camera_px.values[2 * p] = static_cast<float>(seen->x);
                now.camera_px.values[2 * p + 1] = static_cast<float>(seen->y);
            }
        }
    });
    std::size_t lit = 0, valid = 0;
    for (const std::uint8_t status : now.status.values) {
        lit += status != static_cast<std::uint8_t>(PixelStatus::unlit);
        valid += is_valid(static_cast<PixelStatus>(status));
    }
    now.valid_fraction =
        static_cast<double>(valid) / static_cast<double>(std::max<std::size_t>(lit, 1));
    now.predicted_fraction = now.prediction_error_median = now.prediction_error_p95 = 0.0;
    progress.update(0.9, "predicting what is hidden");
    return predict_hidden(std::move(now), lit_now.irradiance);
}

}  // namespace livery
