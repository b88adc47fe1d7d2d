#include "calibration/captures/captures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <glm/vec2.hpp>

#include "calibration/captures/exposure_merge.h"
#include "calibration/colour/colour_report.h"
#include "calibration/correspondence/patterns.h"
#include "core/error.h"
#include "core/random.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kTriples = 5000;
constexpr int kTorn = 3;            // second difference of places; rounding alone gives up to 2
constexpr double kSmooth = 0.03;    // share of torn places in a whole map: silhouettes, shadows
constexpr double kWhole = 0.06;     // the same with some silhouettes in it
constexpr double kExplained = 0.6;  // of the torn places, at most, remain

/// Values of all stripe photographs at three camera pixels in a row or a column.
struct Stripes {
    std::vector<std::string> roles;  ///< first, its inverse, and so on; columns before rows
    int column_bits = 0, row_bits = 0;
    std::vector<std::vector<float>> at;  ///< one a photograph; three a triple
};

const Photograph* find(const std::vector<RoledPhotograph>& photographs, const std::string& role) {
    for (const RoledPhotograph& candidate : photographs)
        if (candidate.role == role) return &candidate.photograph;
    return nullptr;
}

float light_at(const Photograph& photo, int x, int y) {
    const float* const pixel = photo.image.pixel(x, y);
    float sum = 0.0f;
    const int channels = std::min(photo.image.channels, 3);
    for (int c = 0; c < channels; ++c) sum += pixel[c];
    return (sum / static_cast<float>(channels) - static_cast<float>(photo.black_level)) /
           static_cast<float>(photo.exposure_s);
}

std::optional<Stripes> sample(const std::vector<RoledPhotograph>& photographs,
                              int projector_width,
                              int projector_height) {
    Stripes stripes;
    stripes.column_bits = gray_code_bits(projector_width);
    stripes.row_bits = gray_code_bits(projector_height);
    std::vector<const Photograph*> pictures;
    stripes.roles = geometry_roles(projector_width, projector_height);
    stripes.roles.resize(stripes.roles.size() - 2);  // white and black
    for (const std::string& role : stripes.roles) {
        pictures.push_back(find(photographs, role));
        if (!pictures.back()) return std::nullopt;
    }
    const ImageF& first = pictures.front()->image;
    for (const Photograph* p : pictures)
        if (p->image.width != first.width || p->image.height != first.height) return std::nullopt;

    // Places where the stripes have something to say: the brightest sums
    Random random(7);
    struct Place {
        int x, y;
        bool along_x;
        float light;
    };
    std::vector<Place> places;
    for (std::size_t k = 0; k < 4 * kTriples; ++k) {
        const bool along_x = random.uniform() < 0.5;
        const int x = static_cast<int>(random.uniform() * (first.width - 3));
        const int y = static_cast<int>(random.uniform() * (first.height - 3));
        places.push_back(
            {x, y, along_x, light_at(*pictures[0], x, y) + light_at(*pictures[1], x, y)});
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        return a.light > b.light;
    });
    places.resize(kTriples);
    for (const Photograph* picture : pictures) {
        std::vector<float>& values = stripes.at.emplace_back();
        for (const Place& place : places)
            for (int k = 0; k < 3; ++k)
                values.push_back(light_at(*picture,
                                          place.x + (place.along_x ? k : 0),
                                          place.y + (place.along_x ? 0 : k)));
    }
    return stripes;
}

/// Share of the places where columns or rows do not run on evenly. `order`: the photograph that
/// stands for each role.
double torn(const Stripes& stripes, const std::vector<std::size_t>& order) {
    const std::size_t count = stripes.at.front().size();
    std::array<std::vector<int>, 2> code;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        code[axis].assign(count, 0);
        const int bits = axis == 0 ? stripes.column_bits : stripes.row_bits;
        const std::size_t from = axis == 0 ? 0 : static_cast<std::size_t>(2 * stripes.column_bits);
        for (int bit = 0; bit < bits; ++bit) {
            const std::size_t at = from + static_cast<std::size_t>(2 * bit);
            const float* const one = stripes.at[order[at]].data();
            const float* const inverse = stripes.at[order[at + 1]].data();
            for (std::size_t i = 0; i < count; ++i) {
                const int gray = one[i] > inverse[i] ? 1 : 0, before = code[axis][i];
                code[axis][i] = (before << 1) | (gray ^ (before & 1));
            }
        }
    }
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < count; i += 3)
        sum += std::any_of(code.begin(), code.end(), [&](const auto& c) {
            return std::abs(c[i] - 2 * c[i + 1] + c[i + 2]) >= kTorn;
        });
    return sum / static_cast<double>(count / 3);
}

