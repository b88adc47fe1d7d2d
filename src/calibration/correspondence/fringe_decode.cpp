#include "calibration/correspondence/fringe_decode.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "calibration/correspondence/exposed_alike.h"
#include "calibration/correspondence/fringe_evidence.h"
#include "core/error.h"
#include "core/parallel.h"

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

}  // namespace livery
