#include "calibration/correspondence/fringe_evidence.h"

#include <limits>
#include <vector>

#include "core/error.h"
#include "core/statistics.h"

namespace livery {
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
