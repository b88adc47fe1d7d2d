// Stripes of unequal widths and their inverse: where in the camera's picture their borders lie.
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "scene/view.h"

namespace livery {

/// Dark before edges[0], lit from there to edges[1], and so on: an even edge rises.
struct StripeCode {
    int width = 0, height = 0;  ///< projector pixels
    bool rows = false;          ///< stripes of rows, not of columns
    std::vector<int> edges;     ///< first pixel of each stripe but the first, ascending

    /// A place in the projector's picture across the stripes.
    double across(const glm::dvec2& projector_px) const {
        return rows ? projector_px.y : projector_px.x;
    }
    double mean_stripe_px() const;
    /// The nearest edge of that sign.
    double nearest_edge(double across_px, bool rising) const;
};

/// Stripes of a 1/80 of the projector's width, at least 4 pixels, each longer or shorter by up to a
/// third: a shift by a whole period, which regular stripes leave open, fits nowhere. So wide, a
/// shift of half a mean period is a bump of a centimetre and more. Throws std::invalid_argument for
/// sizes that no pattern has.
StripeCode stripe_code(int width, int height, bool rows);

/// Whether the camera looks at `middle_mm` past the projector from above or below rather than from
/// a side: a surface's depth then shows in rows.
bool wants_rows(const View& projector, const View& camera, const glm::dvec3& middle_mm);

/// "repose" or "repose-inverse".
std::string stripe_role(bool inverse);
Image8 stripe_picture(const StripeCode& code, bool inverse);

/// A border between two stripes as the camera sees it.
struct StripeCrossing {
    glm::dvec2 camera_px{0.0};
    bool rising = false;  ///< dark to lit as the projector's column (row) grows
};

/// (a - b) / (a + b) of the two photographs' light, its zeros found to a part of a pixel along the
/// camera's rows, or its columns where the stripes lie along the rows.
struct StripeSight {
    ImageF signal;      ///< NaN where hardly any light is
    bool down = false;  ///< zeros are looked for along columns
    bool grows = true;  ///< whether the projector's column (row) grows along them
    std::vector<StripeCrossing> crossings;

    /// The crossing of that sign nearest to a place along the way that zeros are looked for, minus
    /// the place; NaN: none within `within_px`.
    double offset_of(const glm::dvec2& camera_px, bool rising, double within_px) const;
};

/// `uphill`: the way in the camera's picture in which the projector's column (row) grows. Throws
/// FileError for photographs of unequal sizes, Refused where no light is seen.
StripeSight see_stripes(const Photograph& stripes,
                        const Photograph& inverse,
                        const glm::dvec2& uphill);

}  // namespace livery
