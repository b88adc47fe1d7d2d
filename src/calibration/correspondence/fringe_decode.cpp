#include "calibration/correspondence/fringe_decode.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "calibration/captures/exposure_merge.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr auto kPeriod = static_cast<float>(kFringePeriod_px);
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kBlock = 1024;

/// What a pixel must have to be refined, and what it is refined with.
struct Limits {
    float noise_offset, noise_slope, least_variance;
    float most_apart;          ///< projector pixels between the two codes
    float full_amplitude;      ///< of a fringe over full light, where all of it is direct
    float least_direct_share;  ///< of full light
    float share_noise;  ///< variance of that share of light less direct, over twice the noise's
    float last_column, last_row;
};

struct RefinedPixels {
    std::size_t fine = 0, contradicted = 0, global = 0;
};

/// One axis of a block: the place next to the whole pixel's, and the square of its error.
struct AxisBlock {
    std::array<float, kBlock> place, apart, amplitude, noise, variance_px;
};

void solve_axis(const FringeAxis& axis,
                std::size_t offset,
                std::size_t count,
                const float* whole_px,
                const Limits& limits,
                AxisBlock& block) {
    constexpr float kErrorPerNoise =
        kPeriod * kPeriod / (4.0f * std::numbers::pi_v<float> * std::numbers::pi_v<float>)*2.0f /
        kFringeShifts;
    for (std::size_t i = 0; i < count; ++i) {
        const FringeValue fringe = fringe_at(axis, offset + i);
        // The period: of the places that differ by whole ones, the nearest to the Gray code's.
        const float off = whole_px[2 * i] - fringe.place_px;
        const float place = fringe.place_px + kPeriod * rounded(off * (1.0f / kPeriod));
        const float variance =
            std::max(limits.noise_offset + limits.noise_slope * fringe.mean, limits.least_variance);
        block.place[i] = place;
        block.apart[i] = std::abs(place - whole_px[2 * i]);
        block.amplitude[i] = fringe.amplitude;
        block.noise[i] = variance;
        block.variance_px[i] = kErrorPerNoise * variance / (fringe.amplitude * fringe.amplitude);
    }
}

/// The block's places, errors and light from both axes.
RefinedPixels refine_block(const FringeAxes& axes,
                           const Limits& limits,
                           float lit_threshold,
                           std::size_t offset,
                           std::size_t count,
                           FineCode& code) {
    float* const places = code.places.projector_px.values.data() + 2 * offset;
    float* const sigmas = code.places.sigma_px.values.data() + 2 * offset;
    std::uint8_t* const decoded = code.places.decoded.values.data() + offset;
    AxisBlock columns, rows;
    solve_axis(axes.columns, offset, count, places, limits, columns);
    solve_axis(axes.rows, offset, count, places + 1, limits, rows);
    constexpr float kWorst = kWholePixelError * kWholePixelError;
    RefinedPixels counts;
    for (std::size_t i = 0; i < count; ++i) {
        const float light = axes.white[offset + i] - axes.black[offset + i];
        const bool lit = light > lit_threshold;
        const float amplitude = 0.5f * (columns.amplitude[i] + rows.amplitude[i]);
        const float direct = amplitude / limits.full_amplitude;
        code.light.direct.values[offset + i] = lit ? direct : kNan;
        code.light.global.values[offset + i] = lit ? light - direct : kNan;
        const bool was = decoded[i] != 0;
        // Three deviations under the least share: in the dark, noise is not light from elsewhere.
        const float missing = limits.least_direct_share * light - direct;
        const bool global =
            was & (missing > 0.0f) &
            (missing * missing > 9.0f * limits.share_noise * (columns.noise[i] + rows.noise[i]));
        const bool sure = (columns.variance_px[i] <= kWorst) & (rows.variance_px[i] <= kWorst);
        const bool agree =
            (columns.apart[i] <= limits.most_apart) & (rows.apart[i] <= limits.most_apart);
        const bool fine = was & !global & sure & agree;
        counts.fine += fine;
        counts.contradicted += was & !global & sure & !agree;
        counts.global += global;
        code.light.global_dominates.values[offset + i] = global ? 255 : 0;
        decoded[i] = was & !global ? 255 : 0;
        const float kept = was & !global ? kWholePixelError : kNan;
        sigmas[2 * i] = fine ? std::sqrt(columns.variance_px[i]) : kept;
        sigmas[2 * i + 1] = fine ? std::sqrt(rows.variance_px[i]) : kept;
        const float column = std::min(std::max(columns.place[i], 0.0f), limits.last_column);
        const float row = std::min(std::max(rows.place[i], 0.0f), limits.last_row);
        places[2 * i] = fine ? column : (global ? kNan : places[2 * i]);
        places[2 * i + 1] = fine ? row : (global ? kNan : places[2 * i + 1]);
    }
    return counts;
}

