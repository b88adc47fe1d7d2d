#include "jobs/simulated_photographer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/image_io.h"
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

}  // namespace livery
