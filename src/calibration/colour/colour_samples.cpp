#include "calibration/colour/colour_samples.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr std::array<const char*, kPictureCount> kRoles{
    "dark-gray", "bright-gray", "red", "green", "blue", "gray-levels"};

std::string name_of(const RoledPhotograph& capture) {
    return capture.photograph.name.empty() ? capture.role : capture.photograph.name;
}

void check_photograph(const RoledPhotograph& capture, const ImageF& first) {
    const Photograph& photo = capture.photograph;
    const auto size = [](const ImageF& image) {
        return std::to_string(image.width) + "x" + std::to_string(image.height);
    };
    if (photo.image.channels != 3)
        throw FileError(
            name_of(capture), "channels", std::to_string(photo.image.channels), "3 (RGB)");
    if (photo.image.empty() || photo.image.width != first.width ||
        photo.image.height != first.height)
        throw FileError(
            name_of(capture), "size", size(photo.image), size(first) + " as the others");
    if (!(photo.exposure_s > 0.0) || !std::isfinite(photo.exposure_s))
        throw FileError(
            name_of(capture), "exposure_s", std::to_string(photo.exposure_s), "a positive time");
    if (!(photo.saturates_at > photo.black_level))
        throw FileError(name_of(capture),
                        "saturates_at",
                        std::to_string(photo.saturates_at),
                        "more than black_level " + std::to_string(photo.black_level));
}

/// Second differences along camera rows, and the level there.
struct NoiseSamples {
    std::array<std::vector<float>, 3> level, difference;  ///< scaled to one photograph
};

struct Taps {
    std::vector<std::size_t> corner;  ///< top left value of each pixel's four
    std::vector<glm::vec2> fraction;
};

/// Adds one photograph to a picture's sums.
void add_photograph(const Photograph& photo,
                    const Taps& taps,
                    ColourSamples& samples,
                    std::vector<glm::vec3>& sum) {
    const float* const values = photo.image.values.data();
    const auto row = static_cast<std::size_t>(photo.image.width) * 3;
    const auto black = static_cast<float>(photo.black_level);
    const auto gain = static_cast<float>(1.0 / photo.exposure_s);
    const auto limit = static_cast<float>(saturation_limit(photo));
    parallel_for(taps.corner.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* const p = values + taps.corner[i];
            const float fx = taps.fraction[i].x, fy = taps.fraction[i].y;
            const float w[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
            glm::vec3 colour(0.0f);
            bool over = false;
            for (int c = 0; c < 3; ++c) {
                const float v[4] = {p[c],
                                    p[c + 3],
                                    p[row + static_cast<std::size_t>(c)],
                                    p[row + static_cast<std::size_t>(c) + 3]};
                for (int k = 0; k < 4; ++k) {
                    colour[c] += w[k] * v[k];
                    over |= v[k] >= limit;
                }
            }
            sum[i] += (colour - black) * gain;
            if (over) samples.saturated[i] = 1;
        }
    });
}

/// read + shot * level from robust variances in bins of equal population.
void fit_noise(const NoiseSamples& probes, int channel, NoiseModel& model) {
    const auto& level = probes.level[static_cast<std::size_t>(channel)];
    const auto& difference = probes.difference[static_cast<std::size_t>(channel)];
    std::vector<std::size_t> order(level.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return level[a] < level[b]; });

    constexpr std::size_t kBins = 16;
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        const std::size_t begin = order.size() * bin / kBins,
                          end = order.size() * (bin + 1) / kBins;
        if (end - begin < 8) continue;
        std::vector<float> sizes, levels;
        for (std::size_t i = begin; i < end; ++i) {
            sizes.push_back(std::abs(difference[order[i]]));
            levels.push_back(level[order[i]]);
        }
        const double sigma = static_cast<double>(median(sizes)) / 0.6745;
        const double x = static_cast<double>(median(levels)), y = sigma * sigma / 6.0;
        const double weight = 1.0 / (y * y + 1e-30);
        w += weight;
        wx += weight * x;
        wy += weight * y;
        wxx += weight * x * x;
        wxy += weight * x * y;
    }
    if (w <= 0.0) return;
    const double determinant = w * wxx - wx * wx;
    double shot = determinant > 1e-12 * w * wxx ? (w * wxy - wx * wy) / determinant : 0.0;
    double read = (wy - shot * wx) / w;
    if (shot < 0.0) {
        shot = 0.0;
        read = wy / w;
    } else if (read < 0.0) {
        read = 0.0;
        shot = wxx > 0.0 ? wxy / wxx : 0.0;
    }
    model.read[channel] = std::max(read, 0.0);
    model.shot[channel] = std::max(shot, 0.0);
}

}  // namespace

