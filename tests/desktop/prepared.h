// What the tests of the desktop start from, and what its projector should then be sent.
#pragma once

#include <filesystem>

#include "core/image.h"
#include "session/document.h"

namespace livery {

/// The calibration of the default bench, made once for every build of the program.
std::filesystem::path prepared_calibration();

/// A session file with that calibration; at draft quality light is solved in a second. Returns the
/// document in it.
Document prepare_session(const std::filesystem::path& file, Quality quality = Quality::draft);

/// Values of an 8-bit file, 3 channels.
Image8 read_png(const std::filesystem::path& file);

/// The projector's input for a look, by `livery render`: another program run, another OpenGL
/// context, the CPU's compensation. 3 channels, device values.
Image8 expected_drive(const Document& document, int look_id);
/// The neutral grey that is as bright as this look in the mean, where the mock-up is.
Image8 expected_grey(const Document& document, int look_id);
/// expected_drive() with another paint on one part.
Image8 expected_drive(Document document,
                      int look_id,
                      const std::string& part,
                      const std::string& paint);

}  // namespace livery
