// What the tests of the desktop start from, and what its projector should then be sent.
#pragma once

#include <filesystem>

#include <glm/vec2.hpp>

#include "core/image.h"
#include "session/document.h"

namespace livery {

/// The projector of most tests: a quarter of the default bench's pixels, which are drawn and
/// compared in a quarter of the time.
inline constexpr glm::ivec2 kSmallProjector_px{640, 400};
inline constexpr glm::ivec2 kFullProjector_px{1280, 800};

/// The calibration of the default bench with a projector of this size, made once for every build of
/// the program.
std::filesystem::path prepared_calibration(glm::ivec2 projector_px = kSmallProjector_px);

/// A session file with that calibration; at draft quality light is solved in a second. Returns the
/// document in it.
Document prepare_session(const std::filesystem::path& file,
                         Quality quality = Quality::draft,
                         glm::ivec2 projector_px = kSmallProjector_px);

/// Values of an 8-bit file, 3 channels.
Image8 read_png(const std::filesystem::path& file);

/// The projector's input for a look as `livery render` makes it: from scratch, in another process
/// and OpenGL context than the program under test, corrected on the processor. 3 channels, device
/// values.
Image8 expected_drive(const Document& document, int look_id);
/// The neutral grey that is as bright as this look in the mean, where the mock-up is.
Image8 expected_grey(const Document& document, int look_id);
/// expected_drive() with another paint on one part.
Image8 expected_drive(Document document,
                      int look_id,
                      const std::string& part,
                      const std::string& paint);

}  // namespace livery