ColourSamples sample_colours(const std::vector<RoledPhotograph>& captures,
                             const ProjectorToCamera& map) {
    check_argument(map.camera_px.channels == 2 && map.edge.width == map.camera_px.width &&
                       map.edge.height == map.camera_px.height && !map.camera_px.empty(),
                   "the map's planes are empty or differ in size");
    ColourSamples samples;
    samples.width = map.camera_px.width;
    samples.height = map.camera_px.height;

    // The photographs of each role
    std::array<std::vector<const RoledPhotograph*>, kPictureCount> of_role;
    std::vector<std::vector<const RoledPhotograph*>> of_mosaic;
    const ImageF* first = nullptr;
    for (const RoledPhotograph& capture : captures) {
        const auto role = std::find(kRoles.begin(), kRoles.end(), capture.role);
        if (role == kRoles.end() && capture.role.rfind("colors-", 0) != 0) {
            throw FileError(name_of(capture),
                            "role",
                            capture.role,
                            "dark-gray, bright-gray, red, green, blue, gray-levels or colors-N");
        }
        if (!first) first = &capture.photograph.image;
        check_photograph(capture, *first);
        if (role != kRoles.end()) {
            of_role[static_cast<std::size_t>(role - kRoles.begin())].push_back(&capture);
            continue;
        }
        const auto same = std::find_if(of_mosaic.begin(), of_mosaic.end(), [&](const auto& shots) {
            return shots.front()->role == capture.role;
        });
        if (same != of_mosaic.end())
            same->push_back(&capture);
        else
            of_mosaic.push_back({&capture});
    }
    for (std::size_t role = 0; role < kPictureCount; ++role)
        if (of_role[role].empty())
            throw FileError("captures",
                            "role",
                            std::string("no photograph of ") + kRoles[role],
                            "dark-gray, bright-gray, red, green, blue and gray-levels");

    // Where each projector pixel is read
    Taps taps;
    std::vector<std::size_t> probes;  // middle values of the second differences
    const auto has_place = [&](int x, int y) {
        return x >= 0 && x < samples.width && std::isfinite(map.camera_px.at(x, y)) &&
               !map.edge.at(x, y);
    };
    for (int y = 0; y < samples.height; ++y)
        for (int x = 0; x < samples.width; ++x) {
            if (!has_place(x, y)) continue;
            const float cx = map.camera_px.at(x, y, 0) - 0.5f,
                        cy = map.camera_px.at(x, y, 1) - 0.5f;
            const float left = std::floor(cx), top = std::floor(cy);
            if (!(left >= 0.0f && top >= 0.0f && left + 1.0f < static_cast<float>(first->width) &&
                  top + 1.0f < static_cast<float>(first->height)))
                continue;
            const std::size_t corner = first->index(static_cast<int>(left), static_cast<int>(top));
            const float fx = cx - left, fy = cy - top;
            samples.pixels.push_back(static_cast<std::uint32_t>(map.edge.index(x, y)));
            taps.corner.push_back(corner);
            taps.fraction.push_back({fx, fy});
            samples.tap_share.push_back((fx * fx + (1 - fx) * (1 - fx)) *
                                        (fy * fy + (1 - fy) * (1 - fy)));
            if (has_place(x - 2, y) && has_place(x + 2, y) && left >= 1.0f)
                probes.push_back(corner);
        }
    const std::size_t count = samples.pixels.size();
    samples.saturated.assign(count, 0);
    samples.finite.assign(count, 1);
    if (probes.size() > 20000) {
        std::vector<std::size_t> some;
        const std::size_t step = probes.size() / 20000 + 1;
        for (std::size_t i = 0; i < probes.size(); i += step) some.push_back(probes[i]);
        probes = std::move(some);
    }

    // Means over the shots
    NoiseSamples noise;
    const auto sample = [&](const std::vector<const RoledPhotograph*>& shots, bool probed) {
        SampledPicture picture;
        picture.role = shots.front()->role;
        picture.shots = static_cast<int>(shots.size());
        picture.colour.assign(count, glm::vec3(0.0f));
        std::vector<double> brightness;
        double before = 0.0;
        for (const RoledPhotograph* shot : shots) {
            add_photograph(shot->photograph, taps, samples, picture.colour);
            double total = 0.0;
            for (const glm::vec3& c : picture.colour)
                if (std::isfinite(c.x + c.y + c.z)) total += static_cast<double>(c.x + c.y + c.z);
            brightness.push_back(total - before);
            before = total;
        }
        for (std::size_t i = 0; i < count; ++i) {
            picture.colour[i] /= static_cast<float>(picture.shots);
            const glm::vec3& c = picture.colour[i];
            if (!std::isfinite(c.x + c.y + c.z)) samples.finite[i] = 0;
        }
        const auto [low, high] = std::minmax_element(brightness.begin(), brightness.end());
        if (*high > 0.0) picture.shot_spread = (*high - *low) / *high;
        if (!probed) return picture;
        const float scale = std::sqrt(static_cast<float>(picture.shots));
        for (const std::size_t place : probes)
            for (std::size_t c = 0; c < 3; ++c) {
                float level = 0.0f, difference = 0.0f;
                for (const RoledPhotograph* shot : shots) {
                    const Photograph& photo = shot->photograph;
                    const float* const p = photo.image.values.data() + place + c;
                    const auto gain = static_cast<float>(1.0 / photo.exposure_s);
                    // The mean of the three is independent of their second difference.
                    level += gain *
                             ((p[-3] + p[0] + p[3]) / 3.0f - static_cast<float>(photo.black_level));
                    difference += gain * (p[-3] - 2.0f * p[0] + p[3]);
                }
                if (!std::isfinite(level + difference)) continue;
                noise.level[c].push_back(level / static_cast<float>(shots.size()));
                noise.difference[c].push_back(difference / static_cast<float>(shots.size()) *
                                              scale);
            }
        return picture;
    };
    for (std::size_t role = 0; role < kPictureCount; ++role)
        samples.pictures[role] = sample(of_role[role], role != kLevels);
    for (const auto& shots : of_mosaic) samples.mosaics.push_back(sample(shots, false));
    for (int c = 0; c < 3; ++c) fit_noise(noise, c, samples.noise);
    return samples;
}

std::vector<std::uint8_t> block_centres(const Image8& drive, int reach) {
    // Distance to the last change along rows and columns, then both ways
    const int width = drive.width, height = drive.height;
    std::vector<std::uint8_t> along_row(drive.pixel_count(), 0), centre(drive.pixel_count(), 0);
    const auto same = [&](int xa, int ya, int xb, int yb) {
        return std::equal(drive.pixel(xa, ya), drive.pixel(xa, ya) + 3, drive.pixel(xb, yb));
    };
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0, start = 0; x <= width; ++x)
            if (x == width || (x > 0 && !same(x, y, x - 1, y))) {
                for (int k = start + reach; k < x - reach; ++k) along_row[at(k, y)] = 1;
                start = x;
            }
    for (int x = 0; x < width; ++x)
        for (int y = 0, start = 0; y <= height; ++y) {
            const bool breaks = y == height || (y > 0 && !same(x, y, x, y - 1));
            if (!breaks) continue;
            for (int k = start + reach; k < y - reach; ++k) {
                bool inside = true;
                for (int j = k - reach; j <= k + reach && inside; ++j)
                    inside = along_row[at(x, j)] != 0;
                centre[at(x, k)] = inside;
            }
            start = y;
        }
    return centre;
}

}  // namespace livery
