#include "jobs/simulated_captures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "capture/patterns_folder.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "scene/library.h"
#include "scene/view.h"
#include "twin/bench.h"
#include "twin/sensor.h"

namespace livery {

namespace {

constexpr double kLargestStep = 8.0;  ///< from one exposure to the next
constexpr double kPeak = 0.8, kMiddle = 0.5;

/// The camera's full scale over black, in units of light.
double linear_range(const CameraDescription& camera) {
    CameraDescription raw = camera;
    raw.encoding = CameraEncoding::raw14;
    return saturates_at(raw) - black_level(raw);
}

}  // namespace

std::vector<double> bracket_s(const CameraDescription& camera, const ImageF& units_per_s) {
    std::vector<float> values = units_per_s.values;
    std::sort(values.begin(), values.end());
    const auto peak = static_cast<double>(values.back());
    // What is lit: over a hundredth of the brightest, or of what all but a highlight are under.
    const auto bulk = values[values.size() - 1 - values.size() / 20];
    const auto first = std::lower_bound(values.begin(), values.end(), 0.01f * bulk);
    const auto middle = static_cast<double>(*(first + (values.end() - first) / 2));
    const double range = linear_range(camera);
    const double shortest = kPeak * range / peak;
    const double longest = std::max(kMiddle * range / middle, 2.0 * shortest);
    const int steps = std::max(
        1, static_cast<int>(std::ceil(std::log(longest / shortest) / std::log(kLargestStep))));
    std::vector<double> exposures;
    for (int k = 0; k <= steps; ++k) {
        exposures.push_back(shortest *
                            std::pow(longest / shortest, static_cast<double>(k) / steps));
    }
    return exposures;
}

Photographer::Photographer(std::filesystem::path out, std::uint64_t seed)
    : out_(std::move(out)), seed_(seed) {}

Json Photographer::take(const CameraDescription& camera,
                        const ImageF& units_per_s,
                        double exposure_s) {
    const ImageF file = develop(camera, units_per_s, exposure_s, seed_, taken_);
    const std::string name = fmt::format("{:03}.png", taken_++);
    if (camera.encoding == CameraEncoding::srgb8) {
        write(name, Image8(file.width, file.height, 3), file);
    } else {
        write(name, Image16(file.width, file.height, 3), file);
    }
    return {{"file", name}, {"exposure_s", exposure_s}};
}

template <typename Picture>
void Photographer::write(const std::string& name, Picture picture, const ImageF& file) const {
    using Value = typename decltype(picture.values)::value_type;
    for (std::size_t k = 0; k < file.values.size(); ++k) {
        picture.values[k] = static_cast<Value>(file.values[k]);
    }
    write_png(out_ / name, picture);
}

void describe_encoding(const CameraDescription& camera, Json& manifest) {
    manifest["transfer"] = camera.encoding == CameraEncoding::srgb8 ? "srgb" : "linear";
    manifest["black_level"] = black_level(camera);
    manifest["saturates_at"] = saturates_at(camera);
}

void write_camera_matrix(const std::filesystem::path& out, const glm::dmat3& camera_from_working) {
    write_json_file(out / "camera-to-xyz.json",
                    {{"format_version", 1},
                     {"matrix", json_from(xyz_from_working() * glm::inverse(camera_from_working))},
                     {"note", "the simulated camera's"}});
}

namespace {

Image8 uniform(const BenchDescription& bench, int red, int green, int blue) {
    Image8 drive(bench.projector.view.width, bench.projector.view.height, 3);
    const int rgb[] = {red, green, blue};
    for (std::size_t i = 0; i < drive.values.size(); ++i) {
        drive.values[i] = static_cast<std::uint8_t>(rgb[i % 3]);
    }
    return drive;
}

/// The lit projector pixel nearest the middle of the mock-up.
glm::dvec2 measuring_point(const Bench& bench) {
    const Image8& lit = bench.truth().lit;
    std::vector<glm::dvec2> places;
    for (int y = 0; y < lit.height; ++y) {
        for (int x = 0; x < lit.width; ++x) {
            if (lit.at(x, y)) places.emplace_back(x, y);
        }
    }
    if (places.empty()) {
        throw Refused("the bench's projector does not light the mock-up",
                      "check its pose in the bench file");
    }
    const glm::dvec2 middle = std::accumulate(places.begin(), places.end(), glm::dvec2(0.0)) /
                              static_cast<double>(places.size());
    std::erase_if(places, [&](glm::dvec2 at) {
        return bench.truth().edge.at(static_cast<int>(at.x), static_cast<int>(at.y)) != 0;
    });
    const auto nearest = std::min_element(places.begin(), places.end(), [&](auto a, auto b) {
        return glm::dot(a - middle, a - middle) < glm::dot(b - middle, b - middle);
    });
    return (nearest == places.end() ? middle : *nearest) + 0.5;
}

void write_primaries(const std::filesystem::path& file,
                     const Bench& bench,
                     const BenchPorts& ports) {
    const glm::dvec2 pixel = measuring_point(bench);
    const auto reading = [&](int red, int green, int blue) {
        ports.show(uniform(bench.description(), red, green, blue));
        return json_from(ports.measure_xyz(pixel));
    };
    write_json_file(file,
                    {{"format_version", 1},
                     {"primaries_xyz",
                      {{"red", reading(255, 0, 0)},
                       {"green", reading(0, 255, 0)},
                       {"blue", reading(0, 0, 255)},
                       {"black", reading(0, 0, 0)}}},
                     {"measured_at_px", {pixel.x, pixel.y}},
                     {"note", "simulated colorimeter at the eye, on the mock-up"}});
}

}  // namespace

SimulatedCaptures photograph_patterns(const SimulatedCapturesRequest& request,
                                      const Progress& progress) {
    const PatternsManifest manifest = read_patterns_manifest(request.patterns / "manifest.json");
    const View& projector = request.bench.projector.view;
    if (manifest.projector_width != projector.width ||
        manifest.projector_height != projector.height) {
        throw FileError(request.patterns / "manifest.json",
                        "projector",
                        fmt::format("{}x{}", manifest.projector_width, manifest.projector_height),
                        fmt::format("the bench's {}x{}", projector.width, projector.height));
    }
    make_output_folder(request.out);
    Bench bench(request.bench, find_product(request.bench.product.string()), progress);
    const BenchPorts ports = bench.ports();

    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    SimulatedCaptures result;
    Json captures = Json::array();
    for (const PatternEntry& pattern : manifest.patterns) {
        progress.update(
            static_cast<double>(result.photographs) / static_cast<double>(manifest.patterns.size()),
            "photographing " + pattern.role);
        const Image8 shown =
            read_pattern(request.patterns / pattern.file, projector.width, projector.height);
        ports.show(shown);
        const Photograph photograph = ports.photograph(request.exposure_s);
        const std::string name = fmt::format("{:03}.exr", result.photographs);
        write_exr(request.out / name, photograph.image);
        // The pattern lies beside the photograph so that the folder can be moved as a whole, under
        // a name of ours: what the manifest calls it may lie anywhere.
        const std::string pattern_name = fmt::format("{:03}.png", result.photographs);
        write_png(request.out / pattern_name, shown);
        Json entry = {{"file", name},
                      {"pattern", pattern_name},
                      {"role", pattern.role},
                      {"exposure_s", photograph.exposure_s},
                      {"transfer", "linear"},
                      {"black_level", photograph.black_level},
                      {"saturates_at", photograph.saturates_at}};
        if (!pattern.drive.empty()) entry["drive"] = pattern.drive;
        captures.push_back(entry);
        result.exposure_s = photograph.exposure_s;
        ++result.photographs;
    }
    write_json_file(request.out / "manifest.json",
                    {{"format_version", 1},
                     {"projector", {projector.width, projector.height}},
                     {"captures", captures}});
    write_primaries(request.out / "camera-to-xyz.json", bench, ports);
    write_camera_file(request.out / "projector.json", bench.description().projector.view);
    return result;
}

namespace {

constexpr double kWhite = 0.95;
constexpr double kWhiteLampAngle_deg = 30.0;

/// The lamp that stands nearest to 30 degrees from the camera's direction.
glm::dvec3 lamp_for_white(const SphereStand& stand) {
    const double wanted = std::cos(kWhiteLampAngle_deg / 180.0 * 3.14159265358979323846);
    const auto off = [&](const glm::dvec3& lamp) {
        return std::abs(lamp.z / glm::length(lamp) - wanted);
    };
    return *std::min_element(stand.lamps_mm.begin(),
                             stand.lamps_mm.end(),
                             [&](const auto& a, const auto& b) { return off(a) < off(b); });
}

}  // namespace

SimulatedSphere photograph_sphere(const SimulatedSphereRequest& request, const Progress& progress) {
    const SphereStand& stand = request.stand;
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    Photographer photographer(request.out, request.seed);
    SimulatedSphere result;
    Json captures = Json::array();
    for (const glm::dvec3& lamp_mm : stand.lamps_mm) {
        progress.update(
            static_cast<double>(result.lamps) / static_cast<double>(stand.lamps_mm.size()),
            fmt::format("photographing under lamp {}", result.lamps + 1));
        const ImageF light = sphere_light(stand, request.paint, lamp_mm, progress);
        for (const double exposure_s : bracket_s(stand.camera, light)) {
            Json entry = photographer.take(stand.camera, light, exposure_s);
            entry["light_position_mm"] = json_from(lamp_mm);
            captures.push_back(std::move(entry));
        }
        ++result.lamps;
    }
    Material white;
    white.model = ReflectanceModel::lambert;
    white.diffuse = glm::dvec3(kWhite);
    const glm::dvec3 lamp_mm = lamp_for_white(stand);
    const ImageF light = sphere_light(stand, white, lamp_mm, progress);
    Json white_reference =
        photographer.take(stand.camera, light, bracket_s(stand.camera, light).front());
    white_reference["light_position_mm"] = json_from(lamp_mm);
    white_reference["reflectance"] = kWhite;
    result.photographs = photographer.taken();

    write_camera_file(request.out / "camera.json", stand.camera.view);
    write_camera_matrix(request.out, stand.camera_from_working);
    Json manifest = {
        {"format_version", 1},
        {"camera", "camera.json"},
        {"camera_to_xyz", "camera-to-xyz.json"},
        {"sphere", {{"centre_mm", {0.0, 0.0, 0.0}}, {"diameter_mm", stand.diameter_mm}}},
        {"white_reference", white_reference}};
    describe_encoding(stand.camera, manifest);
    manifest["captures"] = captures;
    write_json_file(request.out / "manifest.json", manifest);
    return result;
}

SimulatedBall photograph_ball(const SimulatedBallRequest& request, const Progress& progress) {
    const MirrorBallStand& stand = request.stand;
    check_argument(!stand.cameras.empty(), "photograph_ball: no camera");
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    Photographer photographer(request.out, request.seed);
    Json views = Json::array();
    for (const CameraDescription& camera : stand.cameras) {
        progress.update(
            static_cast<double>(views.size()) / static_cast<double>(stand.cameras.size()),
            fmt::format("photographing from place {}", views.size() + 1));
        const ImageF light =
            mirror_ball_light(stand, camera, request.light_from, request.samples_a_side, progress);
        Json captures = Json::array();
        for (const double exposure_s :
             request.exposures_s.empty() ? bracket_s(camera, light) : request.exposures_s) {
            captures.push_back(photographer.take(camera, light, exposure_s));
        }
        const std::string name = fmt::format("camera-{}.json", views.size() + 1);
        write_camera_file(request.out / name, camera.view);
        views.push_back({{"camera", name}, {"captures", captures}});
    }
    write_camera_matrix(request.out, stand.camera_from_working);
    Json manifest = {
        {"format_version", 1},
        {"environment", "ball"},
        {"camera_to_xyz", "camera-to-xyz.json"},
        {"sphere", {{"centre_mm", {0.0, 0.0, 0.0}}, {"diameter_mm", stand.diameter_mm}}}};
    // A perfect mirror shows at its rim what stands behind it: where it is, the stand knows
    if (!stand.metal) manifest["fit_outline"] = false;
    if (stand.metal) manifest["reflectance"] = json_from(metal_reflectance(*stand.metal, 1.0));
    describe_encoding(stand.cameras.front(), manifest);
    manifest["views"] = views;
    write_json_file(request.out / "manifest.json", manifest);
    return {photographer.taken(), stand.cameras.size()};
}

SimulatedSpot photograph_spot(const SimulatedSpotRequest& request, const Progress& progress) {
    const SpotStand& stand = request.stand;
    make_output_folder(request.out);
    // Until every photograph is there: a stop must not leave an older manifest over a mixture.
    std::filesystem::remove(request.out / "manifest.json");

    const SpotScenes scenes = spot_scenes(stand, progress.part(0.0, 0.8));
    Photographer photographer(request.out, request.seed);
    const auto taken = [&](const ImageF& light, const std::vector<double>& exposures_s) {
        Json captures = Json::array();
        for (const double exposure_s : exposures_s) {
            captures.push_back(photographer.take(stand.camera, light, exposure_s));
        }
        return captures;
    };
    progress.update(0.8, "photographing");
    const auto sample_s = bracket_s(stand.camera, scenes.sample);
    const auto white_s = bracket_s(stand.camera, scenes.white);
    write_camera_file(request.out / "camera.json", stand.camera.view);
    Json manifest = {{"format_version", 1},
                     {"camera", "camera.json"},
                     {"plane", {{"point_mm", {0, 0, 0}}, {"normal", {0, 0, 1}}}},
                     {"projector_mm", json_from(stand.projector_mm)}};
    describe_encoding(stand.camera, manifest);
    manifest["captures"] = taken(scenes.sample, sample_s);
    manifest["black"] = taken(scenes.sample_black, sample_s);
    manifest["white_reference"] = {{"reflectance", stand.white},
                                   {"captures", taken(scenes.white, white_s)},
                                   {"black", taken(scenes.white_black, white_s)}};
    write_json_file(request.out / "manifest.json", manifest);
    return {photographer.taken()};
}

}  // namespace livery
