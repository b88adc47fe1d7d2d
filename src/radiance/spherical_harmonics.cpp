#include "radiance/spherical_harmonics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// In place, a power of two long: X_m = sum x_j exp(-2 pi i m j / n), or the conjugate sign.
void fourier(std::vector<Complex>& x, double sign) {
    const std::size_t n = x.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1u;
        for (; j & bit; bit >>= 1u) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(x[i], x[j]);
    }
    for (std::size_t length = 2; length <= n; length *= 2) {
        const std::size_t half = length / 2;
        std::vector<Complex> turn(half);
        for (std::size_t k = 0; k < half; ++k) {
            turn[k] = std::polar(
                1.0, sign * 2.0 * kPi * static_cast<double>(k) / static_cast<double>(length));
        }
        for (std::size_t begin = 0; begin < n; begin += length) {
            for (std::size_t k = 0; k < half; ++k) {
                const Complex a = x[begin + k], b = x[begin + k + half] * turn[k];
                x[begin + k] = a + b;
                x[begin + k + half] = a - b;
            }
        }
    }
}

/// Normalised associated Legendre functions of order m at one cosine, degrees m upward.
class Legendre {
  public:
    Legendre(int m, double cosine, double sine) : m_(m), l_(m), cosine_(cosine) {
        double log_start = 0.5 * std::log((2.0 * m + 1.0) / (4.0 * kPi));
        for (int k = 1; k <= m; ++k) log_start += 0.5 * std::log1p(-0.5 / k);
        current_ = std::exp(log_start + m * std::log(sine));
    }
    double value() const { return current_; }
    void next() {
        ++l_;
        const double l = l_, m = m_;
        const double scale = std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m));
        const double back =
            std::sqrt(((l - 1.0) * (l - 1.0) - m * m) / (4.0 * (l - 1.0) * (l - 1.0) - 1.0));
        const double next = scale * (cosine_ * current_ - back * previous_);
        previous_ = current_;
        current_ = next;
    }

  private:
    int m_, l_;
    double cosine_, current_, previous_ = 0.0;
};

double polar_angle(int row, int rows) { return kPi * (row + 0.5) / rows; }

/// Fejer's first rule: exact for polynomials in the cosine of a lower degree than there are rows.
double row_weight(int row, int rows) {
    const double theta = polar_angle(row, rows);
    double sum = 1.0;
    for (int k = 1; k <= rows / 2; ++k)
        sum -= 2.0 * std::cos(2.0 * k * theta) / (4.0 * k * k - 1.0);
    return 2.0 / rows * sum;
}

void check_width(int width, int least) {
    check_argument(
        width >= least && std::has_single_bit(static_cast<unsigned>(width)),
        fmt::format(
            "sphere pictures need a power of two of at least {} columns, not {}", least, width));
}

}  // namespace

