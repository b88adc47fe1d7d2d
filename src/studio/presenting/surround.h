// What stands beside the mock-up while a vote is presented: codes, the time left, a QR code. Grey,
// and never on a pixel that a frozen frame lights.
#pragma once

#include <optional>
#include <vector>

#include "core/image.h"
#include "evaluation/phone_page.h"

namespace livery {

/// 255 where any of the pictures has light; one channel.
void add_lit_pixels(const Image8& picture, Image8& lit);

/// The largest place of this shape (width over height) that none of the lit pixels is in or near:
/// in a corner or at the middle of an edge. Nothing where all would be too small to read.
std::optional<PixelRectangle> free_place(const Image8& lit, double aspect);

/// Width over height of the place for a number and a bar.
inline constexpr double kNumberPlaceAspect = 1.7;

/// A number over a bar that is `fraction` long; neither where they are not given.
void draw_surround(Image8& picture,
                   const PixelRectangle& place,
                   std::optional<int> number,
                   std::optional<double> fraction);

/// With its quiet zone, as large as fits.
void draw_qr_code(Image8& picture, const PixelRectangle& place, const QrCode& code);

}  // namespace livery
