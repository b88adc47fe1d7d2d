#include "twin/bench.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tracing/tracer.h"
#include "twin/interreflection.h"
#include "twin/mishaps.h"
#include "twin/projector_light.h"
#include "twin/received.h"
#include "twin/sensor.h"

namespace livery {

namespace {

constexpr double kGatherCellMm = 6.0;
constexpr int kGatherRays = 256;

/// A picture as it stands on the mock-up; what the camera sees of it is computed when first asked
/// for.
struct LitPicture {
    ImageF light;
    ImageF camera_units_per_s;  ///< empty: not yet asked for
};

double reference_distance_mm(const View& projector, const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    return glm::distance(centre_in_world(projector), 0.5 * (bounds.low + bounds.high));
}

void check_view(const View& view, const char* what) {
    check_argument(view.width > 1 && view.height > 1 && view.width <= 16384 && view.height <= 16384,
                   fmt::format("bench: {} of {} x {} pixels", what, view.width, view.height));
}

}  // namespace

struct Bench::State {
    BenchDescription description;
    std::shared_ptr<const Product> product;
    Mesh mesh;  ///< the product's with what stands around it
    SurfaceSet surfaces;
    Receivers camera, observer;
    Gathers gathers;
    Truth truth;
    ImageF clear_xyz;       ///< the clear segment at 1, as primary_xyz
    ImageF camera_ambient;  ///< empty: no ambient light
    ImageF room_light;      ///< of mishaps, at 1; empty: none switches one on

    LitPicture shown, before;
    int photographs_of_shown = 0;
    std::uint32_t photographs = 0;
    double default_exposure_s = 0.0, exposure_s = 0.0;

    void trace(const Progress& progress);
    void measure_truth();
    double metered_exposure_s() const;
    ImageF camera_light(LitPicture& picture);
    void show(const Image8& drive);
    Photograph photograph(double wanted_exposure_s);
    glm::dvec3 measure_xyz(glm::dvec2 pixel) const;
    ImageF optics(ImageF units_per_s, double shift_px) const;
};

void Bench::State::trace(const Progress& progress) {
    const Tracer tracer(mesh);
    const TracedWorld world{mesh,
                            product->mesh.parts.size(),
                            tracer,
                            surfaces,
                            description,
                            reference_distance_mm(description.projector.view, product->mesh)};
    progress.update(0.0, "tracing the bench's camera");
    camera.paths = trace_camera(world, progress);
    progress.update(0.5, "tracing the bench's projector");
    ProjectorPaths traced = trace_projector(world, progress);
    observer.paths = std::move(traced.paths);
    truth.lit = std::move(traced.lit);
    truth.edge = std::move(traced.edge);
    truth.seen_by_eye = std::move(traced.seen_by_eye);
    camera.width = description.camera.view.width;
    camera.height = description.camera.view.height;
    observer.width = description.projector.view.width;
    observer.height = description.projector.view.height;
    camera.factors = fold(description, surfaces, camera_sensor(description));
    observer.factors = fold(description, surfaces, observer_sensor());
    if (description.mockup.interreflection) {
        progress.update(0.8, "tracing light between parts");
        GatherPlaces places(kGatherCellMm);
        places.add(camera.paths);
        places.add(observer.paths);
        gathers = places.gather(world, kGatherRays, progress);
        camera.blends = places.blend(camera.paths);
        observer.blends = places.blend(observer.paths);
    }
    if (description.ambient > 0.0) camera_ambient = receive_ambient(camera);
    if (has_room_light(description.mishaps)) {
        BenchDescription lit = description;
        lit.ambient = 1.0;
        Factors own = fold(lit, surfaces, camera_sensor(description));
        std::swap(own, camera.factors);
        room_light = receive_ambient(camera);
        std::swap(own, camera.factors);
    }
    progress.update(1.0, "tracing done");
}

void Bench::State::measure_truth() {
    const int width = observer.width, height = observer.height;
    const ImageF dark = light_from_drive(description.projector, Image8(width, height, 3));
    truth.black_xyz = receive_all(observer, gathers, dark);
    truth.primary_xyz = ImageF(width, height, 9);
    clear_xyz = ImageF(width, height, 3);
    const LightPaths& paths = observer.paths;
    parallel_for(paths.receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = paths.receiver[i];
            const glm::vec3 ambient = receive_ambient(observer, i);
            for (int c = 0; c < 3; ++c) {
                truth.black_xyz.values[3 * pixel + static_cast<std::size_t>(c)] += ambient[c];
            }
            for (std::uint32_t t = paths.term_begin[i]; t < paths.term_begin[i + 1]; ++t) {
                const auto& factors = observer.factors.direct[paths.terms[t].surface];
                for (std::size_t k = 0; k < factors.size(); ++k) {
                    float* out = k < 3 ? truth.primary_xyz.values.data() + 9 * pixel + 3 * k
                                       : clear_xyz.values.data() + 3 * pixel;
                    for (int c = 0; c < 3; ++c) {
                        out[c] += static_cast<float>(paths.terms[t].weight * factors[k][c]);
                    }
                }
            }
        }
    });
}

