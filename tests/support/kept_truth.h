// Pictures that tests only compare with, and that take minutes to compute: kept as files.
#pragma once

#include <functional>
#include <string>

#include "reference/path_tracer.h"

namespace livery::testing {

/// What make() gives, R, G, B and coverage, rounded as half floats are (0.02%): from
/// tests/data/truths/NAME-HASH.exr (LIVERY_TRUTHS_FOLDER in the environment: another folder), whose
/// hash is of `depends_on`. Environment variable
/// LIVERY_TRUTHS: "check" makes the picture and compares it with the file (.ci/nightly does),
/// "write" makes it and writes the file. Throws std::runtime_error where there is no file and
/// where the comparison fails.
ImageF kept_picture(const std::string& name,
                    const std::string& depends_on,
                    const std::function<ImageF()>& make);

/// What a picture of this scene in this view depends on.
std::string text_of(const Scene& scene, const View& view);

/// As trace_reference().
ImageF kept_truth(const std::string& name,
                  const Scene& scene,
                  const View& view,
                  const ReferenceOptions& options);

}  // namespace livery::testing
