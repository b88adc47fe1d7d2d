// The path tracer's pictures of scenes, kept by what they show: only what changed is traced again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/image.h"
#include "core/pictures/picture_means.h"
#include "core/progress.h"
#include "jobs/comparison.h"
#include "ledger/accuracy/scenes.h"

namespace livery {

struct TruthOptions {
    int samples_per_pixel = 256;  ///< of each of two independent pictures
    std::uint64_t seed = 1;
    std::filesystem::path folder;  ///< where they are kept; empty: nowhere
};

struct Truth {
    std::string hash;  ///< of everything that it depends on
    /// Mean of two independent pictures, R, G, B, coverage, in the scene's squares.
    ImageF radiance_working;
    ErrorStatistics floor;  ///< half of the CIEDE2000 between the two: what the mean may err by
    double p99 = 0.0;       ///< the same
    double seconds = 0.0;   ///< that tracing took; 0 where they were kept
};
/// Throws FileError where the folder cannot be written; what lies there damaged is traced again.
Truth truth_of(const AccuracyScene& scene,
               const TruthOptions& options,
               const Progress& progress = {});

/// What Truth::hash is going to be.
std::string truth_hash(const AccuracyScene& scene, const TruthOptions& options);

/// 32 hexadecimal digits over mesh, paints, artwork, lights, environment, eye, view and exposure.
std::string hash_of(const AccuracyScene& scene);

}  // namespace livery
