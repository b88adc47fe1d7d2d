// Photographs of fringes -> places within a projector pixel, how sure they are, and how much of the
// light comes straight from the projector.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"

namespace livery {

/// Light of full white less black, in the units of the photograph of white, one channel each; NaN
/// where the Gray code found no light.
struct SeparatedLight {
    ImageF direct;  ///< by the fringes: straight from the projector, once reflected
    ImageF global;  ///< the rest: from other parts, through the material, scattered in the lens
    Image8 global_dominates;  ///< 255 where decoding refused the pixel for it
};

struct FringeReport {
    double fine_fraction = 0.0;          ///< of the pixels that the Gray code decoded
    double contradicted_fraction = 0.0;  ///< the two differ: the whole pixel was kept
    double global_fraction = 0.0;        ///< no longer decoded: light from elsewhere dominates
    double median_sigma_px = 0.0;        ///< standard error of the fine places
    double mean_light = 0.0;             ///< of a fringe over full white, as photographed
    double response_power = 0.0;         ///< of the power law that gives fringes this mean
};

struct FineCode {
    CameraToProjector places;
    SeparatedLight light;  ///< empty pictures where no fringes were photographed
    FringeReport report;
};

/// Puts the fringes' places into what the Gray code decoded. With five shifts of light
/// I_n = D + A cos(2 pi (x / period - n / 5)), least squares gives D, A and x; the period is the
/// one in which x lies next to the Gray code's place, so that its being off by less than half a
/// period does no harm. Per pixel:
/// - the standard error is period / 2 pi * sqrt(2 / 5) * noise / A, the Cramer-Rao bound; the
///   noise's variance is linear in D (read and shot noise), fitted to how much D of the columns'
///   fringes and of the rows' differ;
/// - the whole pixel stays where that error is larger than the whole pixel's own, a photograph is
///   saturated, or the two codes contradict each other (a pixel across an edge);
/// - direct light is A over the amplitude of a fringe of full light (Nayar, Krishnan, Grossberg,
///   Raskar 2006, with all shifts in the place of the largest and the smallest value): the mean of
///   a fringe over white, which blur and other parts do not change, tells the response's power, and
///   that the amplitude. What blur takes from the fringes counts as global; the pixel is refused
///   where the direct share is under half of what the best tenth of the picture has.
/// Throws FileError as check_fringes() and for unequal sizes, Refused where the fringes do not
/// belong to the Gray code: photographs exchanged, or something moved.
FineCode refine_by_fringes(const std::vector<RoledPhotograph>& photographs,
                           CameraToProjector gray_code,
                           int projector_width,
                           int projector_height);

/// The best that the photographs tell: decode_gray_code(), and refine_by_fringes() where there are
/// fringes. Throws as the two.
FineCode decode_places(const std::vector<RoledPhotograph>& photographs,
                       int projector_width,
                       int projector_height,
                       double lit_threshold = -1.0);

/// The shifts of one axis as planes of one size and exposure.
struct FringeAxis {
    std::array<const float*, kFringeShifts> shifts{};
};
struct FringeAxes {
    FringeAxis columns, rows;
    const float* white = nullptr;
    const float* black = nullptr;
};

/// Of one pixel, least squares over the shifts.
struct FringeValue {
    float mean, amplitude;
    float place_px;  ///< within the first period, 0 to kFringePeriod_px
};

/// The nearest whole number; 4096 for NaN and whatever is larger. No function call: loops with it
/// vectorise.
inline float rounded(float value) {
    const float within = std::max(-4096.0f, std::min(4096.0f, value));  // NaN becomes 4096
    return static_cast<float>(static_cast<int>(within + 4096.5f) - 4096);
}

/// atan2 in turns, 0 to 1, by a polynomial of degree 11: within 2e-6 turns, which is 3e-5 projector
/// pixels. No function call: loops with it vectorise.
inline float turns_of(float sine, float cosine) {
    constexpr float kTurn = 0.5f / std::numbers::pi_v<float>;
    const float s = std::abs(sine), c = std::abs(cosine);
    const float t = std::min(s, c) / (std::max(s, c) + 1e-30f);
    const float t2 = t * t;
    float turns =
        kTurn * t *
        (0.99997726f +
         t2 * (-0.33262347f +
               t2 * (0.19354346f + t2 * (-0.11643287f + t2 * (0.05265332f + t2 * -0.01172120f)))));
    turns = s > c ? 0.25f - turns : turns;
    turns = cosine < 0.0f ? 0.5f - turns : turns;
    return sine < 0.0f ? 1.0f - turns : turns;
}

inline FringeValue fringe_at(const FringeAxis& axis, std::size_t i) {
    static_assert(kFringeShifts == 5);
    // Cosine and sine of n fifths of a turn.
    constexpr float kCosine[] = {1.0f, 0.30901699f, -0.80901699f, -0.80901699f, 0.30901699f};
    constexpr float kSine[] = {0.0f, 0.95105652f, 0.58778525f, -0.58778525f, -0.95105652f};
    float sum = 0.0f, cosine = 0.0f, sine = 0.0f;
    for (std::size_t n = 0; n < kFringeShifts; ++n) {
        const float value = axis.shifts[n][i];
        sum += value;
        cosine += kCosine[n] * value;
        sine += kSine[n] * value;
    }
    return {sum * (1.0f / kFringeShifts),
            (2.0f / kFringeShifts) * std::sqrt(cosine * cosine + sine * sine),
            kFringePeriod_px * turns_of(sine, cosine)};
}

/// Variance of one pixel of one photograph: offset + slope * value, at least `least`.
struct FringeNoise {
    double offset = 0.0, slope = 0.0, least = 0.0;
    double variance_at(double value) const { return std::max(offset + slope * value, least); }
};

struct FringeEvidence {
    std::size_t decoded = 0;  ///< pixels that the Gray code decoded
    FringeNoise noise;
    double mean_light = 0.0;      ///< median of (mean - black) / (white - black)
    double response_power = 0.0;  ///< of the power law whose fringes have that mean
    double full_amplitude = 0.0;  ///< of such a fringe, over full white
    double best_amplitude = 0.0;  ///< of (amplitude / (white - black)): exceeded by a tenth
    double most_apart_px = 0.0;   ///< between the two codes, over which they contradict each other
    double median_sigma_px = 0.0;
    double shift_px = 0.0;          ///< median of the codes' difference, of the worse axis
    double amplitude_ripple = 0.0;  ///< largest over smallest median amplitude along a period, - 1
    bool worse_is_rows = false;     ///< of the last two
};

/// From some 60,000 of the decoded pixels. Throws Refused where hardly any of them shows fringes.
FringeEvidence evidence_of(const FringeAxes& axes, const CameraToProjector& gray_code);

/// Throws Refused where the fringes cannot be of the Gray code's picture.
void refuse_foreign_fringes(const FringeEvidence& evidence, double contradicted_fraction);

/// Mean of a fringe over full white, and its amplitude, under a response of that power.
struct FringeOfPower {
    double mean, amplitude;
};
FringeOfPower fringe_of_power(double power);

}  // namespace livery