Limits limits_of(const FringeEvidence& evidence, int projector_width, int projector_height) {
    // Half of the best tenth: where less is direct, what other parts send is as bright, and has
    // fringes of its own where those parts are near.
    constexpr double kLeastShare = 0.5;
    Limits limits{};
    limits.noise_offset = static_cast<float>(evidence.noise.offset);
    limits.noise_slope = static_cast<float>(evidence.noise.slope);
    limits.least_variance = static_cast<float>(evidence.noise.least);
    limits.most_apart = static_cast<float>(evidence.most_apart_px);
    limits.full_amplitude = static_cast<float>(evidence.full_amplitude);
    limits.least_direct_share =
        static_cast<float>(kLeastShare * evidence.best_amplitude / evidence.full_amplitude);
    // Of the mean of two amplitudes, and of white and black
    limits.share_noise =
        0.5f * (1.0f / (kFringeShifts * limits.full_amplitude * limits.full_amplitude) +
                2.0f * limits.least_direct_share * limits.least_direct_share);
    limits.last_column = std::nextafter(static_cast<float>(projector_width), 0.0f);
    limits.last_row = std::nextafter(static_cast<float>(projector_height), 0.0f);
    return limits;
}

}  // namespace

FineCode refine_by_fringes(const std::vector<RoledPhotograph>& photographs,
                           CameraToProjector gray_code,
                           int projector_width,
                           int projector_height) {
    std::vector<std::string> roles;
    for (const RoledPhotograph& one : photographs) roles.push_back(one.role);
    check_argument(check_fringes("captures", roles), "refine_by_fringes: no fringes");
    const auto white = std::find_if(photographs.begin(),
                                    photographs.end(),
                                    [](const RoledPhotograph& one) { return one.role == "white"; });
    check_argument(white != photographs.end(), "refine_by_fringes: no white");
    check_argument(gray_code.decoded.width == white->photograph.image.width &&
                       gray_code.decoded.height == white->photograph.image.height,
                   "refine_by_fringes: the Gray code was decoded from photographs of another size");
    const ImageF white_light = exposed_alike(photographs, "white", *white);
    const ImageF black_light = exposed_alike(photographs, "black", *white);
    std::vector<ImageF> fringes;
    for (const std::string& role : fringe_roles())
        fringes.push_back(exposed_alike(photographs, role, *white));
    FringeAxes axes;
    for (std::size_t n = 0; n < kFringeShifts; ++n) {
        axes.columns.shifts[n] = fringes[n].values.data();
        axes.rows.shifts[n] = fringes[kFringeShifts + n].values.data();
    }
    axes.white = white_light.values.data();
    axes.black = black_light.values.data();

    const FringeEvidence evidence = evidence_of(axes, gray_code);
    const Limits limits = limits_of(evidence, projector_width, projector_height);
    FineCode code;
    code.places = std::move(gray_code);
    const int width = code.places.decoded.width, height = code.places.decoded.height;
    code.places.sigma_px = ImageF(width, height, 2);
    code.light = {ImageF(width, height, 1), ImageF(width, height, 1), Image8(width, height, 1)};
    const auto lit_threshold = static_cast<float>(code.places.lit_threshold);
    const std::size_t pixels = code.places.decoded.pixel_count();
    std::atomic<std::size_t> fine{0}, contradicted{0}, global{0};
    parallel_for((pixels + kBlock - 1) / kBlock, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            const std::size_t offset = block * kBlock;
            const RefinedPixels counts = refine_block(
                axes, limits, lit_threshold, offset, std::min(kBlock, pixels - offset), code);
            fine += counts.fine;
            contradicted += counts.contradicted;
            global += counts.global;
        }
    });
    const auto share = [&](std::size_t count) {
        return static_cast<double>(count) / static_cast<double>(evidence.decoded);
    };
    code.report.fine_fraction = share(fine);
    code.report.contradicted_fraction = share(contradicted);
    code.report.global_fraction = share(global);
    code.report.median_sigma_px = evidence.median_sigma_px;
    code.report.mean_light = evidence.mean_light;
    code.report.response_power = evidence.response_power;
    refuse_foreign_fringes(evidence, code.report.contradicted_fraction);
    return code;
}

FineCode decode_places(const std::vector<RoledPhotograph>& photographs,
                       int projector_width,
                       int projector_height,
                       double lit_threshold) {
    std::vector<std::string> roles;
    for (const RoledPhotograph& one : photographs) roles.push_back(one.role);
    const bool fringes = check_fringes("captures", roles);
    CameraToProjector gray =
        decode_gray_code(photographs, projector_width, projector_height, lit_threshold);
    if (!fringes) return {std::move(gray), {}, {}};
    return refine_by_fringes(photographs, std::move(gray), projector_width, projector_height);
}

