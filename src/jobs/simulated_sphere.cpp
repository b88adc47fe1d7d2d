#include "jobs/simulated_sphere.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "twin/sensor.h"

namespace livery {

namespace {

constexpr double kLargestStep = 8.0;  ///< from one exposure to the next
constexpr double kPeak = 0.8, kMiddle = 0.5;
constexpr double kWhite = 0.95;
constexpr double kWhiteLampAngle_deg = 30.0;

/// The camera's full scale over black, in units of light.
double linear_range(const CameraDescription& camera) {
    CameraDescription raw = camera;
    raw.encoding = CameraEncoding::raw14;
    return saturates_at(raw) - black_level(raw);
}

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

class Photographer {
  public:
    explicit Photographer(const SimulatedSphereRequest& request) : request_(request) {}

    /// Takes and writes one photograph; what the manifest says of it.
    Json take(const ImageF& units_per_s, double exposure_s) {
        const CameraDescription& camera = request_.stand.camera;
        const ImageF file = develop(camera, units_per_s, exposure_s, request_.seed, taken_);
        const std::string name = fmt::format("{:03}.png", taken_++);
        if (camera.encoding == CameraEncoding::srgb8) {
            write(name, Image8(file.width, file.height, 3), file);
        } else {
            write(name, Image16(file.width, file.height, 3), file);
        }
        return {{"file", name}, {"exposure_s", exposure_s}};
    }
    std::size_t taken() const { return taken_; }

  private:
    template <typename Picture>
    void write(const std::string& name, Picture picture, const ImageF& file) const {
        using Value = typename decltype(picture.values)::value_type;
        for (std::size_t k = 0; k < file.values.size(); ++k) {
            picture.values[k] = static_cast<Value>(file.values[k]);
        }
        write_png(request_.out / name, picture);
    }

    const SimulatedSphereRequest& request_;
    std::uint32_t taken_ = 0;
};

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

    Photographer photographer(request);
    SimulatedSphere result;
    Json captures = Json::array();
    for (const glm::dvec3& lamp_mm : stand.lamps_mm) {
        progress.update(
            static_cast<double>(result.lamps) / static_cast<double>(stand.lamps_mm.size()),
            fmt::format("photographing under lamp {}", result.lamps + 1));
        const ImageF light = sphere_light(stand, request.paint, lamp_mm, progress);
        for (const double exposure_s : bracket_s(stand.camera, light)) {
            Json entry = photographer.take(light, exposure_s);
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
    Json white_reference = photographer.take(light, bracket_s(stand.camera, light).front());
    white_reference["light_position_mm"] = json_from(lamp_mm);
    white_reference["reflectance"] = kWhite;
    result.photographs = photographer.taken();

    write_camera_file(request.out / "camera.json", stand.camera.view);
    write_json_file(
        request.out / "camera-to-xyz.json",
        {{"format_version", 1},
         {"matrix", json_from(xyz_from_working() * glm::inverse(stand.camera_from_working))},
         {"note", "the simulated camera's"}});
    const bool srgb = stand.camera.encoding == CameraEncoding::srgb8;
    write_json_file(
        request.out / "manifest.json",
        {{"format_version", 1},
         {"camera", "camera.json"},
         {"camera_to_xyz", "camera-to-xyz.json"},
         {"sphere", {{"centre_mm", {0.0, 0.0, 0.0}}, {"diameter_mm", stand.diameter_mm}}},
         {"white_reference", white_reference},
         {"transfer", srgb ? "srgb" : "linear"},
         {"black_level", black_level(stand.camera)},
         {"saturates_at", saturates_at(stand.camera)},
         {"captures", captures}});
    return result;
}

}  // namespace livery