ImageF Bench::State::optics(ImageF units_per_s, double shift_px) const {
    if (shift_px > 0.0) units_per_s = shifted(units_per_s, shift_px);
    if (description.camera.flare > 0.0) {
        units_per_s =
            with_flare(units_per_s, description.camera.flare, description.camera.flare_radius);
    }
    return units_per_s;
}

double Bench::State::metered_exposure_s() const {
    const Image8 white(observer.width, observer.height, 3, 255);
    ImageF units = receive_all(camera, gathers, light_from_drive(description.projector, white));
    for (std::size_t k = 0; k < camera_ambient.values.size(); ++k) {
        units.values[k] += camera_ambient.values[k];
    }
    units = optics(std::move(units), 0.0);
    const float peak = *std::max_element(units.values.begin(), units.values.end());
    check_argument(peak > 0.0f, "bench: the camera sees nothing that the projector lights");
    CameraDescription raw = description.camera;
    raw.encoding = CameraEncoding::raw14;
    return (raw.metered_peak * saturates_at(raw) - black_level(raw)) / peak;
}

void Bench::State::show(const Image8& drive) {
    LitPicture next;
    next.light = light_from_drive(description.projector, drive);
    before = std::move(shown);
    shown = std::move(next);
    photographs_of_shown = 0;
}

ImageF Bench::State::camera_light(LitPicture& picture) {
    if (picture.camera_units_per_s.empty()) {
        picture.camera_units_per_s = receive_all(camera, gathers, picture.light);
    }
    ImageF units = picture.camera_units_per_s;

    // The lamp's light at this photograph.
    const ProjectorDescription& projector = description.projector;
    double lamp = 1.0;
    if (projector.flicker > 0.0) {
        Random random(description.seed, (1ull << 32u) | photographs);
        lamp += projector.flicker * random.normal();
    }
    lamp = std::max(0.0, lamp + projector.drift_per_photograph * photographs);
    if (lamp != 1.0) {
        for (float& value : units.values) value *= static_cast<float>(lamp);
    }
    for (std::size_t k = 0; k < camera_ambient.values.size(); ++k) {
        units.values[k] += camera_ambient.values[k];
    }
    const double sagged = std::min(
        1.0, static_cast<double>(photographs) / std::max(1, description.camera.shift_photographs));
    units = with_mishaps(std::move(units), room_light, description.mishaps, photographs);
    return optics(std::move(units), description.camera.shift_px * sagged);
}

Photograph Bench::State::photograph(double wanted_exposure_s) {
    check_argument(std::isfinite(wanted_exposure_s) && wanted_exposure_s >= 0.0,
                   fmt::format("bench: an exposure of {} s", wanted_exposure_s));
    if (wanted_exposure_s > 0.0) exposure_s = wanted_exposure_s;
    const bool late = photographs_of_shown < description.projector.latency_photographs;
    Photograph photograph;
    const ImageF light = camera_light(late ? before : shown);
    photograph.image = develop(
        description.camera,
        light,
        true_exposure_s(exposure_s, description.camera, light, description.mishaps, photographs),
        description.seed,
        photographs);
    photograph.exposure_s = exposure_s;
    photograph.black_level = black_level(description.camera);
    photograph.saturates_at = saturates_at(description.camera);
    photograph.name = fmt::format("bench-{:04}", photographs);
    ++photographs;
    ++photographs_of_shown;
    return photograph;
}

