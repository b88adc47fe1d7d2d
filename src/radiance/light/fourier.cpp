#include "radiance/light/fourier.h"

#include <numbers>

namespace livery {

FourierTransform::FourierTransform(std::size_t length, double sign) {
    for (std::size_t i = 1, j = 0; i < length; ++i) {
        std::size_t bit = length >> 1u;
        for (; j & bit; bit >>= 1u) j ^= bit;
        j ^= bit;
        if (i >= j) continue;
        swaps_.push_back(static_cast<std::uint32_t>(i));
        swaps_.push_back(static_cast<std::uint32_t>(j));
    }
    for (std::size_t size = 2; size <= length; size *= 2) {
        for (std::size_t k = 0; k < size / 2; ++k) {
            turns_.push_back(std::polar(1.0,
                                        sign * 2.0 * std::numbers::pi * static_cast<double>(k) /
                                            static_cast<double>(size)));
        }
    }
}

void FourierTransform::run(std::vector<std::complex<double>>& x) const {
    for (std::size_t k = 0; k < swaps_.size(); k += 2) std::swap(x[swaps_[k]], x[swaps_[k + 1]]);
    const std::complex<double>* turn = turns_.data();
    for (std::size_t size = 2; size <= x.size(); size *= 2) {
        const std::size_t half = size / 2;
        for (std::size_t begin = 0; begin < x.size(); begin += size) {
            for (std::size_t k = 0; k < half; ++k) {
                std::complex<double>& a = x[begin + k];
                std::complex<double>& b = x[begin + k + half];
                // Written out: the library's product looks for NaN after each multiplication
                const double re = b.real() * turn[k].real() - b.imag() * turn[k].imag();
                const double im = b.real() * turn[k].imag() + b.imag() * turn[k].real();
                b = {a.real() - re, a.imag() - im};
                a = {a.real() + re, a.imag() + im};
            }
        }
        turn += half;
    }
}

}  // namespace livery
