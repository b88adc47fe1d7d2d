#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/channels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "mesh/beside.h"
#include "scene/look.h"

namespace livery {

namespace {

/// 8192 x 4096: larger maps bring nothing to a mock-up and take gigabytes.
constexpr std::size_t kMaxPixels = std::size_t{1} << 25u;

}  // namespace

std::filesystem::path find_environment_map(const std::string& name,
                                           const std::filesystem::path& beside) {
    return find_beside_or_shipped(name, beside, "environment", "an .hdr or .exr map");
}

Environment load_environment(const EnvironmentReference& reference,
                             const std::filesystem::path& beside) {
    Environment environment;
    environment.rotation_rad = reference.rotation_rad;
    environment.scale = reference.scale;
    if (reference.file.empty()) return environment;

    const auto file = find_environment_map(reference.file, beside);
    environment.file = file;
    const ImageFile map = read_image(file, kMaxPixels);
    const ImageF& image = map.image;
    if (!map.floating_point) throw FileError(file, "", "integer pixels", "an .hdr or .exr map");
    if (image.width != 2 * image.height) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", image.width, image.height),
                        "twice as wide as high (latitude-longitude)");
    }
    const auto channels = colour_channels(file, map);
    environment.radiance_working = ImageF(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            glm::dvec3 rec709;
            for (int c = 0; c < 3; ++c) {
                rec709[c] = image.at(x, y, channels[static_cast<std::size_t>(c)]);
            }
            const double largest = std::max({rec709.x, rec709.y, rec709.z});
            const double least = std::min({rec709.x, rec709.y, rec709.z});
            const bool finite =
                std::isfinite(rec709.x) && std::isfinite(rec709.y) && std::isfinite(rec709.z);
            // A filter or a colour matrix leaves such traces; anything more is not light.
            if (!finite || least < -1e-4 * std::max(largest, 1e-2)) {
                throw FileError(file,
                                fmt::format("pixel ({}, {})", x, y),
                                fmt::format("{:g}, {:g}, {:g}", rec709.x, rec709.y, rec709.z),
                                "finite radiance that is not negative");
            }
            const glm::dvec3 working = working_from_rec709() * glm::max(rec709, glm::dvec3(0.0));
            for (int c = 0; c < 3; ++c) {
                environment.radiance_working.at(x, y, c) = static_cast<float>(working[c]);
            }
        }
    }
    return environment;
}

std::optional<std::string> environment_problem(const EnvironmentReference& reference) {
    struct Known {
        std::filesystem::file_time_type changed{};
        std::uintmax_t bytes = 0;
        std::optional<std::string> problem;
    };
    static std::mutex mutex;
    static std::map<std::filesystem::path, Known> known;
    if (reference.file.empty()) return std::nullopt;
    Known now;
    std::filesystem::path file;
    try {
        file = find_environment_map(reference.file, {});
    } catch (const FileError& error) {
        return error.what();
    }
    std::error_code error;
    now.changed = std::filesystem::last_write_time(file, error);
    now.bytes = std::filesystem::file_size(file, error);
    {
        const std::lock_guard lock(mutex);
        const auto found = known.find(file);
        if (found != known.end() && found->second.changed == now.changed &&
            found->second.bytes == now.bytes) {
            return found->second.problem;
        }
    }
    try {
        load_environment({file.string(), 0.0, 1.0}, {});
    } catch (const std::exception& refusal) {
        now.problem = refusal.what();
    }
    const std::lock_guard lock(mutex);
    known[file] = now;
    return now.problem;
}

glm::dvec2 uv_from_direction(const Environment& environment, const glm::dvec3& direction) {
    const glm::dvec3 d = glm::normalize(direction);
    const double azimuth = std::atan2(d.x, -d.z) + environment.rotation_rad;
    double u = azimuth / (2.0 * std::numbers::pi) + 0.5;
    u -= std::floor(u);
    // atan2 stays exact near the poles, where acos(y) loses half of the digits.
    const double v = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
    constexpr double below_one = 0x1.fffffffffffffp-1;
    return {std::min(u, below_one), std::min(v, below_one)};
}

glm::dvec3 direction_from_uv(const Environment& environment, const glm::dvec2& uv) {
    const double azimuth = 2.0 * std::numbers::pi * (uv.x - 0.5) - environment.rotation_rad;
    const double polar = std::numbers::pi * uv.y;
    return {
        std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

}  // namespace livery
