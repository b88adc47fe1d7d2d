// The steps of the chain (chain.h): of each, its rows and how they are measured.
#pragma once

#include <chrono>

#include "ledger/accuracy/chain.h"

namespace livery {

/// Artwork's share of a pixel by its footprint, and by one sample, against many samples.
std::vector<ChainPart> artwork_parts(const AccuracyOptions& options);
/// A picture stored in half floats, against one in full floats.
std::vector<ChainPart> half_float_parts(const AccuracyOptions& options);
/// Drives cut to whole levels, against what they were.
std::vector<ChainPart> bit_parts(const AccuracyOptions& options);
/// What a simulated bench shows of a look by the ways to correct it, against the look.
std::vector<ChainPart> correction_parts(const AccuracyOptions& options);
/// Three channels, against the integral over the spectrum.
std::vector<ChainPart> spectral_parts(const AccuracyOptions& options);

template <typename Work>
double milliseconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

}  // namespace livery
