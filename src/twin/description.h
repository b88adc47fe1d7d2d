// What a bench file says: every nuisance a switch (docs/bench.md).
#pragma once

#include <filesystem>
#include <string>

#include "scene/view.h"

namespace livery {

struct BenchDescription {
    std::string name;
    View projector, camera;
    glm::dvec3 eye_mm{0.0};
};

/// A bench file, or the name of a shipped one ("default", "paper-2.75m"). Throws FileError.
BenchDescription read_bench_file(const std::filesystem::path& file_or_name);

}  // namespace livery
