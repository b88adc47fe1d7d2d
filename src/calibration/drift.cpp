#include "calibration/drift.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "calibration/correspondence/gray_code.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

constexpr int kWindow_px = 32, kLevels = 5, kSteps = 12;

ImageF linear_mean(const Photograph& photograph) {
    ImageF mean = mean_of_channels(photograph.image);
    for (float& value : mean.values)
        value = static_cast<float>(linear_from_file_units(photograph, static_cast<double>(value)));
    return mean;
}

ImageF difference(const ImageF& a, const ImageF& b, double scale) {
    ImageF light(a.width, a.height, 1);
    for (std::size_t i = 0; i < light.values.size(); ++i)
        light.values[i] =
            static_cast<float>(scale * static_cast<double>(a.values[i] - b.values[i]));
    return light;
}

ImageF half_of(const ImageF& image) {
    ImageF half(std::max(1, image.width / 2), std::max(1, image.height / 2), 1);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int right = std::min(2 * x + 1, image.width - 1),
                      below = std::min(2 * y + 1, image.height - 1);
            half.at(x, y) = 0.25f * (image.at(2 * x, 2 * y) + image.at(right, 2 * y) +
                                     image.at(2 * x, below) + image.at(right, below));
        }
    return half;
}

std::vector<ImageF> pyramid_of(ImageF image) {
    std::vector<ImageF> levels{std::move(image)};
    for (int level = 1; level < kLevels; ++level) levels.push_back(half_of(levels.back()));
    return levels;
}

/// Between four pixels; `x`, `y` in pixels of integer centres, within the picture.
double between(const ImageF& image, double x, double y) {
    const int left = std::clamp(static_cast<int>(x), 0, image.width - 2),
              top = std::clamp(static_cast<int>(y), 0, image.height - 2);
    const double u = std::clamp(x - left, 0.0, 1.0), v = std::clamp(y - top, 0.0, 1.0);
    const auto at = [&](int column, int row) { return static_cast<double>(image.at(column, row)); };
    return (1.0 - v) * ((1.0 - u) * at(left, top) + u * at(left + 1, top)) +
           v * ((1.0 - u) * at(left, top + 1) + u * at(left + 1, top + 1));
}

/// A block's normal equations: gradients of then against what now differs by.
struct Normal {
    double xx = 0.0, xy = 0.0, yy = 0.0, xr = 0.0, yr = 0.0, rr = 0.0, energy = 0.0;
    double smaller_eigenvalue() const {
        const double half = 0.5 * (xx + yy);
        return half - std::sqrt(std::max(0.0, half * half - (xx * yy - xy * xy)));
    }
    glm::dvec2 step() const {
        const double determinant = xx * yy - xy * xy;
        return {(yy * xr - xy * yr) / determinant, (xx * yr - xy * xr) / determinant};
    }
};

Normal normal_of(const ImageF& then, const ImageF& now, glm::dvec2 centre, glm::dvec2 shift) {
    constexpr int kHalf = kWindow_px / 2;
    Normal sums;
    const int left = std::clamp(static_cast<int>(centre.x) - kHalf, 1, then.width - 2),
              right = std::clamp(static_cast<int>(centre.x) + kHalf, 1, then.width - 2);
    const int top = std::clamp(static_cast<int>(centre.y) - kHalf, 1, then.height - 2),
              bottom = std::clamp(static_cast<int>(centre.y) + kHalf, 1, then.height - 2);
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const auto value = static_cast<double>(then.at(x, y));
            const double dx = 0.5 * static_cast<double>(then.at(x + 1, y) - then.at(x - 1, y));
            const double dy = 0.5 * static_cast<double>(then.at(x, y + 1) - then.at(x, y - 1));
            const double rest = value - between(now, x + shift.x, y + shift.y);
            sums.xx += dx * dx;
            sums.xy += dx * dy;
            sums.yy += dy * dy;
            sums.xr += dx * rest;
            sums.yr += dy * rest;
            sums.rr += rest * rest;
            sums.energy += value * value;
        }
    return sums;
}

/// Noise of a pixel, from how far it is from its neighbours' mean where it is lit: the median,
/// which what has detail does not move.
double noise_of(const ImageF& lit, float least) {
    std::vector<float> rests;
    for (int y = 1; y + 1 < lit.height; y += 2)
        for (int x = 1; x + 1 < lit.width; x += 3) {
            if (lit.at(x, y) < least) continue;
            const float around =
                0.25f * (lit.at(x - 1, y) + lit.at(x + 1, y) + lit.at(x, y - 1) + lit.at(x, y + 1));
            rests.push_back(std::abs(lit.at(x, y) - around));
        }
    // 0.6745: median over standard deviation; 1.25: the neighbours' mean has noise too.
    return static_cast<double>(median(std::move(rests))) / (0.6745 * std::sqrt(1.25));
}