glm::dvec3 Bench::State::measure_xyz(glm::dvec2 pixel) const {
    const bool inside =
        pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < observer.width && pixel.y < observer.height;
    const auto index =
        inside ? static_cast<std::uint32_t>(pixel.y) * static_cast<std::uint32_t>(observer.width) +
                     static_cast<std::uint32_t>(pixel.x)
               : 0u;
    const auto& receiver = observer.paths.receiver;
    const auto found = std::lower_bound(receiver.begin(), receiver.end(), index);
    check_argument(
        inside && found != receiver.end() && *found == index,
        fmt::format(
            "bench: projector pixel {}, {} lights nothing of the mock-up", pixel.x, pixel.y));
    const auto i = static_cast<std::size_t>(found - receiver.begin());
    const auto bounced = bounced_light(gathers, observer.factors, shown.light);
    return glm::dvec3(receive(observer, bounced, shown.light, i) + receive_ambient(observer, i));
}

Bench::Bench(const BenchDescription& description,
             std::shared_ptr<const Product> product,
             const Progress& progress)
    : state_(std::make_unique<State>()) {
    check_argument(product != nullptr && !product->mesh.triangles.empty(), "bench: no mock-up");
    check_view(description.projector.view, "a projector");
    check_view(description.camera.view, "a camera");
    check_argument(description.samples_a_side >= 1 && description.samples_a_side <= 16,
                   fmt::format("bench: {} samples a side", description.samples_a_side));
    state_->description = description;
    state_->product = std::move(product);
    state_->mesh = with_surroundings(state_->product->mesh, description);
    state_->surfaces = make_surfaces(description, state_->mesh);
    state_->trace(progress);
    state_->measure_truth();
    state_->default_exposure_s = description.camera.exposure_s > 0.0 ? description.camera.exposure_s
                                                                     : state_->metered_exposure_s();
    state_->exposure_s = state_->default_exposure_s;
    const Image8 dark(state_->observer.width, state_->observer.height, 3);
    state_->show(dark);
    state_->show(dark);
}

Bench::~Bench() = default;

BenchPorts Bench::ports() {
    State* state = state_.get();
    BenchPorts ports;
    ports.show = [state](const Image8& drive) { state->show(drive); };
    ports.photograph = [state](double exposure_s) { return state->photograph(exposure_s); };
    ports.measure_xyz = [state](glm::dvec2 pixel) { return state->measure_xyz(pixel); };
    return ports;
}

const BenchDescription& Bench::description() const { return state_->description; }
double Bench::default_exposure_s() const { return state_->default_exposure_s; }
const Bench::Truth& Bench::truth() const { return state_->truth; }

ImageF Bench::observe_xyz(const Image8& drive) const {
    const Receivers& observer = state_->observer;
    const ImageF light = light_from_drive(state_->description.projector, drive);
    ImageF xyz = receive_all(observer, state_->gathers, light);
    if (state_->description.ambient > 0.0) {
        const ImageF ambient = receive_ambient(observer);
        for (std::size_t k = 0; k < xyz.values.size(); ++k) xyz.values[k] += ambient.values[k];
    }
    return xyz;
}

Image8 Bench::reachable(const ImageF& wanted_xyz) const {
    const State& state = *state_;
    const Truth& truth = state.truth;
    check_argument(wanted_xyz.width == truth.lit.width && wanted_xyz.height == truth.lit.height &&
                       wanted_xyz.channels == 3,
                   fmt::format("bench: a wanted picture of {}x{}x{} for a projector of {}x{}",
                               wanted_xyz.width,
                               wanted_xyz.height,
                               wanted_xyz.channels,
                               truth.lit.width,
                               truth.lit.height));
    constexpr double kTolerance = 1e-4;
    const double clear_strength = state.description.projector.white_segment;
    Image8 answer(wanted_xyz.width, wanted_xyz.height, 1);
    parallel_for(
        state.observer.paths.receiver.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t pixel = state.observer.paths.receiver[i];
                glm::dmat3 xyz_from_light;
                glm::dvec3 wanted, clear;
                for (int c = 0; c < 3; ++c) {
                    const auto channel = static_cast<std::size_t>(c);
                    wanted[c] = double(wanted_xyz.values[3 * pixel + channel]) -
                                truth.black_xyz.values[3 * pixel + channel];
                    clear[c] = clear_strength * state.clear_xyz.values[3 * pixel + channel];
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

}  // namespace livery
