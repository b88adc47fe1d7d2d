// Pictures of the whole sphere as spherical harmonics: exact filtering with round kernels, by the
// discrete Fourier transform of rows that are a power of two long.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"

namespace livery {

/// One length and sign, planned once; run() may be called from many threads.
class FourierTransform {
  public:
    FourierTransform(std::size_t length, double sign);

    /// In place: X_m = sum x_j exp(sign 2 pi i m j / length), unscaled.
    void run(std::vector<std::complex<double>>& x) const;

  private:
    std::vector<std::complex<double>> turns_;  ///< of each stage, one after the other
    std::vector<std::uint32_t> swaps_;         ///< pairs
};

/// Coefficients of a three-channel latitude-longitude picture up to `degree`.
struct SphericalHarmonics {
    int degree = 0;
    /// Of each channel; orders m >= 0 only, since the picture is real.
    std::vector<std::complex<double>> coefficients[3];

    /// Sorted by m, then l, the order in which the recurrences run.
    std::size_t index(int l, int m) const {
        const auto order = static_cast<std::size_t>(m), all = static_cast<std::size_t>(degree + 1);
        return order * all - order * (order + 1) / 2 + static_cast<std::size_t>(l);
    }
};

/// Analysis. Width must be a power of two, at least 2 (degree + 1); rows at least degree + 1.
SphericalHarmonics analyse_sphere(const ImageF& picture, int degree);

/// One picture a kernel: kernels[k][l] scales degree l (its length bounds the degrees used).
/// Width must be a power of two, at least 2 x the degree of the longest kernel.
std::vector<ImageF> synthesise_sphere(const SphericalHarmonics& harmonics,
                                      std::span<const std::vector<double>> kernels,
                                      int width,
                                      int height);

}  // namespace livery