namespace {

constexpr std::size_t kSamples = 60000;

struct FringeSample {
    FringeValue column, row;
    float light;                ///< white - black
    float black;                ///< file units
    float column_off, row_off;  ///< the fringes' place less the Gray code's
};

float off_of(const FringeValue& fringe, float whole_px) {
    const float off = fringe.place_px - whole_px;
    return off - kFringePeriod_px * rounded(off / kFringePeriod_px);
}

/// Noise by how the columns' and the rows' mean differ: the scene is the same in both. A steady
/// difference (the lamp) is none.
FringeNoise noise_of(const std::vector<FringeSample>& samples) {
    const std::size_t most_bins = std::min<std::size_t>(12, samples.size() / 16);
    std::vector<std::size_t> order(samples.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    // White is another photograph: by the columns' mean, bins would hold those of alike noise.
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return samples[a].light < samples[b].light;
    });
    struct Bin {
        double value, variance;
    };
    std::vector<Bin> bins;
    for (std::size_t k = 0; k < most_bins; ++k) {
        const std::size_t from = k * order.size() / most_bins;
        const std::size_t to = (k + 1) * order.size() / most_bins;
        std::vector<float> differences;
        double value = 0.0;
        for (std::size_t i = from; i < to; ++i) {
            const FringeSample& sample = samples[order[i]];
            differences.push_back(sample.column.mean - sample.row.mean);
            value += static_cast<double>(sample.column.mean) / static_cast<double>(to - from);
        }
        const float middle = median(differences);
        for (float& difference : differences) difference = std::abs(difference - middle);
        const double deviation = static_cast<double>(median(std::move(differences))) / 0.6745;
        bins.push_back({value, 0.5 * kFringeShifts * deviation * deviation});
    }
    // Least squares of relative errors
    double w = 0.0, wx = 0.0, wxx = 0.0, wy = 0.0, wxy = 0.0;
    FringeNoise noise;
    noise.least = std::numeric_limits<double>::infinity();
    for (const Bin& bin : bins) {
        noise.least = std::min(noise.least, 0.5 * bin.variance);
        if (!(bin.variance > 0.0)) continue;
        const double weight = 1.0 / (bin.variance * bin.variance);
        w += weight;
        wx += weight * bin.value;
        wxx += weight * bin.value * bin.value;
        wy += weight * bin.variance;
        wxy += weight * bin.value * bin.variance;
    }
    const double determinant = w * wxx - wx * wx;
    if (determinant > 1e-9 * w * wxx) {
        noise.slope = std::max(0.0, (w * wxy - wx * wy) / determinant);
        noise.offset = (wy - noise.slope * wx) / w;
    } else if (w > 0.0) {
        noise.offset = wy / w;
    }
    return noise;
}