/// Where a block of then is found now, from coarse to fine; nothing: it is not found. The finest
/// level must have detail; coarser ones without it are passed over.
std::optional<glm::dvec2> follow(const std::vector<ImageF>& then,
                                 const std::vector<ImageF>& now,
                                 glm::dvec2 centre) {
    glm::dvec2 shift(0.0);
    for (int level = kLevels - 1; level >= 0; --level) {
        const auto k = static_cast<std::size_t>(level);
        const double scale = std::ldexp(1.0, -level);
        glm::dvec2 here = scale * shift;
        for (int step = 0; step < kSteps; ++step) {
            const Normal normal = normal_of(then[k], now[k], scale * centre, here);
            if (!(normal.smaller_eigenvalue() > 1e-4 * normal.energy / kWindow_px)) break;
            const glm::dvec2 by = normal.step();
            here += by;
            if (glm::length(by) < 0.005) break;
        }
        shift = here / scale;
    }
    constexpr double kLargestRest = 0.1;  // of the block's own light
    const Normal left = normal_of(then[0], now[0], centre, shift);
    const bool found =
        glm::length(shift) < 64.0 && left.rr < kLargestRest * kLargestRest * left.energy;
    return found ? std::optional(shift) : std::nullopt;
}

}  // namespace

DriftReference drift_reference(const Photograph& white, const Photograph& black, int late) {
    DriftReference reference;
    reference.white = linear_mean(white);
    reference.black = linear_mean(black);
    reference.exposure_s = white.exposure_s;
    reference.late = late;
    const auto channels = static_cast<std::size_t>(white.image.channels);
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (std::size_t i = std::min(c, channels - 1); i < white.image.values.size();
             i += channels)
            sum += linear_from_file_units(white, static_cast<double>(white.image.values[i])) -
                   linear_from_file_units(black, static_cast<double>(black.image.values[i]));
        reference.light[static_cast<int>(c)] = sum / static_cast<double>(white.image.pixel_count());
    }
    return reference;
}

Drift drift_between(const DriftReference& then, const DriftReference& now) {
    if (then.white.width != now.white.width || then.white.height != now.white.height)
        throw FileError("the camera's photographs",
                        "size",
                        fmt::format("{}x{}", now.white.width, now.white.height),
                        fmt::format("{}x{}, as at the calibration: set the camera as it was",
                                    then.white.width,
                                    then.white.height));
    const ImageF lit = difference(then.white, then.black, 1.0);
    const float brightest = quantile(lit.values, 0.999);
    if (!(brightest > 0.0f))
        throw Refused("the calibration's photographs show no light of the projector",
                      "calibrate anew");
    Drift drift;
    std::vector<float> room;
    for (std::size_t i = 0; i < lit.values.size(); i += 3)
        if (lit.values[i] > 0.1f * brightest)
            room.push_back((now.black.values[i] - then.black.values[i]) / lit.values[i]);
    drift.room_light = static_cast<double>(median(std::move(room)));
    drift.light_ratio = now.light / then.light;
    double light_then = 0.0, light_now = 0.0;
    for (std::size_t i = 0; i < lit.values.size(); ++i) {
        light_then += static_cast<double>(lit.values[i]);
        light_now += static_cast<double>(now.white.values[i] - now.black.values[i]);
    }
    const double brightness = light_now / light_then;
    if (!(brightness > 0.02))
        throw Refused("no light of the projector is seen on the mock-up any more",
                      "take the cap off the lens, and see whether the projector shows pictures");

    const auto before = pyramid_of(lit);
    const auto after = pyramid_of(difference(now.white, now.black, 1.0 / brightness));
    // Blocks whose place the noise leaves open by less than a twentieth of a pixel: the standard
    // deviation is noise over the square root of the eigenvalue, of two pictures.
    constexpr double kOpen_px = 0.05;
    const double noise = noise_of(lit, 0.1f * brightest);
    std::vector<glm::dvec2> centres;
    for (int y = kWindow_px; y + kWindow_px < lit.height; y += kWindow_px)
        for (int x = kWindow_px; x + kWindow_px < lit.width; x += kWindow_px) {
            const Normal normal = normal_of(lit, lit, {x, y}, {0.0, 0.0});
            const double level = std::sqrt(normal.energy) / (kWindow_px + 1);
            const bool detailed =
                normal.smaller_eigenvalue() > 2.0 * noise * noise / (kOpen_px * kOpen_px) &&
                normal.smaller_eigenvalue() > 1e-5 * normal.energy;
            if (level > 0.05 * static_cast<double>(brightest) && detailed)
                centres.emplace_back(x, y);
        }
    std::vector<double> shifts(centres.size());
    parallel_for(centres.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto shift = follow(before, after, centres[k]);
            shifts[k] = shift ? glm::length(*shift) : std::numeric_limits<double>::quiet_NaN();
        }
    });
    std::erase_if(shifts, [](double shift) { return !std::isfinite(shift); });
    drift.blocks = static_cast<int>(shifts.size());
    drift.lost = static_cast<int>(centres.size() - shifts.size());
    if (centres.empty())
        throw Refused(
            "nothing on the mock-up has detail that could be followed",
            "bring the camera nearer, so that outlines are in its picture, and calibrate");
    drift.shift_median_px = median(shifts);
    drift.shift_p95_px = quantile(shifts, 0.95);
    return drift;
}

