#include "twin/bench.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "twin/projector_light.h"
#include "twin/received.h"
#include "twin/sensor.h"

namespace livery {

namespace {

bool holds(const MishapDescription& mishap, std::uint32_t photograph) {
    const auto number = static_cast<int>(photograph);
    return number >= mishap.from && number <= mishap.to;
}

/// A soft shadow a quarter of the picture wide, a little left of its middle.
void shade(ImageF& light, double depth) {
    for (int y = 0; y < light.height; ++y) {
        for (int x = 0; x < light.width; ++x) {
            const double dx = ((x + 0.5) / light.width - 0.45) / 0.13,
                         dy = ((y + 0.5) / light.height - 0.5) / 0.3;
            const double inside = 1.0 / (1.0 + std::exp((std::hypot(dx, dy) - 1.0) * 12.0));
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) *= static_cast<float>(1.0 - depth * inside);
            }
        }
    }
}

}  // namespace

bool has_room_light(const std::vector<MishapDescription>& mishaps) {
    return std::any_of(mishaps.begin(), mishaps.end(), [](const MishapDescription& mishap) {
        return mishap.kind == MishapKind::room_light;
    });
}

ImageF with_mishaps(ImageF units_per_s,
                    const ImageF& room_light,
                    const std::vector<MishapDescription>& mishaps,
                    std::uint32_t photograph) {
    for (const MishapDescription& mishap : mishaps) {
        if (!holds(mishap, photograph)) continue;
        if (mishap.kind == MishapKind::shadow) shade(units_per_s, mishap.size);
        if (mishap.kind == MishapKind::camera_moved) {
            units_per_s = moved(units_per_s, 0.8 * mishap.size, 0.6 * mishap.size);
        }
        if (mishap.kind == MishapKind::room_light) {
            for (std::size_t k = 0; k < room_light.values.size(); ++k) {
                units_per_s.values[k] += static_cast<float>(mishap.size) * room_light.values[k];
            }
        }
    }
    return units_per_s;
}

double true_exposure_s(double exposure_s,
                       const CameraDescription& camera,
                       const ImageF& units_per_s,
                       const std::vector<MishapDescription>& mishaps,
                       std::uint32_t photograph) {
    for (const MishapDescription& mishap : mishaps) {
        if (!holds(mishap, photograph)) continue;
        if (mishap.kind == MishapKind::exposure) exposure_s *= mishap.size;
        if (mishap.kind == MishapKind::automatic_exposure) {
            double sum = 0.0;
            for (const float value : units_per_s.values) sum += static_cast<double>(value);
            const double mean = sum / static_cast<double>(units_per_s.values.size());
            const double wanted = mishap.size * (saturates_at(camera) - black_level(camera));
            // No camera opens for longer than a minute of darkness.
            exposure_s = std::min(wanted / std::max(mean, 1e-9), 60.0);
        }
    }
    return exposure_s;
}

namespace {

/// A picture as it stands on the mock-up; what the camera sees of it is computed when first asked
/// for.
struct LitPicture {
    ImageF light;
    ImageF camera_units_per_s;  ///< empty: not yet asked for
};

void check_view(const View& view, const char* what) {
    check_argument(view.width > 1 && view.height > 1 && view.width <= 16384 && view.height <= 16384,
                   fmt::format("bench: {} of {} x {} pixels", what, view.width, view.height));
}

}  // namespace

struct Bench::State {
    BenchDescription description;
    std::shared_ptr<const Product> product;
    std::shared_ptr<const LightTransport> light;
    Receivers camera;
    Observer observer;  ///< of the projector's pixels
    std::optional<BenchEye> eye;
    ImageF camera_ambient;  ///< empty: no ambient light
    ImageF room_light;      ///< of mishaps, at 1; empty: none switches one on

    LitPicture shown, before;
    int photographs_of_shown = 0;
    std::uint32_t photographs = 0;
    double default_exposure_s = 0.0, exposure_s = 0.0;

    void fold_spectra();
    ImageF observed(const Observer& by, const Image8& drive) const;
    double metered_exposure_s() const;
    ImageF camera_light(LitPicture& picture);
    void show(const Image8& drive);
    Photograph photograph(double wanted_exposure_s);
    glm::dvec3 measure_xyz(glm::dvec2 pixel) const;
    ImageF optics(ImageF units_per_s, double shift_px) const;
};

