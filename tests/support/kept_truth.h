// Pictures that tests only compare with, and that take minutes of tracing paths: kept as files.
#pragma once

#include <string>

#include "reference/path_tracer.h"

namespace livery::testing {

/// As trace_reference(), R, G, B and coverage alone, rounded as half floats are (0.02%): from
/// tests/data/truths/NAME-HASH.exr, whose hash is of scene, view and options. Environment variable
/// LIVERY_TRUTHS: "check" traces the picture and compares it with the file (.ci/nightly does),
/// "write" traces it and writes the file. Throws std::runtime_error where there is no file and
/// where the comparison fails.
ImageF kept_truth(const std::string& name,
                  const Scene& scene,
                  const View& view,
                  const ReferenceOptions& options);

}  // namespace livery::testing