Drift drift_where_both_lit(DriftReference then, const DriftReference& now) {
    const ImageF light = difference(now.white, now.black, 1.0);
    const float least = 0.1f * quantile(light.values, 0.999);
    // What lies at the border keeps its outline: a little around what is lit counts too.
    constexpr int kAround_px = 3;
    const auto near_light = [&](int x, int y) {
        for (int v = std::max(0, y - kAround_px); v <= std::min(light.height - 1, y + kAround_px);
             ++v)
            for (int u = std::max(0, x - kAround_px);
                 u <= std::min(light.width - 1, x + kAround_px);
                 ++u)
                if (light.at(u, v) > least) return true;
        return false;
    };
    if (then.white.width == light.width && then.white.height == light.height)
        for (int y = 0; y < light.height; ++y)
            for (int x = 0; x < light.width; ++x)
                if (!near_light(x, y)) then.white.at(x, y) = then.black.at(x, y);
    return drift_between(then, now);
}

DriftReference photograph_ends(const BenchPorts& ports,
                               const DriftReference& then,
                               const Image8& mockup,
                               const Progress& progress) {
    constexpr int kPatience = 8;  // photographs of a projector that has just been found
    const auto show = [&](bool lit, const char* role) {
        Image8 drive(mockup.width, mockup.height, 3);
        for (std::size_t i = 0; lit && i < drive.values.size(); ++i)
            drive.values[i] = mockup.values[i / 3] ? 255 : 0;
        if (ports.announce) ports.announce(role);
        ports.show(drive);
        Photograph photograph = ports.photograph(then.exposure_s);
        for (int waited = 0; waited < then.late; ++waited)
            photograph = ports.photograph(then.exposure_s);
        return photograph;
    };
    const auto light = [&](const Photograph& white, const Photograph& black) {
        return drift_reference(white, black, then.late).light.y / then.light.y;
    };
    progress.update(0.1, "photographing black");
    const Photograph black = show(false, "black");
    progress.update(0.3, "photographing white");
    Photograph white = show(true, "white");
    for (int waited = 0; waited < kPatience && !(light(white, black) > 0.5); ++waited) {
        progress.update(0.4, "waiting for white");
        white = ports.photograph(then.exposure_s);
        if (light(white, black) > 0.5) white = ports.photograph(then.exposure_s);  // all of it
    }
    return drift_reference(white, black, then.late);
}

Drift look_for_drift(const BenchPorts& ports,
                     const DriftReference& then,
                     const Image8& mockup,
                     const Progress& progress) {
    const DriftReference now = photograph_ends(ports, then, mockup, progress);
    progress.update(0.9, "comparing");
    return drift_between(then, now);
}

std::vector<GradedFigure> grade_figures(const Drift& drift) {
    std::vector<GradedFigure> figures;
    const int all = drift.blocks + drift.lost;
    const bool far = 2 * drift.lost > all;
    GradedFigure moved{
        "Moved by",
        far ? std::string("too far to say") : fmt::format("{:.2f} px", drift.shift_median_px),
        "camera pixels, median; good under 0.3, usable under 1",
        fmt::format("How far what the camera sees on the mock-up is from where it was; {} of {} "
                    "places are found again.",
                    drift.blocks,
                    all),
        "The mock-up, the camera or the projector was bumped: find where everything stands again.",
        far ? Grade::bad : grade_of(drift.shift_median_px, 0.3, 1.0)};
    figures.push_back(std::move(moved));
    const glm::dvec3 changed = glm::abs(drift.light_ratio - 1.0);
    figures.push_back(graded_share("Light changed by",
                                   worse_of({changed.x, changed.y, changed.z}),
                                   0.03,
                                   0.10,
                                   "The projector's light on the mock-up against that of the "
                                   "calibration, the channel that differs most.",
                                   "Let the lamp warm up and set the projector as it was; if it "
                                   "stays so, photograph the colours again."));
    figures.push_back(graded_share("Room light changed by",
                                   std::abs(drift.room_light),
                                   0.01,
                                   0.05,
                                   "Light that is there while the projector shows black, over its "
                                   "white.",
                                   "Darken the room as it was."));
    return figures;
}

}  // namespace livery