void Bench::State::fold_spectra() {
    const SurfaceSet surfaces =
        make_surfaces(description, with_surroundings(product->mesh, description));
    camera = {&light->camera, fold(description, surfaces, camera_sensor(description))};
    const Factors eye_factors = fold(description, surfaces, observer_sensor());
    const View& projector = description.projector.view;
    const ImageF dark =
        light_from_drive(description.projector, Image8(projector.width, projector.height, 3));
    observer = make_observer(light->projector, eye_factors, light->gathers, dark);
    if (light->eye) {
        eye = BenchEye{*light->eye_view,
                       make_observer(*light->eye, eye_factors, light->gathers, dark)};
    }
    if (description.ambient > 0.0) camera_ambient = receive_ambient(camera);
    if (has_room_light(description.mishaps)) {
        BenchDescription lit = description;
        lit.ambient = 1.0;
        room_light =
            receive_ambient({&light->camera, fold(lit, surfaces, camera_sensor(description))});
    }
}

ImageF Bench::State::observed(const Observer& by, const Image8& drive) const {
    return observe(by,
                   light->gathers,
                   light_from_drive(description.projector, drive),
                   description.ambient > 0.0);
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
    const Image8 white(description.projector.view.width, description.projector.view.height, 3, 255);
    ImageF units =
        receive_all(camera, light->gathers, light_from_drive(description.projector, white));
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
        picture.camera_units_per_s = receive_all(camera, light->gathers, picture.light);
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
    const ImageF seen = camera_light(late ? before : shown);
    photograph.image = develop(
        description.camera,
        seen,
        true_exposure_s(exposure_s, description.camera, seen, description.mishaps, photographs),
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
    const Receivers& seen = observer.receivers;
    const bool inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < seen.traced->width &&
                        pixel.y < seen.traced->height;
    const auto index = inside ? static_cast<std::uint32_t>(pixel.y) *
                                        static_cast<std::uint32_t>(seen.traced->width) +
                                    static_cast<std::uint32_t>(pixel.x)
                              : 0u;
    const auto& receiver = seen.traced->paths.receiver;
    const auto found = std::lower_bound(receiver.begin(), receiver.end(), index);
    check_argument(
        inside && found != receiver.end() && *found == index,
        fmt::format(
            "bench: projector pixel {}, {} lights nothing of the mock-up", pixel.x, pixel.y));
    const auto i = static_cast<std::size_t>(found - receiver.begin());
    const auto bounced = bounced_light(light->gathers, seen.factors, shown.light);
    return glm::dvec3(receive(seen, bounced, shown.light, i) + receive_ambient(seen, i));
}

namespace {

void check_bench(const BenchDescription& description, const Product* product) {
    check_argument(product != nullptr && !product->mesh.triangles.empty(), "bench: no mock-up");
    check_view(description.projector.view, "a projector");
    check_view(description.camera.view, "a camera");
    check_argument(description.samples_a_side >= 1 && description.samples_a_side <= 16,
                   fmt::format("bench: {} samples a side", description.samples_a_side));
}

std::shared_ptr<const LightTransport> checked_and_traced(const BenchDescription& description,
                                                         const Product* product,
                                                         EyePicture eye_picture,
                                                         const Progress& progress) {
    check_bench(description, product);
    return trace_light(description, *product, eye_picture, progress);
}

}  // namespace

Bench::Bench(const BenchDescription& description,
             std::shared_ptr<const Product> product,
             const Progress& progress,
             EyePicture eye_picture)
    : Bench(description,
            product,
            checked_and_traced(description, product.get(), eye_picture, progress)) {}

Bench::Bench(const BenchDescription& description,
             std::shared_ptr<const Product> product,
             std::shared_ptr<const LightTransport> light)
    : state_(std::make_unique<State>()) {
    check_bench(description, product.get());
    const EyePicture eye_picture = light->eye ? EyePicture::traced : EyePicture::none;
    check_argument(light->made_of == key_of_transport(description, *product, eye_picture),
                   "bench: light that was traced for another geometry");
    state_->description = description;
    state_->product = std::move(product);
    state_->light = std::move(light);
    state_->fold_spectra();
    state_->default_exposure_s = description.camera.exposure_s > 0.0 ? description.camera.exposure_s
                                                                     : state_->metered_exposure_s();
    state_->exposure_s = state_->default_exposure_s;
    const View& projector = description.projector.view;
    const Image8 dark(projector.width, projector.height, 3);
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

const ObserverTruth& Bench::truth() const { return state_->observer.truth; }

ImageF Bench::observe_xyz(const Image8& drive) const {
    return state_->observed(state_->observer, drive);
}

Image8 Bench::reachable(const ImageF& wanted_xyz) const {
    return livery::reachable(
        state_->observer, wanted_xyz, state_->description.projector.white_segment);
}

const BenchEye& Bench::eye() const {
    check_argument(state_->eye.has_value(), "bench: the eye's picture was not traced");
    return *state_->eye;
}

ImageF Bench::observe_from_eye(const Image8& drive) const {
    return state_->observed(eye().observer, drive);
}

Image8 Bench::reachable_from_eye(const ImageF& wanted_xyz) const {
    return livery::reachable(
        eye().observer, wanted_xyz, state_->description.projector.white_segment);
}

}  // namespace livery
