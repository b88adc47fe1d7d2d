#include "scene/artwork_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr int kMostPixelsASide = 8192;
constexpr float kLeastRoughness = 0.05f;

std::shared_ptr<const ArtworkPicture> read_picture(const std::filesystem::path& file) {
    const ImageFile from = read_image(file, std::size_t{kMostPixelsASide} * kMostPixelsASide);
    if (std::max(from.image.width, from.image.height) > kMostPixelsASide) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", from.image.width, from.image.height),
                        fmt::format("at most {} pixels a side", kMostPixelsASide));
    }
    return std::make_shared<const ArtworkPicture>(artwork_picture_of(from, file));
}

/// Of every value that 8 bits can have, and between them for finer ones.
float decoded(float encoded) {
    static const std::vector<float> table = [] {
        std::vector<float> values(4097);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] = static_cast<float>(srgb_decode(static_cast<double>(k) / 4096.0));
        }
        return values;
    }();
    const float at = encoded * 4096.0f;
    const auto below = std::min(static_cast<std::size_t>(at), std::size_t{4095});
    return glm::mix(table[below], table[below + 1], at - static_cast<float>(below));
}

float at_table(const std::vector<float>& table, float x) {
    const float at = glm::clamp(x, 0.0f, 1.0f) * static_cast<float>(table.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), table.size() - 2);
    return glm::mix(table[below], table[below + 1], at - static_cast<float>(below));
}

void fill_colours(const ArtworkPicture& picture,
                  const std::vector<float>& response,
                  const glm::mat3& working,
                  const float* rgba,
                  float* layers) {
    glm::vec3 colour(rgba[0], rgba[1], rgba[2]);
    if (!picture.linear) {
        for (int c = 0; c < 3; ++c) colour[c] = decoded(colour[c]);
    }
    colour = working * colour;
    for (int c = 0; c < 3; ++c) layers[c] = rgba[3] * at_table(response, colour[c]);
    layers[3] = rgba[3];
}

void fill_roughness(const std::vector<double>& steps, const float* rgba, float* layers) {
    const double scale = slope_scale(rgba[1]);
    for (std::size_t k = 0; k < steps.size(); ++k) layers[4 * k + 3] = rgba[3];
    const auto share = [&](std::size_t k, double value) {
        std::fill_n(layers + 4 * k, 3, static_cast<float>(value) * rgba[3]);
    };
    if (steps.size() == 1) return share(0, 1.0);
    const auto above = std::upper_bound(steps.begin() + 1, steps.end() - 1, scale);
    const auto k = static_cast<std::size_t>(above - steps.begin());
    const double t =
        glm::clamp(std::log(scale / steps[k - 1]) / std::log(steps[k] / steps[k - 1]), 0.0, 1.0);
    share(k - 1, 1.0 - t);
    share(k, t);
}

}  // namespace

std::shared_ptr<const ArtworkPicture> load_artwork_picture(const std::filesystem::path& file) {
    struct Known {
        std::filesystem::file_time_type changed;
        std::weak_ptr<const ArtworkPicture> picture;
    };
    static std::mutex mutex;
    static std::map<std::filesystem::path, Known> known;
    std::error_code error;
    const auto changed = std::filesystem::last_write_time(file, error);
    const std::lock_guard lock(mutex);
    const auto found = known.find(file);
    if (!error && found != known.end() && found->second.changed == changed) {
        if (auto picture = found->second.picture.lock()) return picture;
    }
    std::erase_if(known, [](const auto& entry) { return entry.second.picture.expired(); });
    auto picture = read_picture(file);
    known[file] = {changed, picture};
    return picture;
}

float picture_cover(const ArtworkPicture& picture, const float* rgba) {
    return picture.has_alpha ? rgba[3] : (rgba[0] + rgba[1] + rgba[2]) * (1.0f / 3.0f);
}

glm::dvec2 relief_slope(const float* rgba) {
    glm::dvec3 normal;
    for (int c = 0; c < 3; ++c) normal[c] = 2.0 * static_cast<double>(rgba[c]) - 1.0;
    const double longest = std::max({std::abs(normal.x), std::abs(normal.y), 1e-6});
    return glm::dvec2(normal) / std::max(normal.z, 0.1 * longest);
}

double slope_scale(float value) {
    const double v = std::max(value, kLeastRoughness);
    return v * v;
}

std::vector<double> roughness_steps(const ArtworkPicture& picture) {
    double least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < picture.rgba.pixel_count(); ++i) {
        const double scale = slope_scale(picture.rgba.values[4 * i + 1]);
        least = std::min(least, scale);
        most = std::max(most, scale);
    }
    const double ratio = most / least;
    if (!(ratio > 1.0 + 1e-9)) return {most};
    const double wanted = std::ceil(std::log(ratio) / std::log(kRoughnessStep)) + 1.0;
    const auto count = std::min(static_cast<std::size_t>(wanted), kMostRoughnessSteps);
    std::vector<double> steps(count);
    for (std::size_t k = 0; k < count; ++k) {
        steps[k] = least * std::pow(ratio, static_cast<double>(k) / static_cast<double>(count - 1));
    }
    return steps;
}

ImageF picture_layers(const ArtworkPicture& picture,
                      PictureUse use,
                      const std::vector<float>& pigment_response) {
    const bool colours = use == PictureUse::colours || use == PictureUse::tint;
    check_argument(!colours || pigment_response.size() >= 2,
                   "a picture's colours need a pigment's response");
    const std::vector<double> steps =
        use == PictureUse::roughness ? roughness_steps(picture) : std::vector<double>(1, 1.0);
    const auto channels = 4 * steps.size();
    ImageF layers(picture.rgba.width, picture.rgba.height, static_cast<int>(channels));
    const glm::mat3 working(working_from_rec709());
    parallel_for(picture.rgba.pixel_count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* rgba = &picture.rgba.values[4 * i];
            float* to = &layers.values[channels * i];
            switch (use) {
                case PictureUse::cover:
                    std::fill(to, to + 4, picture_cover(picture, rgba));
                    break;
                case PictureUse::colours:
                case PictureUse::tint:
                    fill_colours(picture, pigment_response, working, rgba, to);
                    break;
                case PictureUse::relief: {
                    const glm::vec2 slope(relief_slope(rgba));
                    to[0] = rgba[3] * slope.x;
                    to[1] = rgba[3] * slope.y;
                    to[2] = rgba[3] * (slope.x * slope.x + slope.y * slope.y);
                    to[3] = rgba[3];
                    break;
                }
                case PictureUse::roughness:
                    fill_roughness(steps, rgba, to);
                    break;
            }
        }
    });
    return layers;
}

}  // namespace livery