double power_of_mean(double mean_light) {
    double low = 0.2, high = 8.0;  // the mean falls with the power
    for (int round = 0; round < 40; ++round) {
        const double middle = 0.5 * (low + high);
        (fringe_of_power(middle).mean > mean_light ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Largest over smallest median of amplitude / light along a period, less 1: one of a set of
/// shifts that stands in another's place makes it rise and fall.
double ripple_of(const std::vector<FringeSample>& samples, FringeValue FringeSample::*axis) {
    constexpr std::size_t kBins = 8;
    std::array<std::vector<float>, kBins> bins;
    for (const FringeSample& sample : samples) {
        const FringeValue& fringe = sample.*axis;
        const auto bin = static_cast<std::size_t>(fringe.place_px * kBins / kFringePeriod_px);
        bins[std::min(bin, kBins - 1)].push_back(fringe.amplitude / sample.light);
    }
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (std::vector<float>& bin : bins) {
        if (bin.size() < 64) continue;
        const auto here = static_cast<double>(median(std::move(bin)));
        low = std::min(low, here);
        high = std::max(high, here);
    }
    return high > low ? high / low - 1.0 : 0.0;
}

}  // namespace

FringeOfPower fringe_of_power(double power) {
    constexpr int kSteps = 64;
    FringeOfPower fringe{0.0, 0.0};
    for (int k = 0; k < kSteps; ++k) {
        const double place = kFringePeriod_px * (k + 0.5) / kSteps;
        const double light = std::pow(fringe_drive(place, 0) / 255.0, power);
        fringe.mean += light / kSteps;
        fringe.amplitude +=
            2.0 / kSteps * light * std::cos(2.0 * std::numbers::pi * place / kFringePeriod_px);
    }
    return fringe;
}

FringeEvidence evidence_of(const FringeAxes& axes, const CameraToProjector& gray_code) {
    FringeEvidence evidence;
    for (const std::uint8_t one : gray_code.decoded.values) evidence.decoded += one != 0;
    const std::size_t step = std::max<std::size_t>(1, evidence.decoded / kSamples) | 1u;
    std::vector<FringeSample> samples;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < gray_code.decoded.values.size(); ++i) {
        if (!gray_code.decoded.values[i] || seen++ % step != 0) continue;
        FringeSample sample{fringe_at(axes.columns, i),
                            fringe_at(axes.rows, i),
                            axes.white[i] - axes.black[i],
                            axes.black[i],
                            0.0f,
                            0.0f};
        // Not where a photograph is saturated.
        if (!std::isfinite(sample.column.mean) || !std::isfinite(sample.row.mean) ||
            !(sample.light > 0.0f))
            continue;
        sample.column_off = off_of(sample.column, gray_code.projector_px.values[2 * i]);
        sample.row_off = off_of(sample.row, gray_code.projector_px.values[2 * i + 1]);
        samples.push_back(sample);
    }
    if (samples.size() < 64)
        throw Refused(
            "nearly all photographs of the fringes are saturated where the Gray code was "
            "decoded",
            "shorten the exposure until white on the mock-up stays under 85% of full "
            "scale, and repeat all photographs");
    evidence.noise = noise_of(samples);

    std::vector<float> means, amplitudes, sigmas, off;
    std::array<std::vector<float>, 2> signed_off;
    const double error_per_noise =
        kFringePeriod_px / (2.0 * std::numbers::pi) * std::sqrt(2.0 / kFringeShifts);
    for (const FringeSample& sample : samples) {
        means.push_back((0.5f * (sample.column.mean + sample.row.mean) - sample.black) /
                        sample.light);
        amplitudes.push_back(0.5f * (sample.column.amplitude + sample.row.amplitude) /
                             sample.light);
        for (const FringeValue& fringe : {sample.column, sample.row})
            sigmas.push_back(static_cast<float>(
                error_per_noise *
                std::sqrt(evidence.noise.variance_at(static_cast<double>(fringe.mean))) /
                std::max(static_cast<double>(fringe.amplitude), 1e-30)));
        off.push_back(std::max(std::abs(sample.column_off), std::abs(sample.row_off)));
        signed_off[0].push_back(sample.column_off);
        signed_off[1].push_back(sample.row_off);
    }
    evidence.mean_light = static_cast<double>(median(std::move(means)));
    evidence.response_power = power_of_mean(evidence.mean_light);
    evidence.full_amplitude = fringe_of_power(evidence.response_power).amplitude;
    evidence.best_amplitude = static_cast<double>(quantile(std::move(amplitudes), 0.9));
    evidence.median_sigma_px = static_cast<double>(median(std::move(sigmas)));
    // A sharp picture's codes differ by half a pixel; where blur hides the finest stripes, more.
    evidence.most_apart_px =
        std::clamp(6.0 * static_cast<double>(median(std::move(off))), 1.5, 6.0);
    const std::array<double, 2> shift{
        std::abs(static_cast<double>(median(std::move(signed_off[0])))),
        std::abs(static_cast<double>(median(std::move(signed_off[1]))))};
    const std::array<double, 2> ripple{ripple_of(samples, &FringeSample::column),
                                       ripple_of(samples, &FringeSample::row)};
    evidence.shift_px = std::max(shift[0], shift[1]);
    evidence.amplitude_ripple = std::max(ripple[0], ripple[1]);
    evidence.worse_is_rows = shift[1] + ripple[1] > shift[0] + ripple[0];
    return evidence;
}

void refuse_foreign_fringes(const FringeEvidence& evidence, double contradicted_fraction) {
    // A tenth of what a sharp picture has: blur of 5.5 px.
    if (evidence.best_amplitude < 0.05)
        throw Refused("no fringes are to be seen in the photographs of fringes",
                      "check that each photograph shows the picture of its phase role, and the "
                      "focus");
    // The Gray code's rounding moves the median by .1 px at most, noise and harmonics the amplitude
    // by some percent; the smallest exchange, of two neighbouring shifts, by 70%.
    constexpr double kMostShift_px = 0.75, kMostRipple = 0.25, kMostContradicted = 0.15;
    if (evidence.shift_px <= kMostShift_px && evidence.amplitude_ripple <= kMostRipple &&
        contradicted_fraction <= kMostContradicted)
        return;
    const std::string axis = evidence.worse_is_rows ? "phase-row-N" : "phase-column-N";
    throw Refused(
        "the photographs of the fringes do not fit the Gray code (most of all " + axis + ")",
        "check which file has which phase role in manifest.json, that each picture is "
        "shown when its photograph is taken, and that nothing moves; without the "
        "photographs of fringes the Gray code alone is used");
}

}  // namespace livery