SphericalHarmonics analyse_sphere(const ImageF& picture, int degree) {
    check_width(picture.width, 2 * (degree + 1));
    check_argument(
        picture.height > degree && picture.channels == 3,
        fmt::format("degree {} needs more than {} rows of three channels", degree, picture.height));
    const auto rows = static_cast<std::size_t>(picture.height);
    const auto orders = static_cast<std::size_t>(degree + 1);

    // Fourier series of each row, times the quadrature weight of its texels
    std::vector<Complex> series(rows * orders * 3);
    parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
        std::vector<Complex> line(static_cast<std::size_t>(picture.width));
        for (std::size_t y = begin; y < end; ++y) {
            const double weight =
                row_weight(static_cast<int>(y), picture.height) * 2.0 * kPi / picture.width;
            for (int c = 0; c < 3; ++c) {
                for (int x = 0; x < picture.width; ++x) {
                    line[static_cast<std::size_t>(x)] =
                        picture.at(x, static_cast<int>(y), c) * weight;
                }
                fourier(line, -1.0);
                for (std::size_t m = 0; m < orders; ++m) {
                    // Column j is at azimuth 2 pi (j + 1/2) / width
                    series[(m * rows + y) * 3 + static_cast<std::size_t>(c)] =
                        line[m] * std::polar(1.0, -kPi * static_cast<double>(m) / picture.width);
                }
            }
        }
    });

    SphericalHarmonics result;
    result.degree = degree;
    for (auto& channel : result.coefficients) {
        channel.assign(result.index(degree, degree) + 1, Complex(0.0));
    }
    parallel_for(orders, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t order = begin; order < end; ++order) {
            const int m = static_cast<int>(order);
            for (std::size_t y = 0; y < rows; ++y) {
                const double theta = polar_angle(static_cast<int>(y), picture.height);
                const Complex* f = &series[(order * rows + y) * 3];
                Legendre legendre(m, std::cos(theta), std::sin(theta));
                for (int l = m; l <= degree; ++l, legendre.next()) {
                    const std::size_t at = result.index(l, m);
                    for (std::size_t c = 0; c < 3; ++c) {
                        result.coefficients[c][at] += legendre.value() * f[c];
                    }
                }
            }
        }
    });
    return result;
}

std::vector<ImageF> synthesise_sphere(const SphericalHarmonics& harmonics,
                                      std::span<const std::vector<double>> kernels,
                                      int width,
                                      int height) {
    std::size_t longest = 0;
    for (const auto& kernel : kernels) longest = std::max(longest, kernel.size());
    const int degree = std::min(harmonics.degree, static_cast<int>(longest) - 1);
    check_width(width, 2 * (degree + 1));
    // Both signs of m at once, at azimuth 2 pi (j + 1/2) / width
    std::vector<Complex> half_column;
    for (int m = 0; m <= degree; ++m) {
        half_column.push_back(std::polar(m == 0 ? 1.0 : 2.0, kPi * m / width));
    }
    std::vector<ImageF> pictures(kernels.size(), ImageF(width, height, 3));
    parallel_for(static_cast<std::size_t>(height), 4, [&](std::size_t begin, std::size_t end) {
        // [kernel][channel][m]
        const auto columns = static_cast<std::size_t>(width);
        std::vector<std::vector<Complex>> lines(kernels.size() * 3);
        for (std::size_t y = begin; y < end; ++y) {
            for (auto& line : lines) line.assign(columns, Complex(0.0));
            const double theta = polar_angle(static_cast<int>(y), height);
            for (int m = 0; m <= degree; ++m) {
                Legendre legendre(m, std::cos(theta), std::sin(theta));
                for (int l = m; l <= degree; ++l, legendre.next()) {
                    const std::size_t at = harmonics.index(l, m);
                    const Complex p = legendre.value() * half_column[static_cast<std::size_t>(m)];
                    const Complex part[3] = {p * harmonics.coefficients[0][at],
                                             p * harmonics.coefficients[1][at],
                                             p * harmonics.coefficients[2][at]};
                    for (std::size_t k = 0; k < kernels.size(); ++k) {
                        if (static_cast<std::size_t>(l) >= kernels[k].size()) continue;
                        const double scale = kernels[k][static_cast<std::size_t>(l)];
                        for (std::size_t c = 0; c < 3; ++c) {
                            lines[3 * k + c][static_cast<std::size_t>(m)] += scale * part[c];
                        }
                    }
                }
            }
            for (std::size_t k = 0; k < kernels.size(); ++k) {
                for (std::size_t c = 0; c < 3; ++c) {
                    fourier(lines[3 * k + c], 1.0);
                    for (std::size_t x = 0; x < columns; ++x) {
                        pictures[k].at(
                            static_cast<int>(x), static_cast<int>(y), static_cast<int>(c)) =
                            static_cast<float>(lines[3 * k + c][x].real());
                    }
                }
            }
        }
    });
    return pictures;
}

}  // namespace livery
