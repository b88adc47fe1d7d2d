// Photographs of fringes -> places within a projector pixel, how sure they are, and how much of the
// light comes straight from the projector.
#pragma once

#include "calibration/correspondence/fringes.h"
#include "calibration/correspondence/gray_code.h"

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

}  // namespace livery
