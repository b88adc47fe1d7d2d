#include "jobs/capture_bench.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "calibration/camera_response.h"
#include "capture/camera.h"
#include "capture/tethered_camera.h"
#include "capture/transfer.h"
#include "capture/video_camera.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/pictures/white_balance.h"
#include "scene/library.h"

namespace livery {

namespace {

std::filesystem::path file_of(Camera& camera) {
    std::string name = camera.state().model;
    if (name.empty()) return {};
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '-';
    return user_folder() / "cameras" / (name + ".json");
}

std::string transfer_of(Camera& camera) {
    const auto kept = kept_camera_curve(camera);
    return kept ? kept->string() : "srgb";
}

bool are_eight_bits(const std::vector<Photograph>& photographs) {
    return std::all_of(photographs.begin(), photographs.end(), [](const Photograph& photograph) {
        return photograph.saturates_at == 255.0 && photograph.image.channels == 3;
    });
}

}  // namespace

std::optional<std::filesystem::path> kept_camera_curve(Camera& camera) {
    const std::filesystem::path file = file_of(camera);
    std::error_code error;
    if (file.empty() || !std::filesystem::exists(file, error)) return std::nullopt;
    return file;
}

CameraCurve fit_camera_curve(
    Camera& camera, const BenchPorts& ports, int width, int height, const Progress& progress) {
    const std::filesystem::path file = file_of(camera);
    const std::string before = transfer_of(camera);
    try {
        camera.use_transfer("linear");
        const std::vector<Photograph> photographs =
            photograph_exposures(ports, width, height, progress);
        if (file.empty() || !are_eight_bits(photographs))
            throw Refused("this camera has no curve: its numbers are the sensor's",
                          "nothing needs to be done");
        const CameraResponse response = fit_camera_response(photographs);
        make_output_folder(file.parent_path());
        write_response(file, response.linear_from_file);
        camera.use_transfer(file.string());
        return {file, response.residual};
    } catch (...) {
        camera.use_transfer(before);
        throw;
    }
}

namespace {

constexpr double kLiveWhite = 0.9;  ///< of the live view's full scale

/// The simulated camera as any other one.
class BenchCamera : public Camera {
  public:
    explicit BenchCamera(Bench& bench)
        : bench_(bench), ports_(bench.ports()), exposure_s_(bench.default_exposure_s()) {}

    std::string name() const override { return "camera of bench " + bench_.description().name; }
    CameraState state() override {
        CameraState state;
        state.settings.push_back({"exposure", fmt::format("{:.4g} s", exposure_s_), {}, true});
        return state;
    }
    void set(const std::string& setting, const std::string& value) override {
        char* end = nullptr;
        const double seconds = std::strtod(value.c_str(), &end);
        if (setting != "exposure" || end == value.c_str() || !(seconds > 0.0) || seconds > 3600.0)
            throw CameraFault(CameraTrouble::refused,
                              fmt::format("{} does not take {} {}", name(), setting, value),
                              "its exposure in seconds can be set");
        exposure_s_ = seconds;
    }
    Photograph photograph(double exposure_s) override {
        if (exposure_s > 0.0) exposure_s_ = exposure_s;
        return ports_.photograph(exposure_s_);
    }
    void use_transfer(const std::string&) override {}  // Its numbers are the sensor's.
    /// Balanced, as cameras show theirs: white is shown while somebody aims.
    Image8 live_view() override {
        const Photograph seen = ports_.photograph(exposure_s_);
        const glm::dvec3 balance = white_balance(seen);
        Image8 srgb(seen.image.width, seen.image.height, 3);
        const double full = kLiveWhite * (seen.saturates_at - seen.black_level);
        for (std::size_t k = 0; k < srgb.values.size(); ++k) {
            const double light = balance[static_cast<int>(k % 3)] *
                                 (static_cast<double>(seen.image.values[k]) - seen.black_level) /
                                 full;
            srgb.values[k] =
                static_cast<std::uint8_t>(255.0 * srgb_encode(std::clamp(light, 0.0, 1.0)) + 0.5);
        }
        return srgb;
    }

