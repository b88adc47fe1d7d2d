// The discrete Fourier transform of rows that are a power of two long.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

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

}  // namespace livery