/// Names the two stripe photographs (or the two bits) whose exchange explains why the decoded
/// places jump from camera pixel to camera pixel: with them put right, the places run on smoothly.
/// Nothing where the places run on smoothly, or no exchange helps. Photographs of one channel or
/// more; roles of other kinds are ignored.
std::optional<std::string> exchanged_stripes(const std::vector<RoledPhotograph>& photographs,
                                             int projector_width,
                                             int projector_height) {
    const auto stripes = sample(photographs, projector_width, projector_height);
    if (!stripes) return std::nullopt;
    std::vector<std::size_t> order(stripes->roles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const double as_named = torn(*stripes, order);
    if (as_named < kSmooth) return std::nullopt;

    double best = kExplained * as_named;
    std::string answer;
    const auto attempt = [&](const std::string& what) {
        const double here = torn(*stripes, order);
        if (here >= best) return;
        best = here;
        answer = what;
    };
    for (std::size_t a = 0; a < order.size(); ++a)
        for (std::size_t b = a + 1; b < order.size(); ++b) {
            std::swap(order[a], order[b]);
            attempt(stripes->roles[a] + " and " + stripes->roles[b]);
            std::swap(order[a], order[b]);
        }
    for (std::size_t a = 0; a < order.size(); a += 2)
        for (std::size_t b = a + 2; b < order.size(); b += 2) {
            const auto exchange = [&] {
                std::swap(order[a], order[b]);
                std::swap(order[a + 1], order[b + 1]);
            };
            exchange();
            attempt(stripes->roles[a] + " and " + stripes->roles[b] + " with their inverses");
            exchange();
        }
    // Photographs that are all wrong improve by chance with any exchange; two that are not, wholly.
    if (answer.empty() || best > kWhole) return std::nullopt;
    return answer;
}

/// Undoes a change of the light by `factor`. Room light is scaled with it: rightly for an exposure;
/// for a lamp wrongly, by a hundredth of itself at most, since it may not change by more while the
/// colours are photographed.
void divide_light(Photograph& photo, double factor) {
    const auto gain = static_cast<float>(1.0 / factor),
               black = static_cast<float>(photo.black_level);
    for (float& value : photo.image.values) value = black + (value - black) * gain;
}

/// Each as if it had been taken when bright-gray was, at the exposure of the others.
void take_out(const CaptureVerdict& verdict, std::vector<RoledPhotograph>& colours) {
    const auto bright = std::find_if(colours.begin(), colours.end(), [](const auto& colour) {
        return colour.role == "bright-gray";
    });
    if (bright == colours.end()) return;  // refused by name where the colours are sampled
    const double reference = verdict.drift.light_at(bright->photograph.taken_at);
    for (auto& [role, photograph] : colours) {
        if (role == "dark-gray") continue;  // hardly any of its light is the lamp's
        double light = verdict.drift.light_at(photograph.taken_at) / reference;
        const auto gain = verdict.gains.find(role);
        if (gain != verdict.gains.end()) light /= gain->second;
        if (light != 1.0) divide_light(photograph, light);
    }
}

}  // namespace

bool is_geometry_role(const std::string& role) {
    return role.starts_with("gray-column-") || role.starts_with("gray-row-") ||
           is_fringe_role(role) || role == "white" || role == "black";
}

void add_capture(Captures& captures, RoledPhotograph photograph) {
    ImageF& image = photograph.photograph.image;
    std::vector<CaptureSummary>& summaries = captures.summaries;
    CaptureSummary summary = summarise(photograph);
    const auto later = std::upper_bound(
        summaries.begin(), summaries.end(), summary, [](const auto& one, const auto& other) {
            return one.taken_at < other.taken_at;
        });
    summaries.insert(later, std::move(summary));
    captures.width = image.width;
    const bool geometry = is_geometry_role(photograph.role);
    if (geometry)
        image = is_fringe_role(photograph.role) ? unsaturated_mean(photograph.photograph)
                                                : mean_of_channels(image);
    (geometry ? captures.geometry : captures.colours).push_back(std::move(photograph));
}

CaptureVerdict judge_captures(const Captures& captures,
                              const CalibrationSettings& settings,
                              bool with_stripes) {
    if (with_stripes)
        if (const auto which =
                exchanged_stripes(captures.geometry, settings.width, settings.height))
            throw Refused("the photographs of " + *which + " are exchanged",
                          "check which file has which role in manifest.json, and that each "
                          "picture is shown when its photograph is taken");
    return check_captures(captures.summaries,
                          summary_block_px(captures.width),
                          {settings.dark_drive, settings.bright_drive});
}

ProjectorToCamera map_of_captures(const Captures& captures,
                                  int projector_width,
                                  int projector_height,
                                  std::vector<std::string>& warnings,
                                  SeparatedLight* light) {
    constexpr double kMuchGlobal = 0.05;
    FineCode code = decode_places(captures.geometry, projector_width, projector_height);
    ProjectorToCamera map = invert_map(code.places, projector_width, projector_height);
    if (code.report.global_fraction > kMuchGlobal)
        warnings.push_back(
            percent(code.report.global_fraction) +
            " of the camera pixels where the Gray code was decoded get most of their light from "
            "other parts, through the material, or blurred, and were left out: cover what shines "
            "on the mock-up with dark cloth, and check the focus over its whole depth");
    if (light) *light = std::move(code.light);
    if (is_mirrored(map))
        warnings.push_back(
            "the photographs are mirrored against the projector's picture: right with a mirror in "
            "the way or a projector set for rear projection; else the files are mirrored");
    return map;
}

ColourCalibration calibrate_judged(Captures& captures,
                                   const CaptureVerdict& verdict,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const CalibrationSettings& settings,
                                   const Progress& progress) {
    captures.geometry.clear();
    take_out(verdict, captures.colours);
    ColourCalibration calibration =
        calibrate_colour(captures.colours, patterns, map, settings, progress);
    calibration.warnings.insert(
        calibration.warnings.begin(), verdict.warnings.begin(), verdict.warnings.end());
    return calibration;
}

}  // namespace livery