  private:
    Bench& bench_;
    BenchPorts ports_;
    double exposure_s_;
};

/// Everything that differs from one kind of camera to the next: another kind is another row.
struct CameraKind {
    std::string name;   ///< before the colon
    std::string usage;  ///< behind it, as --camera's help has it
    /// What is meant where nothing stands behind the colon; nothing: something must.
    std::optional<std::string> by_default;
    CameraTraits traits;
    /// Sets the bench's camera, and what it brings along; null: it has no camera.
    void (*open)(const std::string& what, CaptureBench& bench, const Progress& progress);
    /// Those that could be chosen now; null: none can be listed.
    std::vector<ListedCamera> (*list)();
};

void open_bench_camera(const std::string& what, CaptureBench& bench, const Progress& progress) {
    const BenchDescription description = read_bench_file(what);
    if (!bench.product) bench.product = find_product(description.product.string());
    bench.simulated = std::make_unique<Bench>(description, bench.product, progress);
    bench.camera = std::make_unique<BenchCamera>(*bench.simulated);
    const BenchPorts ports = bench.simulated->ports();
    bench.show = ports.show;
    bench.measure_xyz = ports.measure_xyz;
}

std::vector<ListedCamera> listed_benches() {
    std::vector<ListedCamera> cameras;
    for (const std::string& bench : shipped_names("calibration"))
        cameras.push_back({"bench:" + bench, "simulated bench " + bench, "", ""});
    return cameras;
}

void open_tethered(const std::string& what, CaptureBench& bench, const Progress&) {
    TetheredOptions options;
    options.port = what;
    bench.camera = open_tethered_camera(options);
}

std::vector<ListedCamera> listed_tethered() {
    std::vector<ListedCamera> cameras;
    for (const FoundCamera& found : list_tethered_cameras()) {
        ListedCamera camera{"tethered:" + found.port, found.model + " at " + found.port, "", ""};
        if (!found.held_by.empty()) {
            camera.problem = "it is open in " + found.held_by;
            camera.fix = "close that program, or eject the camera in the file manager";
        }
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

void open_video(const std::string& what, CaptureBench& bench, const Progress&) {
    VideoCameraOptions options;
    options.source = what;
    bench.camera = open_video_camera(options);
}

std::vector<ListedCamera> listed_video() {
    std::vector<ListedCamera> cameras;
    std::error_code error;
    for (int number = 0; number < 64; ++number) {
        const std::string device = fmt::format("/dev/video{}", number);
        if (std::filesystem::exists(device, error))
            cameras.push_back({fmt::format("video:{}", number), "video camera " + device, "", ""});
    }
    return cameras;
}

const std::vector<CameraKind>& camera_kinds() {
    static const std::vector<CameraKind> kinds = {
        {"tethered", "[:PORT]", "", {}, open_tethered, listed_tethered},
        {"video", ":NUMBER|FILE|ADDRESS", std::nullopt, {}, open_video, listed_video},
        {"bench",
         "[:NAME|FILE]",
         "default",
         {.is_simulated = true},
         open_bench_camera,
         listed_benches},
        {"folder", ":DIR", std::nullopt, {.is_by_hand = true}, nullptr, nullptr},
    };
    return kinds;
}

const CameraKind* find_kind(const std::string& name) {
    for (const CameraKind& kind : camera_kinds())
        if (kind.name == name) return &kind;
    return nullptr;
}

const CameraKind& kind_of(const CameraChoice& choice) {
    const CameraKind* const kind = find_kind(choice.kind);
    check_argument(kind != nullptr, "unknown kind of camera \"" + choice.kind + "\"");
    return *kind;
}

}  // namespace

std::string camera_usage() {
    std::string usage;
    for (std::size_t k = 0; k < camera_kinds().size(); ++k)
        usage += (k == 0                          ? ""
                  : k + 1 < camera_kinds().size() ? ", "
                                                  : " or ") +
                 camera_kinds()[k].name + camera_kinds()[k].usage;
    return usage;
}

CameraChoice parse_camera_choice(const std::string& text) {
    const std::size_t colon = text.find(':');
    CameraChoice choice{text.substr(0, colon),
                        colon == std::string::npos ? "" : text.substr(colon + 1)};
    const CameraKind* const kind = find_kind(choice.kind);
    if (!kind || (choice.what.empty() && !kind->by_default))
        throw std::invalid_argument(
            fmt::format("--camera: found \"{}\", expected {}", text, camera_usage()));
    if (choice.what.empty()) choice.what = *kind->by_default;
    return choice;
}

std::string text_of(const CameraChoice& choice) { return choice.kind + ":" + choice.what; }

CameraTraits traits_of(const CameraChoice& choice) { return kind_of(choice).traits; }

CameraChoice camera_at_address(const std::string& address) {
    const auto follows = [&](const std::string& beginning) {
        return address.starts_with(beginning) && address.size() > beginning.size();
    };
    if (follows("ptpip:")) return {"tethered", address};
    for (const char* video : {"http://", "https://", "rtsp://"})
        if (follows(video)) return {"video", address};
    throw std::invalid_argument(fmt::format(
        "address of a camera: found \"{}\", expected ptpip:HOST of a still camera, or http://… or "
        "rtsp://… of a network camera",
        address));
}

std::vector<ListedCamera> list_cameras(bool with_simulated) {
    std::vector<ListedCamera> cameras;
    for (const CameraKind& kind : camera_kinds()) {
        if (!kind.list || (kind.traits.is_simulated && !with_simulated)) continue;
        std::vector<ListedCamera> found = kind.list();
        std::move(found.begin(), found.end(), std::back_inserter(cameras));
    }
    return cameras;
}

CaptureBench open_capture_bench(const CameraChoice& choice,
                                std::shared_ptr<const Product> product,
                                const Progress& progress) {
    const CameraKind& kind = kind_of(choice);
    check_argument(kind.open != nullptr, "a " + kind.name + " has no camera");
    CaptureBench bench;
    if (kind.traits.is_simulated) bench.product = std::move(product);
    kind.open(choice.what, bench, progress);
    bench.name = bench.camera->name();
    bench.curve = kept_camera_curve(*bench.camera);
    if (bench.curve) bench.camera->use_transfer(bench.curve->string());
    return bench;
}

}  // namespace livery
